// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/held_masses.hpp"

#include "fem/equilibrium/moving_bodies.hpp"
#include "fem/model/inertia.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::fem {

namespace {

/// The inertia that holds a mass, over the stiffness: how little it gives way as other things move.
constexpr double stiffer = 1e8;

/// Of a time step, over which what is held is looked at.
constexpr double parts_of_a_step = 8;

/// Of the free equations, those of tied nodes moved to their masters, kg and kg m^2. What turns a mass on an
/// arm and leaves it where it is, by moving the node, has none.
Eigen::VectorXd masses(const Model& model, const State& state) {
  constexpr double round_off = 1e-9;
  const DofMap& dofs = model.dofs;
  const Eigen::SparseMatrix<double> jacobian = dofs.jacobian(state);
  const Eigen::SparseMatrix<double> reduced = jacobian.transpose() * model.inertia().mass * jacobian;
  const Eigen::VectorXd diagonal = reduced.diagonal();
  Eigen::VectorXd masses = diagonal;
  for (const Tie& tie : dofs.ties())
    for (const int turn : dofs.turns(tie.master)) {
      if (!dofs.is_free(turn) || !(masses[turn] > 0)) continue;
      double about_centre = diagonal[turn];
      for (int c = 0; c < 3; ++c)
        if (const int e = dofs.equation(tie.master, c); dofs.is_free(e) && diagonal[e] > 0)
          about_centre -= std::pow(reduced.coeff(e, turn), 2) / diagonal[e];
      if (about_centre <= round_off * diagonal[turn]) masses[turn] = 0;
    }
  return masses;
}

} // namespace

Eigen::VectorXd stiffness_without_mass(const Equilibrium& equilibrium, const State& state) {
  const Model& model = equilibrium.model();
  const Eigen::VectorXd mass = masses(model, state);
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(mass.size());
  for (int n = 0; n < model.dofs.node_count(); ++n)
    for (int c = 0; c < 3; ++c)
      if (const int e = model.dofs.equation(n, c); e >= 0 && e < mass.size() && mass[e] == 0)
        stiffness[e] = equilibrium.stiffness()[e];
  return stiffness.isZero(0) ? Eigen::VectorXd() : stiffness;
}

State with_masses_held(const Equilibrium& equilibrium, State state) {
  const Model& model = equilibrium.model();
  const Eigen::VectorXd mass = masses(model, state);
  double square = std::numeric_limits<double>::infinity(); // of the time step
  for (Eigen::Index e = 0; e < mass.size(); ++e)
    if (mass[e] > 0) square = std::min(square, mass[e] / (stiffer * equilibrium.stiffness()[e]));
  if (std::isinf(square) || !state.motion) return state;
  const double dt = std::sqrt(square);
  Motion motion = *state.motion;
  motion.position = position(state, model.dofs) - dt * motion.velocity;
  motion.acceleration.setZero();
  motion.unbalanced.setZero();
  motion.held = (mass.array() > 0).cast<double>();
  state.motion = std::make_shared<const Motion>(std::move(motion));
  state.motion_scheme = GeneralisedAlpha::backward_euler(dt);
  return state;
}

State with_masses_let_go(const Model& model, State state, const State& before) {
  Motion motion = *before.motion;
  motion.position = position(state, model.dofs);
  state.motion = std::make_shared<const Motion>(std::move(motion));
  state.motion_scheme = {};
  return state;
}

LoadPath with_masses_held(const Equilibrium& equilibrium, LoadPath path, const State& state) {
  const State held = with_masses_held(equilibrium, state);
  path.apply = [apply = std::move(path.apply), motion = held.motion, scheme = held.motion_scheme](State& at,
                                                                                                  double s) {
    apply(at, s);
    at.motion = motion;
    at.motion_scheme = scheme;
  };
  return path;
}

bool follow(Equilibrium& equilibrium, const State& before, State& state) {
  constexpr int most_corrections = 30;
  constexpr double accurate = 1e-10; // of the scalars, and of their change
  const DofMap& dofs = equilibrium.model().dofs;
  const Eigen::Index scalars = dofs.scalar_count();
  if (!equilibrium.follow(state)) return false;
  if (scalars == 0) return true;
  // What volumes lack here, and what the masses need, is not the jump's: of supports that jump, nor of
  // rounding, which pressures that move masses at once would make much of.
  State start = before;
  start.displacement = state.displacement;
  start.rotation = state.rotation;
  start.angle = state.angle;
  start.scheme = state.scheme;
  start.supply.assign(start.supply.size(), Supply::voltage);
  equilibrium.model().balance_fields(start);
  Balance first, now;
  equilibrium.balance(start, first);
  if (!first.feasible || !equilibrium.factor(with_masses_held(equilibrium, state))) return false;
  Eigen::VectorXd step;
  double largest = 0;
  for (int correction = 0; correction < most_corrections; ++correction) {
    equilibrium.balance(state, now);
    if (!now.feasible) return false;
    equilibrium.tangent().solve((first.force - now.force).head(dofs.free_count()), step);
    step.head(step.size() - scalars).setZero();
    if (!step.allFinite()) return false;
    dofs.advance(state, step, 1);
    if (!equilibrium.follow(state)) return false;
    const double change = step.lpNorm<Eigen::Infinity>();
    largest = std::max(largest, change);
    const double size =
        position(state, dofs).segment(step.size() - scalars, scalars).lpNorm<Eigen::Infinity>();
    if (change <= accurate * (largest + size)) return true;
  }
  return false;
}

