// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>
#include <vector>

namespace dielast::meshing {

/// count + 1 numbers from `from` to `to` whose steps grow geometrically, the last one `grading` >= 1 times
/// the first. Throws std::invalid_argument for another grading.
inline std::vector<double> graded_steps(double from, double to, int count, double grading) {
  if (!(grading >= 1) || !std::isfinite(grading))
    throw std::invalid_argument(fmt::format("the grading of an annulus is at least 1, not {:.6g}", grading));
  std::vector<double> places{0}; // the first step being 1
  for (int i = 0; i < count; ++i)
    places.push_back(places.back() + std::pow(grading, i / std::max(1.0, count - 1.0)));
  const double whole = places.back();
  for (double& place : places) place = std::lerp(from, to, place / whole);
  return places;
}

} // namespace dielast::meshing
