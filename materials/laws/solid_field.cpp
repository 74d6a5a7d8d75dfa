// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/solid_field.hpp"

#include <Eigen/LU>

namespace dielast::materials {

namespace {

SolidPotential volume_ratio(const Eigen::Matrix3d& C, const Eigen::Matrix3d& inverse) {
  SolidPotential J{std::sqrt(C.determinant()), {}, {}};
  const auto weight = [](int i, int j) { return i == j ? 0.5 : 1.0; };
  for (int a = 0; a < 6; ++a) {
    const auto [i, j] = solid_components[static_cast<std::size_t>(a)];
    J.first[a] = weight(i, j) * J.value * inverse(i, j);
  }
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b <= a; ++b) {
      const auto [i, j] = solid_components[static_cast<std::size_t>(a)];
      const auto [k, l] = solid_components[static_cast<std::size_t>(b)];
      const double trace = inverse(l, i) * inverse(j, k) + inverse(k, i) * inverse(j, l);
      J.second(a, b) = J.second(b, a) =
          J.first[a] * J.first[b] / J.value - J.value * weight(i, j) * weight(k, l) * trace;
    }
  return J;
}

} // namespace

SolidPotential volume_ratio(const Eigen::Matrix3d& C) { return volume_ratio(C, C.inverse()); }

SolidField solid_field(const Eigen::Matrix3d& C, const Eigen::Vector3d& E0) {
  const Eigen::Matrix3d inverse = C.inverse();
  const SolidPotential J = volume_ratio(C, inverse);
  const Eigen::Vector3d v = inverse * E0;
  const double g = E0.dot(v);    // squared length of the true field
  Eigen::Matrix<double, 3, 6> w; // dC v for a unit change of each component of C
  Eigen::Vector<double, 6> slope;
  for (int a = 0; a < 6; ++a) {
    const auto [i, j] = solid_components[static_cast<std::size_t>(a)];
    w.col(a).setZero();
    w(i, a) = v[j];
    w(j, a) = v[i];
    slope[a] = -v.dot(w.col(a));
  }
  const Eigen::Matrix<double, 3, 6> turned = inverse * w;
  SolidField field;
  field.value = J.value * g;
  field.in_C = g * J.first + J.value * slope;
  field.in_E = 2 * J.value * v;
  field.in_CC = g * J.second + J.first * slope.transpose() + slope * J.first.transpose() +
                2 * J.value * w.transpose() * turned;
  field.in_CE = 2 * J.first * v.transpose() - 2 * J.value * turned.transpose();
  field.in_EE = 2 * J.value * inverse;
  return field;
}

} // namespace dielast::materials
