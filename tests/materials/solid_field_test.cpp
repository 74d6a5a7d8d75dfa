// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/solid_field.hpp"

#include "materials/laws/dual.hpp"

#include <gtest/gtest.h>

namespace dielast::materials::solid_field_test {
namespace {

using Dual9 = Dual<9>; // C11, C22, C33, C12, C23, C13, E1, E2, E3

struct Sample {
  Eigen::Matrix3d C;
  Eigen::Vector3d E;
};

Sample sample() {
  Eigen::Matrix3d F;
  F << 1.3, 0.2, -0.1, 0.05, 0.8, 0.3, 0.15, -0.2, 1.1;
  return {F.transpose() * F, {0.7, -1.2, 0.4}};
}

std::array<Dual9, 9> variables(const Sample& at) {
  std::array<Dual9, 9> x;
  for (std::size_t a = 0; a < 6; ++a)
    x[a] = Dual9::variable(at.C(solid_components[a][0], solid_components[a][1]), static_cast<int>(a));
  for (int i = 0; i < 3; ++i) x[static_cast<std::size_t>(6 + i)] = Dual9::variable(at.E[i], 6 + i);
  return x;
}

Dual9 determinant(const std::array<Dual9, 9>& x) {
  const auto& [a, b, c, d, e, f, u, v, w] = x;
  return a * (b * c - e * e) - d * (d * c - e * f) + f * (d * e - b * f);
}

TEST(SolidField, VolumeRatioHasTheDerivativesOfDualNumbers) {
  const Sample at = sample();
  const SolidPotential J = volume_ratio(at.C);
  const Dual9 expected = sqrt(determinant(variables(at)));
  EXPECT_NEAR(J.value, expected.value, 1e-14);
  EXPECT_LT((J.first - expected.gradient.head<6>()).norm(), 1e-13);
  EXPECT_LT((J.second - expected.hessian.topLeftCorner<6, 6>()).norm(), 1e-13);
}

TEST(SolidField, FieldHasTheDerivativesOfDualNumbers) {
  const Sample at = sample();
  const SolidField field = solid_field(at.C, volume_ratio(at.C), at.E);
  const std::array<Dual9, 9> x = variables(at);
  const auto& [a, b, c, d, e, f, u, v, w] = x;
  // E . cof(C) E / det C, the cofactors written out
  const Dual9 cofactors = u * u * (b * c - e * e) + v * v * (a * c - f * f) + w * w * (a * b - d * d) +
                          2.0 * (u * v * (e * f - d * c) + v * w * (d * f - a * e) + u * w * (d * e - b * f));
  const Dual9 det = determinant(x), expected = cofactors / sqrt(det);
  EXPECT_NEAR(field.value, expected.value, 1e-13);
  EXPECT_LT((field.in_C - expected.gradient.head<6>()).norm(), 1e-12);
  EXPECT_LT((field.in_E - expected.gradient.tail<3>()).norm(), 1e-12);
  EXPECT_LT((field.in_CC - expected.hessian.topLeftCorner<6, 6>()).norm(), 1e-11);
  EXPECT_LT((field.in_CE - expected.hessian.topRightCorner<6, 3>()).norm(), 1e-11);
  EXPECT_LT((field.in_EE - expected.hessian.bottomRightCorner<3, 3>()).norm(), 1e-12);
}

} // namespace
} // namespace dielast::materials::solid_field_test
