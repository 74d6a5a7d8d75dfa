// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/console/forecast.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::cases {

namespace {

std::string time_text(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (seconds < 2 * 3600) return fmt::format("{:.0f} min", seconds / 60);
  if (seconds < 48 * 3600) return fmt::format("{:.0f} h", seconds / 3600);
  return fmt::format("{:.4g} days", seconds / 86400);
}

} // namespace

std::string Forecast::at(double load_factor, double elapsed) {
  if (begin_ < 0) begin_ = load_factor;
  if (elapsed < next_) return "";
  next_ = 2 * elapsed;
  const std::string here = fmt::format("load factor {:.4g} after {}", load_factor, time_text(elapsed));
  const double left = elapsed * (1 - load_factor) / (load_factor - begin_);
  if (!std::isfinite(left) || left < 0) return here;
  return fmt::format("{}; at this pace the step takes {} more", here, time_text(left));
}

} // namespace dielast::cases
