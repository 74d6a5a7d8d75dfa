// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/fitting/richardson.hpp"
#include "cases/results/solution.hpp"

#include <span>
#include <string>
#include <vector>

namespace dielast::cases {

/// An event that depends on the mesh, or that did not happen but may on another.
struct EventRemark {
  std::string kind; ///< "loss of tension", "breakdown", "wall yield", "wall contact", "limit point"
  std::string remark;
};

/// What other discretisations tell of a run.
struct Estimates {
  std::vector<ErrorEstimate> quantities; ///< in the case's order; empty: none, for `reason`; none of margins
  std::vector<ErrorEstimate>
      margins; ///< of the factors, in the order of the margins; empty: none, for `reason`
  std::vector<EventRemark> events;
  std::string reason; ///< why no quantity has an estimate; empty otherwise
};

/// Whether the extreme that crosses this limit grows as the mesh is refined.
bool is_singular_there(const Case& one, const std::string& limit,
                       const std::vector<ErrorEstimate>& estimates);

/// Of events of film and walls, from the estimates of extremes where they were farthest and from what
/// happened on other meshes.
std::vector<EventRemark> event_remarks(const Case& one, const Device& device, const Solution& own,
                                       const std::vector<Solution>& others,
                                       const std::vector<ErrorEstimate>& estimates);

/// Of the limit point at which a run without time has ended: the voltage there, where that differs from mesh
/// to mesh, otherwise the load factor, with its error; or that there is none with `others`. Its error is of
/// an order between these.
EventRemark remark_on_end(const Case& one, const Solution& own, const std::vector<Solution>& others,
                          OrderRange orders);

/// Solves the case once more with each of other_discretisations() and compares. `own` has run to its end, or
/// without time to a limit point, where nothing but that is compared; `outcome` says to which. `records` are
/// of all its states, `margins` its own. A solution that took another way (critical points, jumps, unstable
/// modes, or an early end) tells nothing.
Estimates estimate_errors(const Case& one, const Simulation& own, const Outcome& outcome,
                          std::span<const post::StepRecord> records, const std::vector<Margin>& margins,
                          int threads);

} // namespace dielast::cases
