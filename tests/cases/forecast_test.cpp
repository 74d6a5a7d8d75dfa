// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/console/forecast.hpp"

#include <gtest/gtest.h>

namespace dielast::cases::forecast_test {
namespace {

TEST(Forecast, SpeaksAfterHalfAMinuteAndWheneverTheTimeHasDoubled) {
  Forecast forecast;
  EXPECT_EQ(forecast.at(0, 29), "");
  EXPECT_EQ(forecast.at(0.25, 30), "load factor 0.25 after 30 s; at this pace the step takes 90 s more");
  EXPECT_EQ(forecast.at(0.4, 59), "");
  EXPECT_EQ(forecast.at(0.5, 600), "load factor 0.5 after 10 min; at this pace the step takes 10 min more");
}

TEST(Forecast, CountsFromWhereAResumedStepWentOn) {
  Forecast forecast;
  EXPECT_EQ(forecast.at(0.5, 0), "");
  EXPECT_EQ(forecast.at(0.6, 36000), "load factor 0.6 after 10 h; at this pace the step takes 40 h more");
}

TEST(Forecast, TellsNoTimeOfAStepThatDoesNotMove) {
  Forecast forecast;
  EXPECT_EQ(forecast.at(0.5, 0), "");
  EXPECT_EQ(forecast.at(0.5, 31), "load factor 0.5 after 31 s");
}

} // namespace
} // namespace dielast::cases::forecast_test
