// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/continuation.hpp"

#include "fem/model/contact_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dielast::fem {

namespace {

constexpr double least_share = 0.1; ///< of displacements in the way of a path, see unit()
constexpr double least_unit =
    1e-7; ///< length of displacements as large as the model where they are next to none
constexpr double slowest = 1.0 / 3;  ///< of a step: length of the direction over that before
constexpr double least_cosine = 0.7; ///< of a step: between the directions of its ends
constexpr double straight = 0.3;     ///< of a step: how far off the mean direction of its ends
constexpr double difference = 1e-4;  ///< of load factors; central differences are exact for quadratic loads

/// E, so small that displacements are at least this share of the way so far: what is soft beside stiff parts
/// would turn within a step that is too short to be taken.
double unit(const Equilibrium& equilibrium, const ContinuationProgress& at) {
  if (at.load_way == 0) return equilibrium.energy_scale();
  const double short_of = at.way / (least_share * at.load_way);
  return equilibrium.energy_scale() * std::pow(std::clamp(short_of, least_unit, 1.0), 2);
}

/// D du / E: the row that makes . du an inner product.
Eigen::VectorXd dual(const Equilibrium& equilibrium, const ContinuationProgress& at,
                     const Eigen::VectorXd& du) {
  return equilibrium.stiffness().cwiseProduct(du) / unit(equilibrium, at);
}

/// sqrt(du^T D du / E): the length of displacements.
double length_of(const Equilibrium& equilibrium, const ContinuationProgress& at, const Eigen::VectorXd& du) {
  return std::sqrt(dual(equilibrium, at, du).dot(du));
}

/// Makes the direction one of length 1; the length that it had is returned.
double normalise(const Equilibrium& equilibrium, ContinuationProgress& at) {
  const double length = std::hypot(length_of(equilibrium, at, at.direction), at.load_direction);
  at.direction /= length;
  at.load_direction /= length;
  return length;
}

/// Factors the tangent at a point, bordered by the path through it in this direction; false at a singular
/// one.
bool factor_along(Equilibrium& equilibrium, const LoadPath& path, const ContinuationProgress& at,
                  const Eigen::VectorXd& direction, double load_direction) {
  const Eigen::Index free = equilibrium.model().dofs.free_count();
  const PathBorder border{load_derivative(equilibrium, path, at.state, at.load_factor).head(free),
                          dual(equilibrium, at, direction), load_direction};
  return equilibrium.factor(at.state, &border);
}

/// Sets direction and inertia at a converged point, after factor_along() there. The new direction makes an
/// acute angle with the one that was given to that, whose cosine is returned.
std::optional<double> turn(Equilibrium& equilibrium, ContinuationProgress& at) {
  at.newton.negative_pivots = equilibrium.tangent().negative_pivots();
  at.newton.unstable_modes = equilibrium.tangent().unstable_modes();
  const Eigen::Index free = equilibrium.model().dofs.free_count();
  at.load_direction = equilibrium.tangent().solve(Eigen::VectorXd::Zero(free), at.direction, 1);
  const double length = normalise(equilibrium, at);
  if (!std::isfinite(length)) return std::nullopt;
  return 1 / length; // their product is 1 before this one is normalised
}

/// Counts the way of a step, at whose end lengths are as unit() is then.
void count_way(const Equilibrium& equilibrium, const ContinuationProgress& from, ContinuationProgress& to) {
  const Eigen::VectorXd du = equilibrium.model().dofs.increment(from.state, to.state);
  to.way += std::sqrt(equilibrium.stiffness().cwiseProduct(du).dot(du) / equilibrium.energy_scale());
  to.load_way += std::abs(to.load_factor - from.load_factor);
  to.arc *= normalise(equilibrium, to);
}

/// Whether the unknowns went back by more than the prediction `arc` x direction was to take them on: where
/// that is nearly all of the load factor's, Newton's method may end on another path at that load factor.
bool went_back(const Equilibrium& equilibrium, const ContinuationProgress& from, double arc,
               const Eigen::VectorXd& moved) {
  return arc * dual(equilibrium, from, from.direction).dot(moved) < 0 &&
         length_of(equilibrium, from, moved) > std::abs(arc) * length_of(equilibrium, from, from.direction);
}

/// Whether a step that `moved` the unknowns is one along a path with these directions at its ends.
/// Where the load factor is nearly all of an arc's length, a step past a limit point may end on another
/// branch, or on the same one with the direction that leads back. In the smallest steps a path may have
/// corners.
bool goes_straight(const Equilibrium& equilibrium, const ContinuationProgress& from,
                   const ContinuationProgress& to, const Eigen::VectorXd& moved) {
  const double arc = to.last_arc;
  const auto length = [&](const Eigen::VectorXd& du) { return length_of(equilibrium, from, du); };
  const double most = std::max(length(from.direction), length(to.direction));
  if (std::max(std::abs(arc), length(moved)) <= ContinuationOptions::largest_corner &&
      length(moved) <= 2 * std::abs(arc) * most)
    return true;
  return length(to.direction) >= slowest * length(from.direction) &&
         length(moved / arc - (from.direction + to.direction) / 2) <= straight * most;
}

/// Whether a point that `moved` the unknowns from the one before is not the path's next.
bool leads_astray(const Equilibrium& equilibrium, const ContinuationProgress& from,
                  const ContinuationProgress& to, double cosine, const Eigen::VectorXd& moved) {
  const Model& model = equilibrium.model();
  return cosine < least_cosine || !goes_straight(equilibrium, from, to, moved) ||
         is_turned_over(model.corners, model.drawn, from.state, to.state);
}

/// The point where the path crosses the load factor s between two points close by.
std::optional<ContinuationProgress> land(Equilibrium& equilibrium, const LoadPath& path,
                                         const NewtonOptions& options, const ContinuationProgress& from,
                                         ContinuationProgress beyond, double s) {
  const Eigen::VectorXd direction = beyond.direction;
  const double load_direction = beyond.load_direction;
  if (load_direction == 0) return std::nullopt;
  const double arc = (s - beyond.load_factor) / load_direction;
  equilibrium.model().dofs.advance(beyond.state, direction, arc);
  beyond.load_factor = s;
  beyond.last_arc += arc;
  path.apply(beyond.state, s);
  beyond.newton = equilibrium.solve(beyond.state, options);
  if (beyond.newton.outcome != Outcome::converged ||
      !factor_along(equilibrium, path, beyond, direction, load_direction))
    return std::nullopt;
  const auto cosine = turn(equilibrium, beyond);
  const Eigen::VectorXd moved = equilibrium.model().dofs.increment(from.state, beyond.state);
  if (!cosine || leads_astray(equilibrium, from, beyond, *cosine, moved)) return std::nullopt;
  return beyond;
}

} // namespace

