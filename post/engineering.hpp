// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace dielast::post {

/// A unit with an SI prefix and the factor from SI to it: ("V/m", 8.5e7) -> {1e-6, "MV/m"}.
struct ScaledUnit {
  double factor = 1;
  std::string unit;
};

/// How a person wants to read numbers of unit "1".
enum class Ratio { plain, percent };

/// The unit in which `magnitude` (SI) reads between 1 and 1000. Units that take no prefix ("1", "1/m", "m^2",
/// "kg", "deg" ...) come back as they are; the unit of a plain ratio is "".
ScaledUnit scaled_unit(double magnitude, std::string_view unit, Ratio ratio = Ratio::plain);

/// A number with `digits` significant digits and neither exponent nor trailing blanks where that can be read:
/// 0.3319 -> "0.3319".
std::string significant(double value, int digits = 4);

/// A value in SI with prefix and unit: (8.497e7, "V/m") -> "84.97 MV/m", (-0.0352, "1", percent) -> "-3.52
/// %". A value that is not a number reads "-".
std::string engineering(double value, std::string_view unit, Ratio ratio = Ratio::plain, int digits = 4);

} // namespace dielast::post
