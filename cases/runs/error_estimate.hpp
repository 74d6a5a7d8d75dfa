// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/fitting/richardson.hpp"
#include "cases/runs/simulation.hpp"

#include <span>
#include <string>
#include <vector>

namespace dielast::cases {

struct Margin;

/// An event of film or walls that depends on the mesh, or that did not happen but may on another.
struct EventRemark {
  std::string kind; ///< "loss of tension", "breakdown", "wall yield", "wall contact"
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

/// Solves the case once more with each of other_discretisations() and compares. `own` has run to its end,
/// `records` are of all its states, `margins` its own. A solution that took another way (critical points,
/// jumps, unstable modes, or an early end) tells nothing.
Estimates estimate_errors(const Case& one, const Simulation& own, std::span<const post::StepRecord> records,
                          const std::vector<Margin>& margins, int threads);

} // namespace dielast::cases
