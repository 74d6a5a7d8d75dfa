// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

namespace dielast::fem {

/// Integration point of the reference line -1..1.
struct MeridianPoint {
  double xi = 0;
  double weight = 0; ///< the weights add up to 2
};

/// Gauss-Legendre rules of 1, 2 or 3 points; other counts throw std::invalid_argument.
inline std::span<const MeridianPoint> meridian_rule(int points) {
  static const std::array<MeridianPoint, 1> one{{{0, 2}}};
  static const std::array<MeridianPoint, 2> two{{{-std::sqrt(1.0 / 3), 1}, {std::sqrt(1.0 / 3), 1}}};
  static const std::array<MeridianPoint, 3> three{
      {{-std::sqrt(0.6), 5.0 / 9}, {0, 8.0 / 9}, {std::sqrt(0.6), 5.0 / 9}}};
  switch (points) {
  case 1:
    return one;
  case 2:
    return two;
  case 3:
    return three;
  default:
    throw std::invalid_argument("a meridian has 1, 2 or 3 integration points");
  }
}

/// Shape functions of a line of 2 or 3 nodes (ends, then the middle), and their derivatives d/dxi.
template<int Nodes>
Eigen::Matrix<double, Nodes, 1> meridian_shape(double xi) {
  if constexpr (Nodes == 2)
    return {(1 - xi) / 2, (1 + xi) / 2};
  else
    return {xi * (xi - 1) / 2, xi * (xi + 1) / 2, 1 - xi * xi};
}
template<int Nodes>
Eigen::Matrix<double, Nodes, 1> meridian_slope(double xi) {
  if constexpr (Nodes == 2)
    return {-0.5, 0.5};
  else
    return {xi - 0.5, xi + 0.5, -2 * xi};
}

} // namespace dielast::fem