Eigen::VectorXd load_derivative(Equilibrium& equilibrium, const LoadPath& path, const State& state,
                                double s) {
  Balance more, less;
  State at = state;
  path.apply(at, s + difference);
  equilibrium.balance(at, more);
  path.apply(at, s - difference);
  equilibrium.balance(at, less);
  return (more.force - less.force) / (2 * difference);
}

double distance(const Equilibrium& equilibrium, const ContinuationProgress& at, const State& from,
                const State& to) {
  return length_of(equilibrium, at, equilibrium.model().dofs.increment(from, to));
}

std::optional<ContinuationProgress> begin_continuation(Equilibrium& equilibrium, const LoadPath& path,
                                                       const State& state, double s,
                                                       const ContinuationOptions& options) {
  ContinuationProgress progress{.state = state, .load_factor = s, .arc = options.first_arc};
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(equilibrium.model().dofs.free_count());
  if (!factor_along(equilibrium, path, progress, still, 1) || !turn(equilibrium, progress))
    return std::nullopt;
  return progress;
}

std::optional<ContinuationProgress> arc_step(Equilibrium& equilibrium, const LoadPath& path,
                                             const ContinuationProgress& from, double arc,
                                             const NewtonOptions& options, bool leaves) {
  const DofMap& dofs = equilibrium.model().dofs;
  ContinuationProgress to = from;
  to.load_factor += arc * from.load_direction;
  dofs.advance(to.state, from.direction, arc);
  if (free_way(equilibrium.model(), from.state, to.state) < 1) return std::nullopt;
  to.last_arc = arc;
  ++to.steps;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double previous_norm = infinity, previous_residual = infinity, step = infinity;
  Balance current;
  Eigen::VectorXd du, moved = arc * from.direction;
  for (to.newton = {};; ++to.newton.iterations) {
    if (!apply_freely(equilibrium.model(), to.state,
                      [&](State& state) { path.apply(state, to.load_factor); }))
      return std::nullopt;
    equilibrium.balance(to.state, current);
    if (!current.feasible) return std::nullopt;
    to.newton.residual = current.scale > 0 ? current.norm / current.scale : 0;
    const double admitted = equilibrium.admitted_correction(current, options.tolerance, previous_norm, step);
    const bool ends = to.newton.iterations >= options.max_iterations || current.norm > 1e3 * previous_norm;
    if ((ends && admitted == 0) || !factor_along(equilibrium, path, to, from.direction, from.load_direction))
      return std::nullopt;
    const double change = equilibrium.tangent().solve(-current.force.head(dofs.free_count()), du);
    const double last_step = std::exchange(step, equilibrium.step_size(du));
    if (admitted > 0 && is_settled(step, admitted, last_step, previous_residual)) break;
    if (ends) return std::nullopt;
    previous_norm = current.norm;
    previous_residual = to.newton.residual;
    to.load_factor += change;
    const State before = to.state;
    dofs.advance(to.state, du, 1);
    moved += du;
    if (free_way(equilibrium.model(), before, to.state) < 1) return std::nullopt;
  }
  if (went_back(equilibrium, from, arc, moved)) return std::nullopt;
  to.newton.outcome = Outcome::converged;
  const auto cosine = turn(equilibrium, to);
  if (!cosine || (leaves ? *cosine < 0 : leads_astray(equilibrium, from, to, *cosine, moved)))
    return std::nullopt;
  to.state.history = equilibrium.model().advanced_history(to.state);
  return to;
}

