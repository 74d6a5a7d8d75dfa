// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"

#include "fem/model/contact_block.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <utility>

namespace dielast::fem {

namespace {

/// Below this many unknowns reading the clock takes longer than the work.
constexpr int worth_timing = 200;

/// Adds the CPU time of its own life to a counter, in models that are large enough.
class Stopwatch {
 public:
  Stopwatch(double& total, const Model& model)
      : total_(model.dofs.count() < worth_timing ? nullptr : &total), start_(total_ ? std::clock() : 0) {}
  ~Stopwatch() {
    if (total_) *total_ += static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double* total_;
  std::clock_t start_;
};

constexpr double sufficient_decrease = 1e-4;
constexpr int most_halvings = 12;
/// Relative residual below which one more step leaves the tangent's inertia as it is.
constexpr double near = 1e-3;
/// Weights of unknowns that have no stiffness as drawn (a slack film's, across it), over the stiffest's.
constexpr double least_stiffness = 1e-6;
constexpr double negligible = 1e-3; ///< strain to which the tolerance of steps refers
/// Corrections are computed where this many times what is foretold of them is more than is admitted, ...
constexpr double cautious = 100;
constexpr double soft =
    10; ///< ... and a film without nodal forces may have as many times what it was to have
constexpr double rounded_step = 1e-10; ///< over the extent; smaller ones may know no descent
/// Over the extent, of a correction that is more than `linear` of the last one: rounding, or a state whose
/// tangent is singular, to which Newton's steps halve the way.
constexpr double most_unresolved = 1e-6, linear = 0.2;
constexpr double farthest_step = 1e4; ///< over the extent; no part of a farther one leads anywhere
constexpr double first_widening = 0.02, most_widening = 0.5; ///< strains that give a film tension
constexpr int most_voltage_corrections = 30;
constexpr double charge_tolerance = 1e-13; ///< of the voltage
/// Of the voltage where corrections stagnate: charges of many elements that are alike are all rounded to the
/// same side.
constexpr double charge_rounding_of_many = 1e-10, stagnating = 0.5;
/// Of the charge: a hardly compressible filling turns it into much more of the pressure than
/// charge_tolerance.
constexpr double charge_rounding = 1e-15;
/// Iterations after which the residual must be smaller than at the start. Thin shells that bend far are
/// stretched by the first steps, and need more of both.
constexpr int patience(const NewtonOptions& options) { return std::max(10, options.max_iterations - 15); }
constexpr int most_indefinite =
    6; ///< tangents in a row: by then the iteration wanders between unstable states

/// Where what slides is given a firmness (see Slider), Newton's steps shrink by a constant part each, the
/// less the shorter the way of the increment. How much longer one is to be that follows `before`, which was
/// `taken` times as long as it had been (Aitken).
double longer(const Eigen::VectorXd& step, const Eigen::VectorXd& before, double taken) {
  constexpr double longest = 50;
  const Eigen::VectorXd change = step - before;
  const double longer = -taken * before.dot(change) / change.squaredNorm();
  return std::isfinite(longer) ? std::clamp(longer, 1.0, longest) : 1.0;
}
constexpr double slow = 0.5; ///< residual over that before, from which on steps are made longer

/// Error of a step in the norm of the tangent, over the step. Where another step follows, less saves no
/// iteration; the last one is to leave the digits that it would without an error. `residual`: relative.
double tolerance_of_step(double residual, double tolerance) {
  constexpr double inexact = 1e-3, left = 1e-2; // of the tolerance of the residual
  const bool may_be_last = residual * residual <= tolerance;
  return may_be_last ? std::clamp(left * tolerance / residual, SymmetricSolver::exact, inexact) : inexact;
}

} // namespace

bool is_settled(double correction, double admitted, double last_step, double last_residual) {
  const bool is_rounding =
      last_residual <= near && correction > linear * last_step && correction <= most_unresolved;
  return correction <= admitted || is_rounding;
}

Equilibrium::Equilibrium(const Model& model, int threads)
    : model_(model), assembler_(model, threads), tangent_(model, assembler_, stiffness_) {
  weight_ = Eigen::VectorXd::Ones(model.dofs.count());
  for (int n = 0; n < model.dofs.node_count(); ++n)
    for (int c = 3; c < DofMap::unknowns; ++c)
      if (const int e = model.dofs.equation(n, c); e != DofMap::absent) weight_[e] = 1 / model.length_scale;
  for (int s = 0; s < model.dofs.scalar_count(); ++s)
    weight_[model.dofs.scalar_equation(s)] = 1 / model.length_scale; // residuals are energies
  const auto squared = weight_.head(model.dofs.free_count()).array().square();
  const auto stiffest_of = [&](const State& drawn) { // as stiffness_ is of that state
    assembler_.tangent(drawn);
    const SparseSymmetric& K = assembler_.matrix();
    stiffness_.resize(K.size);
    for (int c = 0; c < K.size; ++c) {
      const auto diagonal = static_cast<std::size_t>(K.column_start[static_cast<std::size_t>(c)]);
      stiffness_[c] = std::abs(K.values[diagonal]);
    }
    return K.size > 0 ? (stiffness_.array() * squared).maxCoeff() : 0.0;
  };
  State drawn = model.initial_state();
  double stiffest = stiffest_of(drawn);
  // Positions are known to a rounding of the extent; the stiffest unknowns turn it into force.
  round_off_ = std::numeric_limits<double>::epsilon() * stiffest * model.extent *
               std::sqrt(static_cast<double>(stiffness_.size()));
  if (drawn.history) { // what flows, a viscosity's stiff spring too, does not tell how far forces move film
    drawn.scheme = materials::TimeScheme::relaxed();
    stiffest = stiffest_of(drawn);
  }
  stiffness_ = stiffness_.array().max(least_stiffness * stiffest / squared);
  film_stiffness_ = film_stiffness();
  energy_scale_ = (squared == 1).select(stiffness_.array(), 0).sum() * model.extent * model.extent;
  if (model.ports.any_sheet()) conduction_.emplace(model);
}

double Equilibrium::weighted_norm(const Eigen::VectorXd& force, Eigen::Index count) const {
  return force.head(count).cwiseProduct(weight_.head(count)).norm();
}

/// Phi at which no electrode has a surplus of charge. One correction is enough where charges are proportional
/// to voltages; the natural width of wrinkled film and sources at their limit take a little more.
bool Equilibrium::follow_charges(State& state, Pressure pressure) const {
  const auto follows = [&](std::size_t port) {
    return state.supply[port] != Supply::voltage &&
           !(pressure == Pressure::is_unknown && model_.ports[port].chamber);
  };
  bool any = false;
  for (std::size_t e = 0; e < state.supply.size(); ++e) any = any || follows(e);
  if (!any) return true;
  std::vector<double> last(state.supply.size(), std::numeric_limits<double>::infinity());
  for (int correction = 0; correction <= most_voltage_corrections; ++correction) {
    const Charges surplus = model_.surplus(state, false);
    bool balanced = true;
    for (std::size_t e = 0; e < state.supply.size(); ++e) {
      if (!follows(e)) continue;
      const double change = -surplus.charge[e] / surplus.capacitance[e];
      state.voltage[e] += change;
      if (!std::isfinite(state.voltage[e])) return false;
      const double rounding = std::abs(change) > stagnating * std::exchange(last[e], std::abs(change))
                                  ? charge_rounding_of_many
                                  : charge_tolerance;
      balanced = balanced && (std::abs(change) <= rounding * std::abs(state.voltage[e]) ||
                              std::abs(surplus.charge[e]) <= charge_rounding * std::abs(state.charge[e]));
    }
    if (balanced) return true;
  }
  return false;
}

void Equilibrium::balance(State& state, Balance& balance) {
  this->balance(state, balance, Pressure::follows);
}

void Equilibrium::balance(State& state, Balance& balance, Pressure pressure) {
  const Stopwatch watch(timings_.residual, model_);
  const bool follows = any_follows(state);
  if (follows && !follow_charges(state, pressure)) {
    balance = {
        .energy = NAN, .feasible = false, .force = Eigen::VectorXd::Constant(model_.dofs.count(), NAN)};
    return;
  }
  const Evaluation evaluation = assembler_.residual(state, balance.force);
  balance.energy = evaluation.energy;
  if (follows) balance.energy += model_.ports.supply_energy(state);
  balance.force -= state.dead_force;
  if (!state.motion_scheme.is_static()) {
    const InertialForce inertial(model_.inertia(), model_.dofs, state);
    balance.force += inertial.force();
    balance.energy += inertial.energy();
  }
  model_.dofs.gather(state, balance.force);
  if (!state.motion_scheme.is_static() && state.motion->held.size() > 0)
    balance.force.head(state.motion->held.size()).array() *= 1 - state.motion->held.array();
  balance.norm = weighted_norm(balance.force, model_.dofs.free_count());
  balance.scale = weighted_norm(state.dead_force, state.dead_force.size());
  for (const auto& block : assembler_.block_residuals())
    balance.scale = std::max(balance.scale, weighted_norm(block, block.size()));
  balance.feasible = evaluation.feasible && std::isfinite(balance.norm) && std::isfinite(balance.energy);
}

/// A film whose field carries its stress has no nodal forces to compare the residual with: there, what the
/// next step would change must be negligible, as foretold by the last one and the residual's decrease.
double Equilibrium::admitted_correction(const Balance& balance, double tolerance, double previous_norm,
                                        double step) const {
  const bool stagnates = balance.norm <= round_off_ && balance.norm > 0.3 * previous_norm;
  if (balance.norm <= tolerance * balance.scale || stagnates) return tolerance;
  const double least = negligible * tolerance;
  const bool foretold = std::isfinite(step) && step * balance.norm <= least * previous_norm;
  return foretold ? soft * least : 0;
}

double Equilibrium::step_size(const Eigen::VectorXd& step) const {
  return step.cwiseQuotient(weight_.head(step.size())).lpNorm<Eigen::Infinity>() / model_.extent;
}

bool Equilibrium::precondition(const State& state, bool close, const Eigen::VectorXd* right) {
  {
    const Stopwatch watch(timings_.tangent, model_);
    assembler_.tangent(state);
  }
  const Stopwatch watch(timings_.factor, model_);
  return tangent_.precondition(state, close, right);
}

bool Equilibrium::factor(const State& state, const PathBorder* path, const Eigen::VectorXd* added) {
  {
    const Stopwatch watch(timings_.tangent, model_);
    assembler_.tangent(state);
  }
  const Stopwatch watch(timings_.factor, model_);
  return tangent_.factor(state, path, added);
}

/// Goes along the Newton step, shorter while that leads nowhere; returns the fraction taken, 0 if none will
/// do. Where the forces are balanced already, those that are `balanced_to` this part tell nothing.
double Equilibrium::backtrack(State& state, Balance& current, const Eigen::VectorXd& step, int halvings,
                              double balanced_to) {
  const Eigen::Index free = model_.dofs.free_count();
  // With scalars an equilibrium is a saddle of the energy: only the residual tells.
  const bool definite = tangent_.unstable_modes() == 0 && model_.dofs.scalar_count() == 0;
  const double slope = current.force.head(free).dot(step);
  const double dead_work = state.dead_force.head(free).dot(step);
  const auto chamber = model_.ports.closed_chamber(state);
  Eigen::VectorXd response;
  if (chamber) response = tangent_.response(*chamber);
  double length = 1;
  for (int halving = 0; halving <= halvings; ++halving, length *= 0.5) {
    trial_ = state;
    model_.dofs.advance(trial_, step, length);
    if (const double way = free_way(model_, state, trial_); way < 1) {
      length *= way;
      trial_ = state;
      model_.dofs.advance(trial_, step, length);
    }
    if (chamber) {
      trial_.voltage[*chamber] += length * tangent_.voltage_step(*chamber);
      if (!model_.fill(trial_, response)) continue;
    }
    balance(trial_, there_, Pressure::is_unknown);
    if (!there_.feasible) continue;
    const double energy_change = there_.energy - current.energy - length * dead_work -
                                 model_.dofs.work_on_tied(state.dead_force, state, trial_);
    const bool descends = definite && energy_change <= sufficient_decrease * length * slope;
    const bool stays_balanced = there_.norm <= std::max(balanced_to * there_.scale, round_off_);
    if (!descends && !(there_.norm < current.norm) && !(balanced_to > 0 && stays_balanced)) continue;
    std::swap(state, trial_);
    std::swap(current, there_);
    return length;
  }
  return 0;
}

/// All of it a little larger.
State Equilibrium::widened(State state, double strain) const {
  for (std::size_t n = 0; n < model_.drawn.size(); ++n)
    state.displacement[n] += strain * (model_.drawn[n] + state.displacement[n]);
  return state;
}

/// Gives a closed chamber its volume, at the pressure that film and filling come to by their slopes; false
/// where it cannot have it.
bool Equilibrium::fill(State& state) {
  const auto chamber = model_.ports.closed_chamber(state);
  if (!chamber || model_.fill(state, Eigen::VectorXd::Zero(model_.dofs.free_count()))) return true;
  if ((is_slack(state) || !factor(state)) && !factor(widened(state, first_widening))) return false;
  const Eigen::VectorXd response = tangent_.response(*chamber);
  Charges surplus = model_.surplus(state, true);
  model_.dofs.gather(state, surplus.coupling[*chamber]);
  const double compliance =
      surplus.capacitance[*chamber] + surplus.coupling[*chamber].head(response.size()).dot(response);
  if (compliance > 0) state.voltage[*chamber] -= surplus.charge[*chamber] / compliance;
  return model_.fill(state, response);
}

NewtonResult Equilibrium::balance_forces(State& state, const NewtonOptions& options,
                                         const std::function<void(const Iteration&)>& log) {
  NewtonResult result = newton(state, options, log);
  if (result.outcome == Outcome::converged || !(options.wrinkles || has_friction(model_))) return result;
  const int iterations = result.iterations;
  result = descend(state, options, log);
  result.iterations += iterations;
  return result;
}

NewtonResult Equilibrium::newton(State& state, const NewtonOptions& options,
                                 const std::function<void(const Iteration&)>& log) {
  NewtonResult result;
  Balance current;
  solved_.reset();
  const auto end = [&](Outcome outcome) {
    result.outcome = outcome;
    if (outcome == Outcome::converged && !conduction_ && !model_.ports.closed_chamber(state))
      solved_ = std::move(current);
    return result;
  };
  const auto count = [&] {
    result.negative_pivots = tangent_.negative_pivots();
    result.unstable_modes = tangent_.unstable_modes();
  };
  const auto factor_and_count = [&](const State& at, bool close, const Eigen::VectorXd* right = nullptr) {
    const bool regular = precondition(at, close, right);
    if (regular) count();
    return regular;
  };
  Eigen::VectorXd step;
  model_.balance_fields(state);
  if (!fill(state)) return end(Outcome::infeasible);
  balance(state, current, Pressure::is_unknown);
  const double first_norm = current.norm;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double previous_norm = infinity;
  double stale_tangent = infinity; // residual at which the last tangent was taken
  double step_length = 0, taken = 1;
  Eigen::VectorXd before; // where something slides the last step as it was found, in lengths
  int indefinite = 0;
  for (result.iterations = 0;; ++result.iterations) {
    if (!current.feasible) return end(Outcome::infeasible);
    result.residual = current.scale > 0 ? current.norm / current.scale : 0;
    if (log) log({result.iterations, result.residual, step_length, result.negative_pivots});
    // An unstable mode of a state close by is not one of this state; a pump's filling makes close far.
    const bool tells =
        stale_tangent <= near && result.unstable_modes == 0 && !model_.ports.closed_chamber(state);
    const double last_step = step_length == 1 ? step_size(step) : infinity;
    const double admitted = admitted_correction(current, options.tolerance, previous_norm, last_step);
    right_ = -current.force.head(model_.dofs.free_count());
    bool is_at_hand = false; // the step, by the tangent that there is
    if (admitted > 0) {
      const double foretold = last_step * std::max(stale_tangent, current.norm / previous_norm);
      if (tells && cautious * foretold <= admitted) return end(Outcome::converged);
      if (!tells && !factor_and_count(state, false, &right_)) return end(Outcome::singular);
      const Stopwatch watch(timings_.solve, model_);
      tangent_.solve(right_, step, 0, SymmetricSolver::estimate);
      const double correction = step_size(step);
      if (is_settled(correction, admitted, last_step, stale_tangent)) return end(Outcome::converged);
      is_at_hand = !tells || correction <= linear * last_step;
    }
    if (result.iterations >= options.max_iterations ||
        (result.iterations >= patience(options) && current.norm > first_norm) ||
        indefinite >= most_indefinite)
      return end(Outcome::not_converged);
    const bool shrinks_slowly = step_length == 1 && current.norm > slow * previous_norm;
    previous_norm = current.norm;
    if (!is_at_hand || !tells) {
      stale_tangent = result.residual;
      ++timings_.iterations;
    }
    const auto find_step = [&](const State& at, bool close) {
      if (std::exchange(is_at_hand, false)) return true;
      if (!factor_and_count(at, close, &right_)) return false;
      const Stopwatch watch(timings_.solve, model_);
      tangent_.solve(right_, step, 0, tolerance_of_step(result.residual, options.tolerance));
      count();
      return true;
    };
    // A flat film without tension has no stiffness across itself until it is loaded, or that of a rounding:
    // that of the film a little wider, in tension, leads on. The step goes with 1/widening, its strain with
    // the square of that: the two are to be alike.
    const auto find_widened_step = [&] {
      if (!find_step(widened(state, first_widening), false)) return false;
      const double alike = std::cbrt(std::pow(step_size(step) * first_widening, 2));
      return find_step(widened(state, std::min(alike, most_widening)), false);
    };
    const bool stiffened =
        !find_step(state, tells && result.residual <= near) || step_size(step) > farthest_step;
    if (stiffened && !find_widened_step()) return end(Outcome::singular);
    if (stiffened) stale_tangent = infinity;
    if (has_friction(model_) && !model_.ports.closed_chamber(state)) {
      const Eigen::VectorXd found = step.cwiseQuotient(weight_.head(step.size()));
      taken = shrinks_slowly && !stiffened ? longer(found, before, taken) : 1;
      before = found;
      step *= taken;
    }
    indefinite = result.unstable_modes > 0 ? indefinite + 1 : 0;
    step_length =
        backtrack(state, current, step, stiffened || options.wrinkles ? 2 * most_halvings : most_halvings,
                  admitted > 0 ? options.tolerance : 0);
    if (step_length == 0) {
      const double most = current.norm <= round_off_ ? most_unresolved : rounded_step;
      const bool rounded = step_size(step) <= most;
      return end(rounded ? Outcome::converged : Outcome::not_converged);
    }
  }
}

} // namespace dielast::fem
