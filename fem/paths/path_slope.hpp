// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"
#include "fem/paths/load_path.hpp"

#include <span>

namespace dielast::fem {

/// Slope du/ds per free equation at `state`, converged at s. The equilibrium's tangent must be factored
/// there, or one small step before. The loads are varied from s towards s + `reach`, no farther: beyond, the
/// path may have a break. `known`: the state's balance, where it has been evaluated.
Eigen::VectorXd slope_at(Equilibrium& equilibrium, const LoadPath& path, const State& state, double s,
                         double reach, const Balance* known = nullptr);

/// Whether a predictor through the `points` of a path has led to `trial`, at `parameter`, closely, in the
/// norm of `stiffness` (per free equation). As a predictor that runs away may meet another branch, the path
/// must not have become more than so many times `faster` either since the increment before; one that
/// `swings`, and has hardly moved where it turns round, since the fastest increment between the points.
bool is_foreseen(const DofMap& dofs, const Eigen::VectorXd& stiffness, std::span<const PathPoint> points,
                 double parameter, const State& predicted, const State& trial, double faster,
                 bool swings = false);

/// Whether an increment is too small to tell of a path, in the norm of `stiffness` (per free equation).
bool is_still(const Equilibrium& equilibrium, const Eigen::VectorXd& stiffness, const State& from,
              const State& to);

/// Whether a corner of a path may have led to `trial`: no node is farther from where it was foretold than a
/// thousandth of the model's extent. Beside a corner that goes with the increment; behind a jump it stays.
bool is_beside_corner(const Model& model, const State& predicted, const State& trial);

/// How far an increment may be from what the slopes at its ends tell of it; see is_joined().
struct Steadiness {
  double chord, energy, energy_of_faster;
  double slowest;           ///< slope at the end over that at the beginning
  double steady;            ///< where the chord is as near as this to the mean slope it tells all
  bool beside_film = false; ///< whether only the energy is asked of what film alone moves
  static constexpr Steadiness resolved(double slowest = 1.0 / 3) { return {0.1, 0.1, 0.25, slowest, 0}; }
  /// For increments so short that they may hold a kink of the path, where wrinkles begin, but no other
  /// branch.
  static constexpr Steadiness kinked() { return {0.5, 0.5, 0.5, 0, 0.05}; }
  static constexpr Steadiness of_length(double increment) {
    constexpr double longest_kinked = 1e-4;
    return increment > longest_kinked ? resolved() : kinked();
  }
  /// For film that wrinkles: across them it may be anywhere. `others`: for what resists beside it.
  static constexpr Steadiness wrinkled(const Steadiness& others) {
    return {others.chord, 0.5, 0.5, others.slowest, 0, true};
  }
};

/// A converged state and how an equilibrium path u(s) goes through it.
struct PathEnd {
  const State& state;
  double s;
  const Eigen::VectorXd& slope;     ///< du/ds, see slope_at(); empty where the tangent is singular
  const Balance* balance = nullptr; ///< of the state, where it has been evaluated
};

/// Whether the state `to` lies on the path that goes through `from`: Newton's method may have found a state
/// of another branch beyond a limit point. In the norm of Equilibrium::stiffness(), the chord c = u1 - u0 is
/// compared with the mean v of the slopes v0, v1 at both ends, and the change of the potential P with the
/// works w0, w1 that the loads would do on their way from s0 to s1 with the shape of either end:
///   |c - v| <= chord max(|v0|, |v1|)  and  |P1 - P0 - (w0 + w1)/2| <= energy |w1 - w0|.
/// In other words: what the film sets free on its way from u0 to u1 under the loads at the end is what this
/// way would cost it under those at the start; however the loads go from one to the other.
/// Where the path gets faster, |v1| > |v0|, it may do so up to the square root at a limit point: c may be
/// near any point between v0 and v, and the energy may miss `energy_of_faster`. Where it misses next to
/// nothing, and c is no longer than the longer slope, c may be near any point of the plane of v0 and v1:
/// loads that do not go straight on lead there. Right before a limit point v0 is as long as one likes, and
/// what a jump sets free may be what the curved way to it misses: |v1| >= slowest |v0|, each over the rate of
/// the loads. Where |c - v| <= steady max(|v0|, |v1|) the energy is not asked: while nothing but dashpots
/// move, the works differ by the time schemes of their increments, and by nothing else. What a film has set
/// free on its way to another branch is missing from the energy; on another branch it is mostly slower. An
/// increment that fails may just be too long. `to.slope` must not be that of a singular tangent.
bool is_joined(Equilibrium& equilibrium, const LoadPath& path, const PathEnd& from, const PathEnd& to,
               const Steadiness& steadiness);

/// Whether any film carries tension in one direction only, or in none.
bool is_wrinkled(const Model& model, const State& state);

} // namespace dielast::fem
