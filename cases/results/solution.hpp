// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/discretisation.hpp"
#include "cases/results/margins.hpp"
#include "cases/runs/simulation.hpp"

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// A critical point or a jump.
struct Turn {
  std::string kind, step;
  bool operator==(const Turn&) const = default;
};

/// What has become of the case on one discretisation.
struct Solution {
  double size = 1; ///< of its elements and time steps, over the run's
  std::vector<double> values;
  std::vector<double> rises;      ///< see Simulation::rises()
  std::vector<Farthest> farthest; ///< see Measurement
  std::vector<Turn> way;          ///< what happened to the equilibrium, in order
  std::set<std::string> events;   ///< kinds of whatever else happened
  post::StepRecord last;          ///< the record of the last accepted state
  std::vector<Margin> margins;
  int time_steps = 0;
  std::string trouble; ///< why it did not reach its end (Outcome::kind, or what was thrown); empty otherwise

  /// Whether there was a turn of that kind.
  bool passes(std::string_view kind) const { return std::ranges::find(way, kind, &Turn::kind) != way.end(); }
};

/// That of a run.
Solution solution_of(const Simulation& run, const Outcome& outcome, std::span<const post::StepRecord> records,
                     std::vector<Margin> margins);

/// That of a case with another discretisation; what is thrown on its way is its trouble.
Solution solve(const Discretisation& discretisation, bool with_margins, int threads);

/// A device that leaves a symmetric path may do so to either side, on another mesh to the other one: of
/// values that tell the sides apart that of `own`.
double on_its_side(double value, const Solution& own, double own_value);

/// The quantity, or the one whose course it follows.
const Quantity& measured(const Quantity& quantity, const std::vector<Quantity>& all);

/// "elements half as large".
std::string size_text(double size);

/// Why a solution tells nothing of another; empty where it does.
std::string why_not(const Solution& own, const Solution& other);

} // namespace dielast::cases