std::shared_ptr<const Motion> motion_setting_out(const Model& model, const State& state, const LoadPath& path,
                                                 double s, double ds, double duration) {
  const DofMap& dofs = model.dofs;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(dofs.count());
  Motion motion = state.motion ? *state.motion : Motion{position(state, dofs), rest, rest, rest, rest};
  motion.acceleration = motion.acceleration_now = motion.unbalanced = rest;
  motion.step = 0;
  State there = state;
  const auto held_at = [&](double at) {
    path.apply(there, at);
    return Eigen::ArrayXd(Loads::of(there, dofs).held.array());
  };
  const auto held = Eigen::seqN(dofs.free_count(), dofs.held_count());
  const double tau = ds * duration / 4; // a parabola through three moments
  const Eigen::ArrayXd p0 = held_at(s), p1 = held_at(s + ds / 4), p2 = held_at(s + ds / 2);
  const Eigen::ArrayXd speed = (4 * p1 - 3 * p0 - p2) / (2 * tau);
  const Eigen::ArrayXd acceleration = (p0 - 2 * p1 + p2) / (tau * tau);
  const Eigen::ArrayXd jerk = speed - motion.velocity(held).array();
  motion.acceleration(held) = (jerk.abs() <= acceleration.abs() * tau).select(acceleration, 0);
  carry_accelerations(dofs, state, motion.velocity, motion.acceleration);
  return std::make_shared<const Motion>(std::move(motion));
}

std::shared_ptr<const Motion> motion_behind_jump(Equilibrium& equilibrium, const State& state) {
  const Model& model = equilibrium.model();
  Motion motion = *state.motion;
  Eigen::VectorXd dead = state.dead_force;
  model.dofs.gather(state, dead);
  equilibrium.internal_force(state, motion.unbalanced);
  motion.unbalanced -= dead;
  motion.acceleration_now = motion.acceleration;
  accelerate_bodies(model, state, motion);
  motion.unbalanced.setZero();
  return std::make_shared<const Motion>(std::move(motion));
}

std::shared_ptr<const Motion> motion_now(const Model& model, const State& state, const LoadPath& path,
                                         double s, double ds, double duration) {
  const DofMap& dofs = model.dofs;
  Motion motion = *state.motion;
  if (dofs.held_count() > 0) {
    // A cubic through four moments, not as close together as positions are rounded: behind a break ahead of
    // it.
    constexpr double closest = 1e-7; // in load factors
    double part = std::max(ds / parts_of_a_step, closest);
    const auto breaks_within = [&](double from, double to) {
      const auto next = std::ranges::upper_bound(path.breaks, from);
      return next != path.breaks.end() && *next < to;
    };
    const double back = s - 3 * part, ahead = s + 3 * part;
    if (back < 0 || breaks_within(back, s - ds / 2))
      part = ahead > 1 || breaks_within(s - ds / 2, ahead) ? ds / parts_of_a_step : -part;
    State there = state;
    const auto beside = [&](int parts) {
      path.apply(there, s - part * parts);
      return Loads::of(there, dofs).held;
    };
    const double tau = part * duration;
    const Eigen::VectorXd p0 = Loads::of(state, dofs).held, p1 = beside(1), p2 = beside(2), p3 = beside(3);
    motion.acceleration_now.segment(dofs.free_count(), dofs.held_count()) =
        (4 * (p2 - p0) - 5 * (p1 - p0) - (p3 - p0)) / (tau * tau); // of what stays none
  }
  accelerate_bodies(model, state, motion);
  return std::make_shared<const Motion>(std::move(motion));
}

double work_of_impulses(const Model& model, const State& before, const State& after) {
  constexpr double sudden = 2; // times what accelerations of both ends do in the step
  if (!after.motion || !(after.motion->step > 0)) return 0;
  const DofMap& dofs = model.dofs;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(dofs.count());
  const Motion at_rest{rest, rest, rest, rest, rest};
  const Motion &from = before.motion ? *before.motion : at_rest, &to = *after.motion;
  const auto held = Eigen::seqN(dofs.free_count(), dofs.held_count());
  Eigen::VectorXd change = to.velocity - from.velocity;
  const Eigen::ArrayXd smooth =
      to.step * (from.acceleration_now(held).array().abs() + to.acceleration_now(held).array().abs());
  const Eigen::ArrayXd rounding =
      1e-9 * (from.velocity(held).array().abs() + to.velocity(held).array().abs());
  if ((change(held).array().abs() <= sudden * smooth + rounding).all()) return 0;
  Eigen::VectorXd impulse = model.inertia().mass * change;
  Eigen::VectorXd struck = Eigen::VectorXd::Zero(change.size()); // what is free has all of it in one step
  struck.head(dofs.free_count()) = to.acceleration_now.head(dofs.free_count());
  struck = model.inertia().mass * struck;
  dofs.gather(after, impulse);
  dofs.gather(after, struck);
  return impulse(held).dot(from.velocity(held) + to.velocity(held)) / 2 -
         to.step * struck(held).dot(to.velocity(held)) / 2;
}

GeneralisedAlpha first_step_of_motion(double dt) {
  GeneralisedAlpha scheme = GeneralisedAlpha::backward_euler(dt);
  scheme.start = 1 / (2 * scheme.beta) - 1;
  return scheme;
}

} // namespace dielast::fem
