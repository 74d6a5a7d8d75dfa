#pragma once

#include "fem/equilibrium.hpp"

namespace dielast::fem {

/// What a step ramps: from the state's own voltages and dead forces to these.
struct RampTarget {
  std::vector<double> voltage; ///< V, per electrode
  Eigen::VectorXd dead_force;  ///< per equation
};

struct RampOptions {
  NewtonOptions newton;
  int increments = 1;
  double smallest_increment = 1e-3; ///< of the load factor; a step that needs less gives up
};

/// What an accepted increment was like.
struct Increment {
  double load_factor = 0;
  NewtonResult newton;
};

/// Where a ramp stands between two increments. A value: stored with the state it lets a run go on bit for
/// bit.
struct RampProgress {
  RampTarget start;              ///< loads at load factor 0
  double load_factor = 0;        ///< of the last accepted increment
  double increment = 0;          ///< next to be tried, of the load factor
  int negative_pivots = -1;      ///< of the branch being followed; -1 before the first increment
  std::vector<PathPoint> points; ///< last accepted states, oldest first, for the predictor

  /// Nothing done yet: the ramp starts from the loads that `state` carries.
  static RampProgress begin(const State& state, const RampOptions& options);
};

/// Watches a ramp. Every method may be left out.
struct RampObserver {
  std::function<void(double load_factor)> on_try;
  std::function<void(const Iteration&)> on_iteration;
  std::function<void(double load_factor, const NewtonResult&)> on_cutback;
  /// Returns false to stop here (interrupt).
  std::function<bool(const RampProgress&, const Increment&)> on_accept;
};

enum class RampEnd { complete, gave_up, stopped };

struct RampResult {
  RampEnd end{};
  double failed_at = 0;   ///< smallest load factor that was tried in vain (gave_up)
  NewtonResult failure{}; ///< how it failed
};

/// Load control: voltages and dead forces grow linearly with the load factor s in 0..1 in equal increments.
/// Each solve starts from a polynomial in the largest Phi^2 (the parameter in which the film's energy is
/// linear) through up to four earlier states. An increment that fails, or that lands on a less stable branch,
/// is halved; after successes it grows back. A branch that is less stable even after the smallest increment
/// is followed: the change of inertia is then a bifurcation, not a limit point.
/// `progress.points.back().state` is the last accepted state.
RampResult ramp(Equilibrium& equilibrium, const RampTarget& target, const RampOptions& options,
                RampProgress& progress, const RampObserver& observer);

} // namespace dielast::fem
