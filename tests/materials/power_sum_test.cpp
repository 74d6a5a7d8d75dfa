// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/power_sum.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::materials::power_sum_test {
namespace {

/// y on both sides of where the series ends, and up to where one of the principal values vanishes.
constexpr double places[] = {0, 1e-16, 1e-9, 1e-4, 0.02, 0.0499999, 0.0500001, 0.2, 0.7, 0.99, 0.99999};

void expect_sum(double p, double y, const PowerSum& expected, double tolerance) {
  const PowerSum sum = power_sum(p, y, 1 - y);
  EXPECT_NEAR(sum.value, expected.value, tolerance * std::abs(expected.value)) << "p " << p << ", y " << y;
  EXPECT_NEAR(sum.first, expected.first, tolerance * (std::abs(expected.first) + 1))
      << "p " << p << ", y " << y;
  EXPECT_NEAR(sum.second, expected.second, tolerance * (std::abs(expected.second) + 1))
      << "p " << p << ", y " << y;
}

TEST(PowerSum, whole_exponents_are_polynomials) {
  for (const double y : places) {
    expect_sum(1, y, {2, 0, 0}, 1e-13);
    expect_sum(2, y, {2 + 2 * y, 2, 0}, 1e-13);
    expect_sum(3, y, {2 + 6 * y, 6, 0}, 1e-13);
    expect_sum(4, y, {2 + 12 * y + 2 * y * y, 12 + 4 * y, 4}, 1e-12);
  }
}

TEST(PowerSum, negative_and_half_exponents_have_closed_forms) {
  for (const double y : places) {
    const double r = 1 - y, s = std::sqrt(r);
    expect_sum(-1, y, {2 / r, 2 / (r * r), 4 / (r * r * r)}, 1e-12);
    // (E_1/2)^2 = 2 + 2 sqrt(1 - y)
    const double E = std::sqrt(2 + 2 * s), E_1 = -1 / (2 * s * E);
    expect_sum(0.5, y, {E, E_1, E_1 * (0.5 / r - E_1 / E)}, 1e-12);
  }
}

} // namespace
} // namespace dielast::materials::power_sum_test
