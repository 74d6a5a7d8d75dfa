// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/homotopy.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr double fading_part = 1e-3;    ///< of forces, at least
constexpr int back_parts = 8;           ///< of loads that are taken back
constexpr double almost_none = 0.02;    ///< of the loads
constexpr double same_state = 1e-3;     ///< of the way
constexpr double relaxation_times = 30; ///< after which little is left that flows
constexpr double coarse_in_time = 1e-4; ///< of internal variables, where only the end is wanted
constexpr double rounded_state = 1e-7;  ///< mean displacement over the extent, where nothing moves

} // namespace

LoadPath fading_imbalance(Equilibrium& equilibrium, const State& state) {
  State at = state;
  Balance balance;
  equilibrium.balance(at, balance);
  Eigen::VectorXd lacking = Eigen::VectorXd::Zero(balance.force.size());
  const Eigen::Index free = equilibrium.model().dofs.free_count();
  lacking.head(free) = balance.force.head(free);
  LoadPath path;
  path.apply = [loads = state.dead_force, lacking = std::move(lacking)](State& now, double part) {
    now.dead_force = loads + (1 - part) * lacking;
  };
  return path;
}

std::optional<State> at_rest(Equilibrium& equilibrium, State state, const RampOptions& options) {
  state.motion.reset();
  state.scheme = materials::TimeScheme::frozen();
  const LoadPath path = fading_imbalance(equilibrium, state);
  path.apply(state, 0);
  const RampOptions fading{.newton = options.newton,
                           .smallest_increment = std::min(options.smallest_increment, fading_part),
                           .instantaneous = true};
  RampProgress progress = RampProgress::begin(state, equilibrium.model().dofs, fading);
  if (ramp(equilibrium, path, fading, progress, {}).end != RampEnd::complete) return std::nullopt;
  return progress.points.back().state;
}

std::optional<State> flown(Equilibrium& equilibrium, const State& state, const RampOptions& options) {
  if (!(options.longest_relaxation > 0)) return std::nullopt;
  const RampOptions in_time{.newton = options.newton,
                            .smallest_increment = options.smallest_increment,
                            .duration = relaxation_times * options.longest_relaxation,
                            .time_tolerance = std::max(options.time_tolerance, coarse_in_time),
                            .first_time_step = options.first_time_step};
  LoadPath still;
  still.apply = [](State&, double) {};
  RampProgress progress = RampProgress::begin(state, equilibrium.model().dofs, in_time);
  if (ramp(equilibrium, still, in_time, progress, {}).end != RampEnd::complete) return std::nullopt;
  State end = progress.points.back().state;
  end.time = state.time;
  end.history = without_past(*end.history);
  return end;
}

bool is_reached_continuously(Equilibrium& equilibrium, const State& from, const State& to,
                             const RampOptions& options) {
  const Model& model = equilibrium.model();
  State state = to;
  state.displacement = from.displacement;
  state.rotation = from.rotation;
  state.angle = from.angle;
  state.scalar = from.scalar;
  Loads::of(to, model.dofs).apply(state, model.dofs);
  const LoadPath path = fading_imbalance(equilibrium, state);
  path.apply(state, 0);
  const bool regular = equilibrium.factor(state);
  const int unstable_modes = regular ? equilibrium.tangent().unstable_modes() : 0;
  Eigen::VectorXd slope;
  if (regular) slope = slope_at(equilibrium, path, state, 0, 1);
  double faded = 0, part = 1;
  while (faded < 1) {
    part = std::min(part, 1 - faded);
    State trial = state;
    path.apply(trial, faded + part);
    const NewtonResult newton = equilibrium.balance_forces(trial, options.newton);
    bool joined = newton.outcome == Outcome::converged && newton.unstable_modes <= unstable_modes &&
                  !is_turned_over(model.corners, model.drawn, state, trial);
    if (joined) {
      Eigen::VectorXd next = slope_at(equilibrium, path, trial, faded + part, -part);
      joined = is_joined(equilibrium, path, {state, faded, slope}, {trial, faded + part, next},
                         Steadiness::resolved(0));
      if (joined) slope = std::move(next);
    }
    if (!joined) {
      part /= 2;
      if (part < options.smallest_increment) return false;
      continue;
    }
    state = std::move(trial);
    faded += part;
    part *= 2;
  }
  const auto size = [&](const State& a, const State& b) {
    const Eigen::VectorXd u = model.dofs.increment(a, b);
    return std::sqrt(u.dot(equilibrium.stiffness().cwiseProduct(u)));
  };
  return size(state, to) <=
         same_state * size(from, to) + rounded_state * std::sqrt(equilibrium.energy_scale());
}

bool leads_back_to_slack(Equilibrium& equilibrium, const LoadPath& increment, State state,
                         const RampOptions& options) {
  LoadPath back;
  back.apply = [&](State& at, double part) { increment.apply(at, 1 - part * (1 - almost_none)); };
  const RampOptions parts{.newton = options.newton,
                          .increments = back_parts,
                          .smallest_increment = options.smallest_increment,
                          .instantaneous = options.duration > 0 || options.instantaneous};
  if (options.duration > 0) state = equilibrium.model().settled(std::move(state));
  RampProgress progress = RampProgress::begin(state, equilibrium.model().dofs, parts);
  const RampObserver watcher{.on_accept = [&](const RampProgress& now, const Increment&) {
    return !equilibrium.is_slack(now.points.back().state);
  }};
  return ramp(equilibrium, back, parts, progress, watcher).end != RampEnd::gave_up;
}

} // namespace dielast::fem
