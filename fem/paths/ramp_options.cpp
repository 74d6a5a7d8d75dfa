// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/ramp.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr double smallest_in_time = 1e-10; ///< part of a step that takes time
constexpr double smallest_beside = 1e-2;   ///< over the smallest, beside another branch
constexpr double begun = 1e3; ///< smallest parts, behind which what flows within one of them has flown

} // namespace

double RampOptions::smallest(bool beside) const {
  return duration > 0 ? smallest_in_time : smallest_increment * (beside ? smallest_beside : 1);
}

bool RampOptions::outruns(double part) const {
  return shortest_relaxation > 0 && shortest_relaxation < smallest() * duration && part < begun * smallest();
}

double RampOptions::next_landing(double s) const {
  const double between = landing > 0 ? landing : 1.0 / increments;
  if (stops.empty()) return (std::floor((s + load_factor_round_off) / between) + 1) * between;
  const auto next = std::ranges::upper_bound(stops, s + load_factor_round_off);
  return next == stops.end() ? 1.0 : *next;
}

RampProgress RampProgress::begin(const State& state, const DofMap& dofs, const RampOptions& options) {
  const double largest = 1.0 / options.increments;
  return {.start = Loads::of(state, dofs), .increment = largest, .points = {{0, state}}};
}

} // namespace dielast::fem
