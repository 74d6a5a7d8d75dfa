// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/jump.hpp"

#include "fem/model/contact_block.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace dielast::fem {

namespace {

constexpr double first_damping = 1e-2; ///< c/dt, over the stiffness as drawn
constexpr double least_damping = 1e-16, most_damping = 1e8;
constexpr double quicker = 3, slower = 9; ///< factors of the time step after success and failure
constexpr double settled = 1e-2;          ///< size of a step from which on Newton's method may finish
constexpr double round_off = 1e-12;       ///< of an energy, over what it is the difference of
constexpr double returned = 0.5; ///< part of the energy released that would be taken back: the start again

double farthest_node(const State& state) {
  double farthest = 0;
  for (const Eigen::Vector3d& u : state.displacement) farthest = std::max(farthest, u.norm());
  return farthest;
}

/// One way down at fixed loads.
class Descent {
 public:
  Descent(Equilibrium& equilibrium, State& state, const JumpOptions& options)
      : equilibrium_(equilibrium), model_(equilibrium.model()), state_(state), options_(options) {
    take(state);
    start_ = energy_;
  }

  bool push(const Eigen::VectorXd& direction);
  JumpResult fall();

 private:
  /// Energy under the control less the work of the dead forces, J.
  double potential(const State& state, const Balance& at) const;
  double dead_work(const State& state) const;
  void take(State state);
  bool step(double damping);
  std::optional<NewtonResult> land();

  Equilibrium& equilibrium_;
  const Model& model_;
  State& state_;
  const JumpOptions& options_;
  Balance current_, trial_;
  double energy_ = 0, start_ = 0;
  double step_size_ = 0; ///< of the last step
};

double Descent::potential(const State& state, const Balance& at) const {
  return at.energy - dead_work(state);
}

double Descent::dead_work(const State& state) const {
  return state.dead_force.dot(position(state, model_.dofs));
}

void Descent::take(State state) {
  equilibrium_.balance(state, current_);
  energy_ = potential(state, current_);
  state_ = std::move(state);
}

/// Along `direction`, or against it where the energy is lower there; false if neither is feasible.
bool Descent::push(const Eigen::VectorXd& direction) {
  const double length = options_.push / equilibrium_.step_size(direction);
  std::optional<State> lower;
  double lowest = 0;
  const double rounded = round_off * (std::abs(current_.energy) + std::abs(dead_work(state_)));
  for (const double side : {length, -length}) {
    State there = state_;
    model_.dofs.advance(there, direction, side);
    if (free_way(model_, state_, there) < 1) continue;
    equilibrium_.balance(there, trial_);
    if (!trial_.feasible) continue;
    const double energy = potential(there, trial_);
    if (lower && energy >= lowest - rounded) continue;
    lowest = energy;
    lower = std::move(there);
  }
  if (lower) take(std::move(*lower));
  return lower.has_value();
}

bool Descent::step(double damping) {
  const Eigen::VectorXd added = damping * equilibrium_.stiffness();
  if (!equilibrium_.factor(state_, nullptr, &added) || equilibrium_.tangent().unstable_modes() > 0)
    return false;
  Eigen::VectorXd du;
  equilibrium_.tangent().solve(-current_.force.head(added.size()), du);
  State there = state_;
  model_.dofs.advance(there, du, 1);
  if (free_way(model_, state_, there) < 1 || is_turned_over(model_.corners, model_.drawn, state_, there))
    return false; // energies are lower beyond stretches of 0, too
  equilibrium_.balance(there, trial_);
  if (!trial_.feasible || potential(there, trial_) >= energy_) return false;
  energy_ = potential(there, trial_);
  std::swap(current_, trial_);
  step_size_ = equilibrium_.step_size(du);
  state_ = std::move(there);
  return true;
}

/// The stable equilibrium close by and below, if there is one.
std::optional<NewtonResult> Descent::land() {
  if (step_size_ > settled || !equilibrium_.factor(state_) || equilibrium_.tangent().unstable_modes() > 0)
    return std::nullopt;
  State there = state_;
  const NewtonResult newton = equilibrium_.solve(there, options_.newton);
  if (newton.outcome != Outcome::converged || newton.unstable_modes > 0 ||
      is_turned_over(model_.corners, model_.drawn, state_, there))
    return std::nullopt;
  equilibrium_.balance(there, trial_);
  if (potential(there, trial_) - energy_ > returned * (start_ - energy_)) return std::nullopt;
  take(std::move(there));
  return newton;
}

JumpResult Descent::fall() {
  JumpResult result;
  double damping = first_damping;
  for (; result.steps < options_.most_steps && damping < most_damping; ++result.steps) {
    if (options_.goes_on && !options_.goes_on()) {
      result.end = JumpEnd::interrupted;
      return result;
    }
    if (!step(damping)) {
      damping *= slower;
      continue;
    }
    damping = std::max(least_damping, damping / quicker);
    result.energy_released = start_ - energy_;
    if (farthest_node(state_) > options_.farthest * model_.extent) {
      result.end = JumpEnd::ran_away;
      return result;
    }
    if (const auto newton = land()) {
      result.end = JumpEnd::landed;
      result.newton = *newton;
      result.energy_released = start_ - energy_;
      return result;
    }
  }
  result.end = JumpEnd::stuck;
  return result;
}

} // namespace

JumpResult jump(Equilibrium& equilibrium, State& state, const Eigen::VectorXd& direction,
                const JumpOptions& options) {
  if (equilibrium.model().dofs.scalar_count() > 0) return {.end = JumpEnd::stuck}; // no way down on a saddle
  Descent descent(equilibrium, state, options);
  if (!descent.push(direction)) return {.end = JumpEnd::stuck};
  return descent.fall();
}

} // namespace dielast::fem
