// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/path_slope.hpp"

#include "fem/model/inertia.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr double difference = 1e-3; ///< of the reach
constexpr double accuracy = 2e-4;   ///< of a slope's equations: the difference leaves a thousandth
constexpr double still = 1e-7;      ///< mean displacement over the extent that tells nothing of a path
constexpr double rounding = 1e-12;  ///< of potentials
constexpr double linear = 0.01;     ///< part of the works that a film may miss which answers loads linearly

/// What a closed chamber's filling adds to the energy at the pressure of the state, J. At a fixed pressure it
/// is linear in the filling, which hardly gives way: where the pressure follows, differences would tell of
/// nothing but the bulk modulus. As the energy is stationary in the pressure, its slope is the same.
double filling_energy(const Model& model, const State& state, std::size_t chamber) {
  return model.ports[chamber].chamber->energy(state.charge[chamber], state.voltage[chamber]);
}

struct WorkOfLoads {
  double potential =
      0;           ///< P(u, s) of the state: the energy under the control less the work of dead forces, J
  double work = 0; ///< what P grows by while the loads go from s0 to s1 and the shape stays, J
};

/// The energy that forces and, with the opposite sign, changes of the loads derive from.
double potential(const Balance& balance, const State& state, const DofMap& dofs) {
  return balance.energy - state.dead_force.dot(position(state, dofs));
}

/// At one end of the path from s0 to s1. What is held and moves does the work of the state's reactions.
WorkOfLoads work_of_loads(Equilibrium& equilibrium, const LoadPath& path, const PathEnd& end, double s0,
                          double s1) {
  const DofMap& dofs = equilibrium.model().dofs;
  State here = end.state, there = end.state;
  path.apply(here, end.s);
  path.apply(there, end.s == s0 ? s1 : s0);
  Balance evaluated;
  if (!end.balance) equilibrium.balance(here, evaluated);
  const Balance& balance = end.balance ? *end.balance : evaluated;
  const double own = potential(balance, here, dofs);
  const Eigen::VectorXd moved = Loads::of(there, dofs).held - Loads::of(here, dofs).held;
  const double of_reactions = balance.force.segment(dofs.free_count(), moved.size()).dot(moved);
  there.displacement = here.displacement;
  there.rotation = here.rotation;
  there.angle = here.angle;
  double change = -own;
  if (const auto chamber = equilibrium.model().ports.closed_chamber(here)) {
    const auto at_fixed_pressure = [&](State open) {
      open.voltage[*chamber] = here.voltage[*chamber];
      const double filling = filling_energy(equilibrium.model(), open, *chamber);
      open.supply[*chamber] = Supply::voltage;
      equilibrium.balance(open, evaluated);
      return potential(evaluated, open, dofs) + filling;
    };
    change = at_fixed_pressure(there) - at_fixed_pressure(here);
  } else {
    equilibrium.balance(there, evaluated);
    change += potential(evaluated, there, dofs);
  }
  return {own, (change + of_reactions) * (end.s == s0 ? 1 : -1)};
}

/// How fast the forces on free equations change with the loads there, in the norm of the stiffness.
double rate_of_loads(Equilibrium& equilibrium, const LoadPath& path, State at, double s, double ds) {
  Balance here, there;
  path.apply(at, s);
  equilibrium.balance(at, here);
  path.apply(at, s + ds);
  equilibrium.balance(at, there);
  const Eigen::VectorXd change = (there.force - here.force).head(equilibrium.stiffness().size()) / ds;
  return std::sqrt(change.dot(change.cwiseQuotient(equilibrium.stiffness())));
}

double norm_by(const Eigen::VectorXd& stiffness, const Eigen::VectorXd& u) {
  return std::sqrt(u.dot(stiffness.cwiseProduct(u)));
}

double distance(const DofMap& dofs, const Eigen::VectorXd& stiffness, const State& from, const State& to) {
  return norm_by(stiffness, dofs.increment(from, to));
}

} // namespace

Eigen::VectorXd slope_at(Equilibrium& equilibrium, const LoadPath& path, const State& state, double s,
                         double reach, const Balance* known) {
  Balance evaluated, there;
  State at = state;
  if (!known) {
    path.apply(at, s);
    equilibrium.balance(at, evaluated);
  }
  const Balance& here = known ? *known : evaluated;
  const double ds = difference * reach;
  path.apply(at, s + ds);
  equilibrium.balance(at, there);
  Eigen::VectorXd slope;
  equilibrium.tangent().solve((here.force - there.force).head(equilibrium.model().dofs.free_count()) / ds,
                              slope, 0, accuracy);
  return slope;
}