ContinuationEnd continuation(Equilibrium& equilibrium, const LoadPath& path,
                             const ContinuationOptions& options, ContinuationProgress& progress,
                             const ContinuationObserver& observer) {
  if (progress.steps > 0 && (progress.load_direction > 0 ? progress.load_factor >= options.highest
                                                         : progress.load_factor <= options.lowest))
    return ContinuationEnd::reached_load; // stopped there before
  while (progress.steps < options.most_steps) {
    const double arc = progress.arc;
    auto next = arc_step(equilibrium, path, progress, arc, options.newton);
    const bool above = next && next->load_factor >= options.highest;
    const bool ends = above || (next && next->load_factor < options.lowest);
    if (ends)
      next =
          land(equilibrium, path, options.newton, progress, *next, above ? options.highest : options.lowest);
    if (next && observer.admits && !observer.admits(progress, *next)) next.reset();
    if (!next) {
      if (observer.on_cutback) observer.on_cutback(arc);
      progress.arc = arc / 2;
      if (progress.arc < options.smallest_arc) return ContinuationEnd::gave_up;
      continue;
    }
    const double growth =
        std::sqrt(static_cast<double>(options.wanted_iterations) / std::max(1, next->newton.iterations));
    next->arc = std::min(options.largest_arc, arc * std::clamp(growth, 0.5, 2.0));
    count_way(equilibrium, progress, *next);
    progress = std::move(*next);
    if (observer.on_accept && !observer.on_accept(progress)) return ContinuationEnd::stopped;
    if (ends) return ContinuationEnd::reached_load;
  }
  return ContinuationEnd::took_all_steps;
}

} // namespace dielast::fem
