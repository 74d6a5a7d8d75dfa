// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/films/triangle.hpp"

#include <stdexcept>

namespace dielast::fem {

std::span<const TrianglePoint> triangle_rule(int points) {
  static constexpr std::array<TrianglePoint, 1> one{{{1.0 / 3, 1.0 / 3, 0.5}}};
  static constexpr std::array<TrianglePoint, 3> three{
      {{1.0 / 6, 1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6, 1.0 / 6}, {1.0 / 6, 2.0 / 3, 1.0 / 6}}};
  static constexpr double a = 0.445948490915965, wa = 0.223381589678011 / 2;
  static constexpr double b = 0.091576213509771, wb = 0.109951743655322 / 2;
  static constexpr std::array<TrianglePoint, 6> six{{{a, a, wa},
                                                     {1 - 2 * a, a, wa},
                                                     {a, 1 - 2 * a, wa},
                                                     {b, b, wb},
                                                     {1 - 2 * b, b, wb},
                                                     {b, 1 - 2 * b, wb}}};
  switch (points) {
  case 1:
    return one;
  case 3:
    return three;
  case 6:
    return six;
  default:
    throw std::invalid_argument("a triangle has 1, 3 or 6 integration points");
  }
}

template<>
Eigen::Matrix<double, 3, 1> shape_values<3>(double xi, double eta) {
  return {1 - xi - eta, xi, eta};
}

template<>
Eigen::Matrix<double, 6, 1> shape_values<6>(double xi, double eta) {
  const double zeta = 1 - xi - eta;
  return (Eigen::Matrix<double, 6, 1>() << zeta * (2 * zeta - 1), xi * (2 * xi - 1), eta * (2 * eta - 1),
          4 * zeta * xi, 4 * xi * eta, 4 * eta * zeta)
      .finished();
}

template<>
Eigen::Matrix<double, 3, 2> shape_gradients<3>(double, double) {
  return (Eigen::Matrix<double, 3, 2>() << -1, -1, 1, 0, 0, 1).finished();
}

template<>
Eigen::Matrix<double, 6, 2> shape_gradients<6>(double xi, double eta) {
  const double zeta = 1 - xi - eta;
  Eigen::Matrix<double, 6, 2> gradients;
  gradients << 1 - 4 * zeta, 1 - 4 * zeta, 4 * xi - 1, 0, 0, 4 * eta - 1, 4 * (zeta - xi), -4 * xi, 4 * eta,
      4 * xi, -4 * eta, 4 * (zeta - eta);
  return gradients;
}

} // namespace dielast::fem
