// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/results/solution.hpp"

namespace dielast::cases {

// Errors that the discretisations of a run have in common, so that comparing them does not tell: per quantity
// of the case, in its unit.

/// What a barrier changes.
struct BarrierChanges {
  std::vector<double> of_quantities;
  std::string unknown; ///< why that is not known; empty where it is
};

/// As half of a barrier's thickness tells with the largest elements: like its thickness, or the root of that,
/// as of what slides or peels off. 0 without contact; not known where that half takes another way, or none,
/// as where surfaces as far apart as the barrier is thick touch with all of it only.
BarrierChanges changes_by_barrier(const Case& one, const Solution& own,
                                  const std::vector<Discretisation>& discretisations,
                                  const std::vector<Solution>& others, int threads);

/// All that bending does to single films whose elements hide the layer along their edges; 0 of others, and
/// where the membrane is no device of its own.
std::vector<double> changes_by_bending(const Case& one, const Simulation& run, const Solution& own,
                                       int threads);

} // namespace dielast::cases