bool is_foreseen(const DofMap& dofs, const Eigen::VectorXd& stiffness, std::span<const PathPoint> points,
                 double parameter, const State& predicted, const State& trial, double faster, bool swings) {
  constexpr double close = 0.1, close_in_swing = 0.3;
  if (points.size() < 2) return false;
  const auto size = [&](const State& from, const State& to) { return distance(dofs, stiffness, from, to); };
  double before = 0; // as far as the path would go now
  for (std::size_t i = swings ? 1 : points.size() - 1; i < points.size(); ++i) {
    const double longer =
        (parameter - points.back().parameter) / (points[i].parameter - points[i - 1].parameter);
    before = std::max(before, longer * size(points[i - 1].state, points[i].state));
  }
  const double step = size(points.back().state, trial);
  return size(predicted, trial) <= (swings ? close_in_swing * std::max(step, before) : close * step) &&
         step <= faster * before;
}

bool is_still(const Equilibrium& equilibrium, const Eigen::VectorXd& stiffness, const State& from,
              const State& to) {
  return distance(equilibrium.model().dofs, stiffness, from, to) <=
         still * std::sqrt(equilibrium.energy_scale());
}

bool is_beside_corner(const Model& model, const State& predicted, const State& trial) {
  constexpr double beside = 1e-3;
  double farthest = 0;
  for (std::size_t n = 0; n < trial.displacement.size(); ++n)
    farthest = std::max(farthest, (trial.displacement[n] - predicted.displacement[n]).norm());
  return farthest <= beside * model.extent;
}

bool is_joined(Equilibrium& equilibrium, const LoadPath& path, const PathEnd& from, const PathEnd& to,
               const Steadiness& steadiness) {
  const Eigen::VectorXd chord = equilibrium.model().dofs.increment(from.state, to.state);
  Eigen::VectorXd stiffness = equilibrium.stiffness();
  const auto product = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return a.dot(stiffness.cwiseProduct(b));
  };
  const auto norm = [&](const Eigen::VectorXd& a) { return norm_by(stiffness, a); };
  const double least = still * std::sqrt(equilibrium.energy_scale());
  if (norm(chord) <= least) return true;
  const bool singular_start = from.slope.size() == 0;
  const double length = to.s - from.s;
  const Eigen::VectorXd v0 = length * from.slope, v1 = length * to.slope;
  double n0 = singular_start ? 0 : norm(v0), n1 = norm(v1);
  const auto slows_down = [&] { // where that is not of loads that go slower themselves
    if (!(n1 < steadiness.slowest * n0)) return false;
    const double ds = difference * length;
    return n1 * rate_of_loads(equilibrium, path, from.state, from.s, ds) <
           steadiness.slowest * n0 * rate_of_loads(equilibrium, path, to.state, to.s, -ds);
  };
  if (!steadiness.beside_film && slows_down()) return false;
  if (!singular_start && norm(chord - (v0 + v1) / 2) <= steadiness.steady * std::max(n0, n1)) return true;
  const WorkOfLoads work0 = work_of_loads(equilibrium, path, from, from.s, to.s),
                    work1 = work_of_loads(equilibrium, path, to, from.s, to.s);
  const double missing = std::abs(work1.potential - work0.potential - (work0.work + work1.work) / 2);
  // What moves rigidly stores and does nothing but rounding.
  const double round_off = rounding * (std::abs(work0.potential) + std::abs(work1.potential)) +
                           equilibrium.round_off() * equilibrium.model().extent;
  const double energy = n1 > n0 ? steadiness.energy_of_faster : steadiness.energy;
  // not a number where loads cannot be
  if (!(missing <= energy * std::abs(work1.work - work0.work) + round_off)) return false;
  if (steadiness.beside_film) {
    const std::vector<char> moved = equilibrium.moved_by_film_alone();
    for (std::size_t e = 0; e < moved.size(); ++e)
      if (moved[e]) stiffness[static_cast<Eigen::Index>(e)] = 0;
    if (norm(chord) <= least) return true;
    n0 = singular_start ? 0 : norm(v0);
    n1 = norm(v1);
    if (slows_down()) return false;
  }
  if (singular_start) return product(chord, v1) > 0; // of it only the energy is known
  if (missing <= linear * std::abs(work1.work - work0.work) && norm(chord) <= std::max(n0, n1)) {
    // Loads that do not go straight on take the path to other points of the plane of both slopes.
    const auto without = [&](Eigen::VectorXd a, const Eigen::VectorXd& b) {
      const double square = product(b, b);
      if (square > 0) a -= product(a, b) / square * b;
      return a;
    };
    const Eigen::VectorXd off = without(without(chord, v1), without(v0, v1));
    if (norm(off) <= steadiness.chord * norm(chord)) return true;
  }
  const Eigen::VectorXd half = (v1 - v0) / 2;
  const double square = product(half, half);
  const double part = n1 > n0 && square > 0 ? std::clamp(product(chord - v0, half) / square, 0.0, 1.0) : 1.0;
  return norm(chord - v0 - part * half) <= steadiness.chord * std::max(n0, n1) + least;
}

bool is_wrinkled(const Model& model, const State& state) {
  return std::ranges::any_of(model.sample(state).film, [](const MembraneSample& sample) {
    return sample.tension != materials::Tension::taut;
  });
}

} // namespace dielast::fem
