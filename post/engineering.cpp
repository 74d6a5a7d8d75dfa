// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace dielast::post {

namespace {

constexpr std::array prefixes{"p", "n", "µ", "m", "", "k", "M", "G", "T"};
constexpr int no_prefix = 4;

/// Prefixes multiply the first symbol, so it must be a plain one to the power 1.
bool takes_prefix(std::string_view unit) {
  const std::string_view symbol = unit.substr(0, unit.find_first_of(" /*^"));
  const bool powered = symbol.size() < unit.size() && unit[symbol.size()] == '^';
  constexpr std::array plain{"m", "s", "g", "A", "V", "F", "C", "N", "J", "W", "Pa", "Hz", "Ohm", "S"};
  return !powered && std::find(plain.begin(), plain.end(), symbol) != plain.end();
}

} // namespace

ScaledUnit scaled_unit(double magnitude, std::string_view unit, Ratio ratio) {
  if (unit == "1" || unit.empty()) return ratio == Ratio::percent ? ScaledUnit{100, "%"} : ScaledUnit{1, ""};
  const double size = std::abs(magnitude);
  if (!takes_prefix(unit) || !(size > 0) || !std::isfinite(size)) return {1, std::string(unit)};
  // 0.99995 mm with four digits would read "1000 µm": round before choosing.
  const int thousands = static_cast<int>(std::floor(std::log10(size * 1.00005) / 3));
  const int index = std::clamp(no_prefix + thousands, 0, static_cast<int>(prefixes.size()) - 1);
  return {std::pow(10.0, -3 * (index - no_prefix)),
          prefixes[static_cast<std::size_t>(index)] + std::string(unit)};
}

std::string significant(double value, int digits) {
  if (std::isnan(value)) return "-";
  if (value == 0) return "0";
  if (!std::isfinite(value)) return fmt::format("{}", value);
  // The exponent after rounding: 0.99999 is 1.000, not 1.0000.
  const double rounded = std::strtod(fmt::format("{:.{}e}", value, digits - 1).c_str(), nullptr);
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(rounded))));
  if (exponent < -4 || exponent > 6) return fmt::format("{:.{}g}", value, digits);
  return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent));
}

std::string engineering(double value, std::string_view unit, Ratio ratio, int digits) {
  if (std::isnan(value)) return "-";
  const ScaledUnit scaled = scaled_unit(value, unit, ratio);
  const std::string number = significant(value * scaled.factor, digits);
  return scaled.unit.empty() ? number : number + " " + scaled.unit;
}

} // namespace dielast::post
