// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/bode.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace dielast::post::bode_test {
namespace {

using Complex = std::complex<double>;

TEST(Bode, ShowsMagnitudeAndPhaseOfAnOscillatorBehindALag) {
  FrequencyResponse response{"model", {}, {}, Series::Style::points};
  for (int i = 0; i <= 60; ++i) {
    const double f = std::pow(10, -2 + i / 15.0);
    const Complex s(0, f); // in natural frequencies
    response.frequency.push_back(f);
    response.value.push_back(3.0 / ((1.0 + s) * (1.0 + 0.1 * s + s * s)));
  }
  const auto plots = bode("Diaphragm", "Deflection (mm/kV)", std::vector{response});
  ASSERT_EQ(plots.size(), 2u);
  const Plot &magnitude = plots[0], &phase = plots[1];
  EXPECT_TRUE(magnitude.log_x && magnitude.log_y && phase.log_x && !phase.log_y);
  EXPECT_EQ(magnitude.y_label, "Deflection (mm/kV)");
  EXPECT_EQ(phase.y_label, "Phase (deg)");
  for (const Plot& plot : plots) {
    EXPECT_EQ(plot.title, "Diaphragm");
    ASSERT_EQ(plot.series.size(), 1u);
    EXPECT_EQ(plot.series[0].label, "model");
    EXPECT_EQ(plot.series[0].style, Series::Style::points);
    EXPECT_EQ(plot.series[0].x, response.frequency);
  }
  EXPECT_NEAR(magnitude.series[0].y[30], 3 / std::sqrt(2) / 0.1, 1e-9); // at resonance
  EXPECT_NEAR(phase.series[0].y[30], -135, 1e-9);
  for (std::size_t i = 1; i <= 60; ++i) EXPECT_LT(phase.series[0].y[i], phase.series[0].y[i - 1]) << i;
  const double exact = -std::atan(100.0) - std::numbers::pi + std::atan(10.0 / (100 * 100 - 1)); // past -180
  EXPECT_NEAR(phase.series[0].y[60], exact * 180 / std::numbers::pi, 1e-9);
}

TEST(Bode, StartsWithinHalfATurnAndSkipsWhatHasNoPhase) {
  const FrequencyResponse response{"", {1, 2, 3, 4, 5}, {-1, std::polar(1.0, -3.0), 0, NAN, -1}};
  const auto phase = bode("", "", std::vector{response})[1].series[0].y;
  ASSERT_EQ(phase.size(), 5u);
  EXPECT_EQ(phase[0], 180);
  EXPECT_NEAR(phase[1], 360 - 3 * 180 / std::numbers::pi, 1e-12);
  EXPECT_TRUE(std::isnan(phase[2]) && std::isnan(phase[3]));
  EXPECT_NEAR(phase[4], 180, 1e-12);
}

} // namespace
} // namespace dielast::post::bode_test
