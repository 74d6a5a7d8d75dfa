// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/runs/recorder.hpp"

namespace dielast::cases {

/// How far a limit is from the state at the end of a run, as a factor on all of its voltages.
struct Margin {
  std::string limit;            ///< "breakdown", "loss of tension", "pull-in", "buckling", "wall yield"
  std::optional<double> factor; ///< below 1: it was passed on the way; absent: see the remark
  double up_to = 1;             ///< factor up to which the run, or what was looked at beyond it, tells
  std::string remark;           ///< why there is no factor or no error of it, or what it does not tell
  std::optional<double> error;  ///< of the factor: estimated discretisation error
};

constexpr double margin_accuracy = 1e-6; ///< of the factor, to which it is solved for

/// What the states of a run tell of its limits, and with [output] margins_up_to those beyond its end, which
/// are solved for here. Voltages rise together, in proportion.
std::vector<Margin> margins_of(const Case& one, const Simulation& simulation, const Journal& journal,
                               const Outcome& outcome, int threads);

/// That of a quantity of kind "margin"; NaN: there is none.
double factor_to(const std::string& limit, const std::vector<Margin>& margins);

} // namespace dielast::cases
