// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/ramp.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

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
