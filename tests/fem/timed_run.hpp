// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/paths/energy_balance.hpp"
#include "fem/paths/ramp.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::test {

/// Every state that a ramp in time accepted, that behind the jump at its start first.
struct TimedRun {
  std::vector<State> states;
  EnergyBalance balance;

  const State& end() const { return states.back(); }
};

/// Takes the next accepted state into the account.
inline void account(EnergyBalance& balance, Equilibrium& equilibrium, const State& from, const State& to,
                    const Increment& increment) {
  if (increment.turns) balance.corner();
  EnergyPoint point = energy_point(equilibrium, to, increment.length);
  point.flow =
      flow_heat(equilibrium, from, holding(equilibrium, from).energy, to, holding(equilibrium, to).energy);
  follow_spins(equilibrium.model().dofs, from, to, balance.record().points.back().mechanical.coordinate,
               point.mechanical.coordinate);
  balance.add(std::move(point));
}

inline TimedRun run_in_time(Equilibrium& equilibrium, const State& start, const LoadPath& path,
                            const RampOptions& options) {
  TimedRun run{{start}, {}};
  run.balance.add(energy_point(equilibrium, start, 0));
  RampProgress progress = RampProgress::begin(start, equilibrium.model().dofs, options);
  RampObserver observer;
  observer.on_accept = [&](const RampProgress& at, const Increment& increment) {
    const State& state = at.points.back().state;
    account(run.balance, equilibrium, run.states.back(), state, increment);
    if (run.states.back().time == state.time) run.states.pop_back();
    run.states.push_back(state);
    return true;
  };
  EXPECT_EQ(ramp(equilibrium, path, options, progress, observer).end, RampEnd::complete);
  return run;
}

/// Everything prescribed stays as it is in `state`.
inline LoadPath constant_loads(const DofMap& dofs, const State& state) {
  return linear_path(dofs, Loads::of(state, dofs), Loads::of(state, dofs));
}

/// Equal steps, whatever their error.
inline RampOptions equal_steps(int steps, double duration) {
  return {.newton = {.tolerance = 1e-12}, .increments = steps, .duration = duration, .time_tolerance = 1e9};
}

} // namespace dielast::fem::test
