// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/engineering.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::post::engineering_test {

TEST(Engineering, ChoosesThePrefixThatReadsBetweenOneAndThousand) {
  EXPECT_EQ(engineering(8.497e7, "V/m"), "84.97 MV/m");
  EXPECT_EQ(engineering(7500, "V"), "7.500 kV");
  EXPECT_EQ(engineering(0.08397, "m"), "83.97 mm");
  EXPECT_EQ(engineering(-45.2e3, "Pa"), "-45.20 kPa");
  EXPECT_EQ(engineering(3.2e-9, "F"), "3.200 nF");
  EXPECT_EQ(engineering(2e-5, "m"), "20.00 µm");
  EXPECT_EQ(engineering(1e-3, "N m"), "1.000 mN m");
}

TEST(Engineering, RoundsBeforeItChooses) {
  EXPECT_EQ(engineering(0.999999e-3, "m"), "1.000 mm");
  EXPECT_EQ(engineering(1000, "Pa"), "1.000 kPa");
  EXPECT_EQ(engineering(999, "Pa"), "999.0 Pa");
}

TEST(Engineering, ShowsRatiosAsAsked) {
  EXPECT_EQ(engineering(-0.0352, "1", Ratio::percent), "-3.520 %");
  EXPECT_EQ(engineering(0.8497, "1"), "0.8497");
}

TEST(Engineering, LeavesUnitsThatTakeNoPrefix) {
  EXPECT_EQ(engineering(1234, "1/m"), "1234 1/m");
  EXPECT_EQ(engineering(2e-6, "m^2"), "2e-06 m^2");
  EXPECT_EQ(engineering(0.1, "kg"), "0.1000 kg");
  EXPECT_EQ(engineering(150, "deg"), "150.0 deg");
}

TEST(Engineering, SurvivesEveryNumber) {
  EXPECT_EQ(engineering(0, "V"), "0 V");
  EXPECT_EQ(engineering(NAN, "V"), "-");
  EXPECT_EQ(engineering(INFINITY, "V"), "inf V");
  EXPECT_EQ(engineering(1e-30, "m"), "1e-18 pm");
}

} // namespace dielast::post::engineering_test
