// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/dielectric.hpp"
#include "materials/laws/dual.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::materials::dielectric_test {
namespace {

TEST(Dielectric, ideal_film_has_the_capacitance_of_its_area_squared) {
  const auto Q = capacitance_ratio(Dielectric{}, 3.0, 2.0);
  EXPECT_EQ(Q.value, 2);
  EXPECT_EQ(Q.dD, 1);
  for (const double zero : {Q.dT, Q.dTT, Q.dTD, Q.dDD}) EXPECT_EQ(zero, 0);
}

TEST(Dielectric, electrostriction_counts_the_sum_of_the_stretches) {
  const Dielectric film{.permittivity = 4e-11, .electrostriction = -0.053};
  const double l1 = 3, l2 = 1.7;
  EXPECT_NEAR(film.permittivity_at(l1 * l1 + l2 * l2, l1 * l1 * l2 * l2), 4e-11 * (1 - 0.053 * (l1 + l2 - 2)),
              1e-24);
  const double T = l1 * l1 + l2 * l2, D = l1 * l1 * l2 * l2;
  const auto Q = capacitance_ratio(film, T, D);
  const Dual<2> oracle = capacitance_ratio_value(film, Dual<2>::variable(T, 0), Dual<2>::variable(D, 1));
  EXPECT_NEAR(Q.value, oracle.value, 1e-13 * D);
  EXPECT_NEAR(Q.value, D * film.permittivity_at(T, D) / 4e-11, 1e-13 * D);
  EXPECT_NEAR(Q.dT, oracle.gradient[0], 1e-13);
  EXPECT_NEAR(Q.dD, oracle.gradient[1], 1e-13);
  EXPECT_NEAR(Q.dTT, oracle.hessian(0, 0), 1e-13);
  EXPECT_NEAR(Q.dTD, oracle.hessian(0, 1), 1e-13);
  EXPECT_NEAR(Q.dDD, oracle.hessian(1, 1), 1e-13);
}

// Koh et al. 2011, J. Polym. Sci. B 49, 504: 30.6 MV/m at an equal-biaxial stretch of 1, growing with its
// power 1.13.
TEST(Dielectric, breakdown_field_follows_a_power_of_the_equal_biaxial_stretch) {
  const Dielectric vhb{.breakdown_field = 30.6e6, .breakdown_exponent = 1.13};
  EXPECT_DOUBLE_EQ(vhb.breakdown_field_at(1), 30.6e6);
  EXPECT_NEAR(vhb.breakdown_field_at(std::pow(5.0, 4)), 30.6e6 * std::pow(5, 1.13), 1);
  EXPECT_DOUBLE_EQ(Dielectric{}.breakdown_field_at(16), 100e6);
}

} // namespace
} // namespace dielast::materials::dielectric_test
