// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"
#include "fem/paths/load_path.hpp"

#include <optional>

namespace dielast::fem {

/// Lengths along an equilibrium path: da^2 = du . D du / E + ds^2 with D = Equilibrium::stiffness(). E is
/// energy_scale() at first, which makes it about the mean displacement over the model's extent, and the load
/// factor; where the way of the displacements is short beside that of the load factor it is smaller.
struct ContinuationOptions {
  /// Of steps within which a path may have kinks, and critical points that are one.
  static constexpr double largest_corner = 2e-5;
  NewtonOptions newton{.max_iterations = 10};
  double first_arc = 0.02;
  double smallest_arc = 1e-8; ///< a path that needs less is given up
  double largest_arc = 0.1;
  int wanted_iterations = 4; ///< steps grow below and shrink above
  int most_steps = 500;
  double lowest = 0, highest = 1; ///< load factors at which the path ends
};

/// A point on an equilibrium path. A value: stored, it lets a run go on bit for bit.
struct ContinuationProgress {
  State state;
  double load_factor = 0;
  Eigen::VectorXd direction; ///< du/da of the path here, per free equation
  double load_direction = 0; ///< ds/da here; its sign tells whether the load grows
  double arc = 0;            ///< length of the next step
  double last_arc = 0;       ///< length of the step that led here
  double way = 0;            ///< length of all displacements so far, by energy_scale()
  double load_way = 0;       ///< by how much the load factor has changed so far, up and down
  int steps = 0;             ///< accepted so far
  NewtonResult newton;       ///< of this point
};

/// Watches a continuation. Every method may be left out.
struct ContinuationObserver {
  /// Whether the path may lead from the one to the other; a step to one that may not is halved like one that
  /// fails.
  std::function<bool(const ContinuationProgress& from, const ContinuationProgress& to)> admits;
  /// Returns false to stop here.
  std::function<bool(const ContinuationProgress&)> on_accept;
  std::function<void(double arc)> on_cutback;
};

enum class ContinuationEnd { reached_load, took_all_steps, gave_up, stopped };

/// Starts a path at a converged `state` with load factor s, where the load grows at first. Nothing at a
/// singular point.
std::optional<ContinuationProgress> begin_continuation(Equilibrium& equilibrium, const LoadPath& path,
                                                       const State& state, double s,
                                                       const ContinuationOptions& options);

/// One step of length `arc`: along the tangent, then Newton's method in the plane normal to it. Nothing where
/// it does not converge or its end is none of the path's next: of another branch, or where the path has
/// turned by more than 45 degrees. `leaves`: the first step of a branch, which may turn by as much as 90
/// degrees.
std::optional<ContinuationProgress> arc_step(Equilibrium& equilibrium, const LoadPath& path,
                                             const ContinuationProgress& from, double arc,
                                             const NewtonOptions& options, bool leaves = false);

/// Length of the displacements between two states, as at this point of a path.
double distance(const Equilibrium& equilibrium, const ContinuationProgress& at, const State& from,
                const State& to);

/// Change of the unbalanced forces per load factor at fixed displacements of the free unknowns, N per
/// equation; of what is held its reactions'.
Eigen::VectorXd load_derivative(Equilibrium& equilibrium, const LoadPath& path, const State& state, double s);

/// Pseudo-arclength continuation (Keller 1977): follows the equilibrium path from `progress` on, through
/// limit points, with the load factor as one more unknown. Electrodes may be isolated. The path must be
/// smooth (no breaks) and defined a little beyond its ends; time stands still. One that was stopped where it
/// ends is at its end.
ContinuationEnd continuation(Equilibrium& equilibrium, const LoadPath& path,
                             const ContinuationOptions& options, ContinuationProgress& progress,
                             const ContinuationObserver& observer);

} // namespace dielast::fem
