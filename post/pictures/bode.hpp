// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "post/pictures/plot.hpp"

#include <complex>
#include <span>
#include <string>
#include <vector>

namespace dielast::post {

/// A transfer function along a sweep of the frequency.
struct FrequencyResponse {
  std::string label;
  std::vector<double> frequency; ///< Hz, ascending
  std::vector<std::complex<double>> value;
  Series::Style style = Series::Style::line;
};

/// Bode's two plots over frequency: the magnitude, both axes logarithmic, and the phase in degrees, which
/// starts between -180 and 180 and is continued by at most half a turn from point to point. A value that is
/// zero or not finite leaves a gap. `magnitude_label` names magnitude and unit, "Deflection (mm/kV)".
std::vector<Plot> bode(const std::string& title, const std::string& magnitude_label,
                       std::span<const FrequencyResponse> responses);

} // namespace dielast::post
