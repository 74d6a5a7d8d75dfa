// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/paths/ramp.hpp"

#include <optional>

namespace dielast::fem {

/// Forces that would balance `state` under its own loads and time scheme, added to its dead forces and taken
/// away while the load factor goes from 0 to 1: a path on which no time passes.
LoadPath fading_imbalance(Equilibrium& equilibrium, const State& state);

/// Where a device comes to rest that is not in equilibrium as its masses no longer move: at the same loads,
/// its dashpots as they are, along a path on which the missing forces fade. Nothing where there is none.
std::optional<State> at_rest(Equilibrium& equilibrium, State state, const RampOptions& options);

/// The state in which dashpots, and charges along sheets, have flowed for many of their longest relaxation
/// times (options.longest_relaxation) at the loads as they are: a path in time without inertia, coarse in
/// time; its end has the time of `state`. Nothing where that path ends before, or without such times.
std::optional<State> flown(Equilibrium& equilibrium, const State& state, const RampOptions& options);

/// Whether a state that one increment in time has led to is also reached from the last state by a stable,
/// continuous path: at the loads and with the time scheme of the increment, while the forces fade that the
/// last state lacks for equilibrium. So dashpots and charges that flow much faster than the smallest
/// increment are told from a state beyond a limit point.
bool is_reached_continuously(Equilibrium& equilibrium, const State& from, const State& to,
                             const RampOptions& options);

/// Whether a state that was found from slack film, from which no path leads, is on one that leads back to
/// slack film, or to almost none of the loads of `increment`, which leads from 0 to `state` at 1.
bool leads_back_to_slack(Equilibrium& equilibrium, const LoadPath& increment, State state,
                         const RampOptions& options);

} // namespace dielast::fem
