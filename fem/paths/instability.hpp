// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/lowest_mode.hpp"
#include "fem/paths/continuation.hpp"
#include "fem/paths/path_slope.hpp"

#include <functional>

namespace dielast::fem {

/// At a limit point the load has an extremum along the path; at a bifurcation paths cross.
enum class Instability { limit_point, bifurcation };

/// A state in which the tangent is singular.
struct CriticalPoint {
  Instability kind{};
  double load_factor = 0;
  State state; ///< converged, at or just before the critical load
  Mode mode;   ///< there
  /// By load control: a state a little beyond, by its load factor, where a branch has come back to the path
  /// that it had left. The load turns there as at a limit point, but equilibria are as near beyond as before.
  std::optional<PathPoint> beyond{};
  /// Nothing is critical up to `beyond`: the path leads there, and what else was found there is beside it.
  bool is_none = false;
};

/// Limit point or bifurcation: whether the load works on the mode, |x . dR/ds| over |x| |dR/ds|, norms with D
/// and its inverse; what is rounding beside all forces is no work.
Instability classify(Equilibrium& equilibrium, const LoadPath& path, const State& state, double s,
                     const Mode& mode);

/// Locates the critical point between two points of a continuation, `after` one step from `before`, whose
/// numbers of unstable modes differ: secant steps on the eigenvalue as a function of the arc length, inside
/// a bracket. Nothing where the path cannot be followed to it.
std::optional<CriticalPoint> locate(Equilibrium& equilibrium, const LoadPath& path,
                                    const ContinuationProgress& before, const ContinuationProgress& after,
                                    const NewtonOptions& options);

/// The same by load control alone: `state` is converged at load factor s_before; at s_beyond Newton's method
/// fails, or has found `another` state: less stable, or not joined with those before (see is_joined()). Near
/// a limit point the eigenvalue goes with the square root of the distance in s, near a bifurcation with the
/// distance: extrapolated, that says where to go next. Ends when the critical load factor is known to 1e-7.
/// Nothing, too, where Newton's method fails without another state and without the eigenvalue vanishing: it
/// may have had too few iterations; nor where `goes_on`, asked before every trial, says false (interrupt).
/// Where the path leads to s_beyond by arclength, as stable as before, nothing is critical (`is_none`):
/// beside a bifurcation from which an imperfection keeps it Newton's method finds the other path from ever
/// nearer by.
std::optional<CriticalPoint> locate_by_load_control(Equilibrium& equilibrium, const LoadPath& path,
                                                    const State& state, double s_before, double s_beyond,
                                                    const NewtonOptions& options, bool another = false,
                                                    const std::function<bool()>& goes_on = {});

/// First point on the path that branches off: displaced from the critical state by `amplitude` (m, its sign
/// chooses the side) along the mode, where the load factor follows. Heads away from the bifurcation.
std::optional<ContinuationProgress> switch_branch(Equilibrium& equilibrium, const LoadPath& path,
                                                  const CriticalPoint& critical, double amplitude,
                                                  const ContinuationOptions& options);

} // namespace dielast::fem
