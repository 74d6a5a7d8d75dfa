// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"
#include "fem/paths/path_slope.hpp"

#include <optional>

namespace dielast::fem {

/// Load factors nearer than this are one.
inline constexpr double load_factor_round_off = 1e-9;

struct RampOptions {
  NewtonOptions newton;
  int increments = 1;               ///< the largest increment is this part of the step
  double smallest_increment = 1e-3; ///< of the load factor; a step that needs less gives up
  int most_tries = 1000000;  ///< increments, in vain or not; a step that needs more for a tenth has no end
  double landing = 0;        ///< load factors at whose multiples a result is wanted; 0: at every 1/increments
  std::vector<double> stops; ///< load factors where results are wanted instead, ascending, and at the end
  double duration = 0;       ///< s; 0: no time passes
  bool instantaneous = false;   ///< no time passes: dashpots stay as they are; otherwise they flow to the end
  double time_tolerance = 1e-6; ///< local error of internal variables and motion per increment, relative
  double first_time_step = 0;   ///< s, after every break; 0: the largest increment
  double shortest_relaxation = 0; ///< s, of all that flows; 0: unknown, or nothing flows
  double longest_relaxation = 0;  ///< s, the longest
  bool inertia = false;           ///< what has a mass moves by generalised-alpha; otherwise without inertia
  double high_frequencies = 0.8;  ///< what generalised-alpha leaves of the highest ones after a step, 0..1

  /// The smallest part of the step that is tried; without time less `beside` another branch: where the path
  /// runs into one, Newton's method finds states of that one from afar, and is slow nearer by.
  double smallest(bool beside = false) const;
  /// Whether what flows within the smallest part of a step may still do so within this one: BDF2 would swing
  /// about where it ends, backward Euler's method does not.
  bool outruns(double part) const;
  /// Where behind the load factor s a result is wanted.
  double next_landing(double s) const;
};

/// What an accepted increment was like.
struct Increment {
  double load_factor = 0;
  NewtonResult newton;
  bool lands = true;   ///< a result was wanted here
  double length = 1;   ///< of the path from the last accepted state, in a parameter in which it is smooth
  bool turns = false;  ///< the path had a corner at the last accepted state
  bool jumped = false; ///< the loads have jumped here, at once: the state before is of the same time
  int unstable_before = -1; ///< unstable modes of the last accepted state; -1: unknown
  double time_error = 0; ///< that the time step may have added, relative; of the first ones after a break the
                         ///< tolerance
  bool flowed = false;   ///< dashpots that had been frozen were let go, with the loads as they are
};

/// Where a ramp stands between two increments. A value: stored with the state it lets a run go on bit for
/// bit.
struct RampProgress {
  Loads start;             ///< at load factor 0
  double load_factor = 0;  ///< of the last accepted increment
  double increment = 0;    ///< next to be tried, of the load factor
  bool at_break = true;    ///< loads may jump now: dashpots stay, the time scheme starts again
  bool turns = true;       ///< the path has a corner at the last accepted state
  bool beside = false;     ///< since the last full increment one has led to another branch
  int unstable_modes = -1; ///< of the branch being followed; -1 before the first increment
  /// du/ds of the path at the last accepted state, where it is known; empty where the tangent is singular.
  std::optional<Eigen::VectorXd> slope;
  std::vector<PathPoint> points; ///< last accepted states, oldest first, for the predictor

  /// Nothing done yet: the ramp starts from the loads that `state` carries.
  static RampProgress begin(const State& state, const DofMap& dofs, const RampOptions& options);
};

/// Watches a ramp. Every method may be left out.
struct RampObserver {
  std::function<void(double load_factor)> on_try;
  std::function<void(const Iteration&)> on_iteration;
  std::function<void(double load_factor, const NewtonResult&)> on_cutback;
  /// Whether a converged state may be accepted; the increment to one that may not is halved like one that
  /// fails.
  std::function<bool(double load_factor, const State&)> admits;
  /// Returns false to stop here (interrupt).
  std::function<bool(const RampProgress&, const Increment&)> on_accept;
};

enum class RampEnd { complete, gave_up, stopped, endless };

struct RampResult {
  RampEnd end{};
  double failed_at = 0;   ///< smallest load factor that was tried in vain (gave_up)
  NewtonResult failure{}; ///< how it failed
};

/// Load control: the loads follow `path` while the load factor s grows from 0 to 1 and, if the step has a
/// duration, time passes with it.
///
/// Each solve starts from a polynomial in the path's parameter through earlier states, see predict(). An
/// increment that fails, or that lands on a less stable branch, is halved; after successes it grows back. A
/// branch that is less stable even after the smallest increment is followed: the change of inertia is then a
/// bifurcation, not a limit point.
///
/// A state is accepted only on the path that leads through the states before: no element has turned over
/// (see is_turned_over()), and the state is where the polynomial foresaw it, or agrees with the slopes of the
/// path at both ends of the increment (is_joined()). An increment that Newton's method has taken to another
/// branch is halved like one that fails, as often as it takes: a continuous path lets it through at last, a
/// limit point never.
///
/// In time the dashpots go by BDF2, after a break by one backward Euler step. The local error is estimated
/// from the distance to the polynomial through the last three accepted internal variables (Milne's device);
/// steps grow at most by two. With inertia the step is generalised-alpha's (backward Euler after a break),
/// and so is its error, relative to a hundredth of the model's extent. What has no mass follows what has one;
/// an increment over which it does so in another way than foreseen is halved until it hardly moves. Loads
/// that jump at a break act at once, with the dashpots as they are, and, with inertia, the masses held: in
/// parts, so that their work can be told. An increment that is as small as may be, and still too long for
/// what flows in it, is accepted where is_reached_continuously(). Where no time passes and dashpots flow that
/// have not flowed before, or charge that has not spread along its sheet, they do so first, at the loads that
/// the step starts from: while the forces fade that are missing once they have flowed, or, where that leads
/// to no equilibrium (such forces leave a slender shell under the compression that its branches bore), in
/// time.
///
/// `progress.points.back().state` is the last accepted state.
RampResult ramp(Equilibrium& equilibrium, const LoadPath& path, const RampOptions& options,
                RampProgress& progress, const RampObserver& observer);

} // namespace dielast::fem
