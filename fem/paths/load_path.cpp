// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/load_path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace dielast::fem {

Loads Loads::of(const State& state, const DofMap& dofs) {
  Loads loads{state.voltage, state.charge, state.source, state.dead_force,
              Eigen::VectorXd::Zero(dofs.held_count())};
  for (int n = 0; n < dofs.node_count(); ++n)
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(n, c); dofs.is_held(e))
        loads.held[e - dofs.free_count()] = state.displacement[static_cast<std::size_t>(n)][c];
  return loads;
}

Eigen::VectorXd Loads::values() const {
  Eigen::VectorXd all(std::ssize(voltage) + std::ssize(charge) + std::ssize(source) + dead_force.size() +
                      held.size());
  const auto of = [](const std::vector<double>& part) {
    return Eigen::Map<const Eigen::VectorXd>(part.data(), std::ssize(part));
  };
  all << of(voltage), of(charge), of(source), dead_force, held;
  return all;
}

void Loads::apply(State& state, const DofMap& dofs) const {
  for (std::size_t e = 0; e < voltage.size(); ++e) switch (state.supply[e]) {
    case Supply::voltage:
      state.voltage[e] = voltage[e];
      state.source[e] = source[e];
      break;
    case Supply::charge:
      state.charge[e] = charge[e];
      break;
    case Supply::circuit:
      state.source[e] = source[e];
      break;
    case Supply::leak:
      break;
    }
  state.dead_force = dead_force;
  for (int n = 0; n < dofs.node_count(); ++n)
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(n, c); dofs.is_held(e))
        state.displacement[static_cast<std::size_t>(n)][c] = held[e - dofs.free_count()];
  dofs.carry(state);
}

bool differ(const Loads& one, const Loads& other, std::span<const Loads> recent) {
  constexpr double rounding = 1e-10;
  Eigen::VectorXd largest = one.values().cwiseAbs().cwiseMax(other.values().cwiseAbs());
  for (const Loads& loads : recent) largest = largest.cwiseMax(loads.values().cwiseAbs());
  return ((other.values() - one.values()).array().abs() > rounding * largest.array()).any();
}

namespace {

constexpr double left_side = 1e-13; ///< before a break, in load factors
constexpr double beside = 1e-9; ///< a break, in load factors: loads that only turn change little until there

/// What stays does so to the last bit: accelerations are second differences of what moves.
template<class Values>
Values mix(const Values& from, const Values& to, double s) {
  Values between = from;
  for (decltype(from.size()) i = 0; i < from.size(); ++i)
    if (from[i] != to[i]) between[i] = (1 - s) * from[i] + s * to[i];
  return between;
}

/// The electrode whose voltage changes most; none where it changes its sign or nothing changes.
std::optional<std::size_t> leading_electrode(const Loads& from, const Loads& to, const Ports* ports) {
  std::optional<std::size_t> leading;
  double largest = 0;
  for (std::size_t e = 0; e < from.voltage.size(); ++e)
    if (const double change = std::abs(to.voltage[e] - from.voltage[e]);
        change > largest && !(ports && (*ports)[e].chamber)) {
      largest = change;
      leading = e;
    }
  if (leading && from.voltage[*leading] * to.voltage[*leading] < 0) return std::nullopt;
  return leading;
}

} // namespace

void LoadPath::before(State& state, double s) const {
  if (apply_before)
    apply_before(state, s);
  else
    apply(state, s - left_side);
}

bool LoadPath::jumps(const DofMap& dofs, const State& state, double s) const {
  const auto behind = [&](double place) {
    State there = state;
    apply(there, place);
    return Loads::of(there, dofs).values();
  };
  const auto ahead = [&](double place) {
    State there = state;
    before(there, place);
    return Loads::of(there, dofs).values();
  };
  const Eigen::VectorXd left = ahead(s), right = behind(s);
  const Eigen::VectorXd turn =
      (left - ahead(s - beside)).cwiseAbs() + (behind(s + beside) - right).cwiseAbs();
  return ((right - left).cwiseAbs().array() > turn.array()).any();
}

LoadPath linear_path(const DofMap& dofs, Loads from, Loads to, const Ports* ports) {
  LoadPath path;
  if (const auto e = leading_electrode(from, to, ports))
    path.parameter = [a = from.voltage[*e], b = to.voltage[*e]](double s) {
      const double phi = (1 - s) * a + s * b;
      return phi * phi;
    };
  path.apply = [&dofs, from = std::move(from), to = std::move(to)](State& state, double s) {
    Loads{mix(from.voltage, to.voltage, s), mix(from.charge, to.charge, s), mix(from.source, to.source, s),
          mix(from.dead_force, to.dead_force, s), mix(from.held, to.held, s)}
        .apply(state, dofs);
  };
  return path;
}

} // namespace dielast::fem
