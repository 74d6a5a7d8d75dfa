// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/bode.hpp"

#include <cmath>
#include <numbers>

namespace dielast::post {

std::vector<Plot> bode(const std::string& title, const std::string& magnitude_label,
                       std::span<const FrequencyResponse> responses) {
  Plot magnitude{
      .title = title, .x_label = "Frequency (Hz)", .y_label = magnitude_label, .log_x = true, .log_y = true};
  Plot phase{
      .title = title, .x_label = "Frequency (Hz)", .y_label = "Phase (deg)", .log_x = true, .y_step = 45};
  for (const FrequencyResponse& response : responses) {
    Series absolute{response.label, response.frequency, {}, response.style}, angle = absolute;
    double last = 0; // so that the first angle stays as it is
    for (const std::complex<double>& value : response.value) {
      absolute.y.push_back(std::abs(value));
      double degrees = NAN;
      if (std::abs(value) > 0 && std::isfinite(std::abs(value))) {
        degrees = std::arg(value) * 180 / std::numbers::pi;
        degrees += 360 * std::nearbyint((last - degrees) / 360);
        last = degrees;
      }
      angle.y.push_back(degrees);
    }
    magnitude.series.push_back(std::move(absolute));
    phase.series.push_back(std::move(angle));
  }
  return {magnitude, phase};
}

} // namespace dielast::post
