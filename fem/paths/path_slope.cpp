// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/path_slope.hpp"

#include "fem/model/inertia.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr double difference = 1e-3; ///< of the reach
constexpr double still = 1e-7;      ///< mean displacement over the extent that tells nothing of a path
constexpr double rounding = 1e-12;  ///< of potentials

/// What a closed chamber's filling adds to the energy at the pressure of the state, J. At a fixed pressure it
/// is linear in the filling, which hardly gives way: where the pressure follows, differences would tell of
/// nothing but the bulk modulus. As the energy is stationary in the pressure, its slope is the same.
double filling_energy(const Model& model, const State& state, std::size_t chamber) {
  return model.chamber_of(chamber)->energy(state.charge[chamber], state.voltage[chamber]);
}

/// The energy that forces and, with the opposite sign, changes of the loads derive from.
double potential(const Balance& balance, const State& state, const DofMap& dofs) {
  return balance.energy - state.dead_force.dot(position(state, dofs));
}

double norm_by(const Eigen::VectorXd& stiffness, const Eigen::VectorXd& u) {
  return std::sqrt(u.dot(stiffness.cwiseProduct(u)));
}

double distance(const DofMap& dofs, const Eigen::VectorXd& stiffness, const State& from, const State& to) {
  return norm_by(stiffness, dofs.increment(from, to));
}

} // namespace

PathSlope slope_at(Equilibrium& equilibrium, const LoadPath& path, const State& state, double s, double reach,
                   bool factored, const Balance* known) {
  const DofMap& dofs = equilibrium.model().dofs;
  PathSlope slope;
  Balance evaluated, there;
  State at = state;
  path.apply(at, s);
  if (!known) equilibrium.balance(at, evaluated);
  const Balance& here = known ? *known : evaluated;
  slope.potential = potential(here, at, dofs);
  const double ds = difference * reach;
  path.apply(at, s + ds);
  equilibrium.balance(at, there);
  double change = potential(there, at, dofs) - slope.potential;
  if (const auto chamber = equilibrium.model().closed_chamber(state)) {
    const auto at_fixed_pressure = [&](double load_factor) {
      State open = state;
      path.apply(open, load_factor);
      const double filling = filling_energy(equilibrium.model(), open, *chamber);
      open.supply[*chamber] = Supply::voltage;
      Balance balance;
      equilibrium.balance(open, balance);
      return potential(balance, open, dofs) + filling;
    };
    change = at_fixed_pressure(s + ds) - at_fixed_pressure(s);
  }
  slope.power = change / ds;
  if (factored)
    equilibrium.tangent().solve((here.force - there.force).head(dofs.free_count()) / ds, slope.displacement);
  return slope;
}

bool is_foreseen(const DofMap& dofs, const Eigen::VectorXd& stiffness, std::span<const PathPoint> points,
                 double parameter, const State& predicted, const State& trial) {
  constexpr double close = 0.1, faster = 3;
  if (points.size() < 2) return false;
  const auto size = [&](const State& from, const State& to) { return distance(dofs, stiffness, from, to); };
  const PathPoint &before = points[points.size() - 2], &here = points.back();
  const double longer = (parameter - here.parameter) / (here.parameter - before.parameter);
  const double step = size(here.state, trial);
  return size(predicted, trial) <= close * step && step <= faster * longer * size(before.state, here.state);
}

bool is_still(const Equilibrium& equilibrium, const Eigen::VectorXd& stiffness, const State& from,
              const State& to) {
  return distance(equilibrium.model().dofs, stiffness, from, to) <=
         still * std::sqrt(equilibrium.energy_scale());
}

bool is_along(const Equilibrium& equilibrium, const State& from, const Eigen::VectorXd& slope_from,
              const State& to, const Eigen::VectorXd& slope_to, const Steadiness& steadiness) {
  if (slope_from.size() == 0) return false;
  const auto norm = [&](const Eigen::VectorXd& a) { return norm_by(equilibrium.stiffness(), a); };
  const Eigen::VectorXd chord = equilibrium.model().dofs.increment(from, to);
  return norm(chord - (slope_from + slope_to) / 2) <=
         steadiness.steady * std::max(norm(slope_from), norm(slope_to));
}

bool is_joined(const Equilibrium& equilibrium, const State& from, const PathSlope& slope_from,
               const State& to, const PathSlope& slope_to, const Steadiness& steadiness) {
  const Eigen::VectorXd chord = equilibrium.model().dofs.increment(from, to);
  const auto product = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return a.dot(equilibrium.stiffness().cwiseProduct(b));
  };
  const auto norm = [&](const Eigen::VectorXd& a) { return norm_by(equilibrium.stiffness(), a); };
  const double least = still * std::sqrt(equilibrium.energy_scale());
  if (norm(chord) <= least) return true;
  const Eigen::VectorXd &v0 = slope_from.displacement, &v1 = slope_to.displacement;
  const bool singular_start = v0.size() == 0;
  const double n0 = singular_start ? 0 : norm(v0), n1 = norm(v1);
  if (is_along(equilibrium, from, v0, to, v1, steadiness)) return true;
  const double missing =
      std::abs(slope_to.potential - slope_from.potential - (slope_from.power + slope_to.power) / 2);
  const double round_off = rounding * (std::abs(slope_from.potential) + std::abs(slope_to.potential));
  const double energy = n1 > n0 ? steadiness.energy_of_faster : steadiness.energy;
  // not a number where loads cannot be
  if (!(missing <= energy * std::abs(slope_to.power - slope_from.power) + round_off)) return false;
  if (std::isinf(steadiness.chord)) return true;
  if (singular_start) return product(chord, v1) > 0; // of it only the energy is known
  const Eigen::VectorXd half = (v1 - v0) / 2;
  const double length = product(half, half);
  const double part = n1 > n0 && length > 0 ? std::clamp(product(chord - v0, half) / length, 0.0, 1.0) : 1.0;
  return norm(chord - v0 - part * half) <= steadiness.chord * std::max(n0, n1) + least;
}

} // namespace dielast::fem
