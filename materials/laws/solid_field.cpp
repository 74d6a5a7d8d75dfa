// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/solid_field.hpp"

#include <Eigen/LU>

namespace dielast::materials {

SolidField solid_field(const Eigen::Matrix3d& C, const SolidPotential& J, const Eigen::Vector3d& E0,
                       Derivatives wanted) {
  const Eigen::Matrix3d inverse = C.inverse();
  if (E0.isZero(0))
    return {0,
            Eigen::Vector<double, 6>::Zero(),
            Eigen::Vector3d::Zero(),
            Eigen::Matrix<double, 6, 6>::Zero(),
            Eigen::Matrix<double, 6, 3>::Zero(),
            2 * J.value * inverse};
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
  SolidField field;
  field.value = J.value * g;
  field.in_C = g * J.first + J.value * slope;
  field.in_E = 2 * J.value * v;
  if (wanted == Derivatives::first) return field;
  const Eigen::Matrix<double, 3, 6> turned = inverse * w;
  field.in_CC = g * J.second + J.first * slope.transpose() + slope * J.first.transpose() +
                2 * J.value * w.transpose().lazyProduct(turned);
  field.in_CE = 2 * J.first * v.transpose() - 2 * J.value * turned.transpose();
  field.in_EE = 2 * J.value * inverse;
  return field;
}

} // namespace dielast::materials
