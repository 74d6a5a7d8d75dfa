// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/state.hpp"

#include <span>

namespace dielast::fem {

/// Points that are worth keeping for predict(): in time the error of a step limits how smooth they are.
constexpr std::size_t most_at_rest = 8, most_in_time = 4;

/// Where the path through `points` (distinct parameters, the last one reached last) leads at `parameter`: by
/// extrapolate() through the last four of them, and through as many more as each change less of what is
/// foretold than the one before. What changes more tells of a kink, or of the tolerance of equilibria.
State predict(std::span<const PathPoint> points, double parameter);

} // namespace dielast::fem
