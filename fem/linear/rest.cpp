// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/rest.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {
namespace {

/// Change that counts as none, over what is of order one: internal variables, voltages, the extent.
constexpr double still = 1e-4;

bool flows(const Model& model, const State& state) {
  if (!state.history) return false;
  State rest = state;
  rest.scheme = materials::TimeScheme::relaxed();
  const std::vector<double>& now = state.history->now;
  const std::vector<double> end = model.advanced_history(rest)->now;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (std::abs(end[i] - now[i]) > still * std::max(1.0, std::abs(now[i]))) return true;
  return false;
}

bool conducts(Equilibrium& equilibrium, const State& state) {
  if (state.sheet_drop.size() == 0) return false;
  State rest = fem::relaxed(state);
  equilibrium.conduct(rest);
  double largest = 0;
  for (std::size_t e = 0; e < equilibrium.model().electrodes.size(); ++e)
    largest = std::max(largest, std::abs(state.voltage[e]));
  largest = std::max(largest, state.sheet_drop.lpNorm<Eigen::Infinity>());
  return (rest.sheet_drop - state.sheet_drop).lpNorm<Eigen::Infinity>() > still * largest;
}

/// What a port's charge does that is not at its end.
std::string charges(const Model& model, const State& state) {
  for (const Circuit& circuit : model.circuits) {
    const auto e = static_cast<std::size_t>(circuit.electrode);
    const double voltage = state.voltage[e];
    if (state.supply[e] == Supply::leak &&
        std::abs(model.charges(state, false).charge[e]) > still * circuit.charge_scale)
      return "electrode \"" + model.electrodes[e] + "\" is isolated and leaks";
    const bool spreads = std::ranges::count(model.sheets, circuit.electrode, &Sheet::electrode) > 0;
    if (state.supply[e] != Supply::circuit || spreads) continue;
    const double end = circuit.steady_voltage(state.source[e]);
    if (std::abs(end - voltage) > still * std::max(std::abs(end), std::abs(voltage)))
      return "charge flows through the circuit of electrode \"" + model.electrodes[e] + "\"";
  }
  return "";
}

} // namespace

// To where its forces balance, and beyond as far as its kinetic energy carries it there.
bool moves_on(Equilibrium& equilibrium, const State& state) {
  if (!state.motion) return false;
  const Eigen::Index free = equilibrium.model().dofs.free_count();
  State at = state;
  Balance balance;
  equilibrium.balance(at, balance);
  const Eigen::VectorXd velocity = state.motion->velocity.head(free);
  Eigen::VectorXd momentum = equilibrium.model().inertia.mass * state.motion->velocity;
  equilibrium.model().dofs.gather(state, momentum);
  momentum.conservativeResize(free);
  if (!equilibrium.factor(at)) return !momentum.isZero(0);
  Eigen::VectorXd step, swing;
  equilibrium.tangent().solve(-balance.force.head(free), step);
  equilibrium.tangent().solve(momentum, swing);
  const double kinetic = momentum.dot(velocity);                                               // twice
  const double seconds = kinetic > 0 ? std::sqrt(std::abs(momentum.dot(swing)) / kinetic) : 0; // 1/omega
  return equilibrium.step_size(step) + seconds * equilibrium.step_size(velocity) > still;
}

std::string unrest(Equilibrium& equilibrium, const State& state) {
  if (flows(equilibrium.model(), state)) return "dashpots flow";
  if (conducts(equilibrium, state)) return "current flows along an electrode";
  if (std::string found = charges(equilibrium.model(), state); !found.empty()) return found;
  if (moves_on(equilibrium, state)) return "the device moves";
  return "";
}

State relaxed(State state) {
  if (state.history) state.scheme = materials::TimeScheme::relaxed();
  for (Supply& supply : state.supply)
    if (flows(supply)) supply = is_isolated(supply) ? Supply::charge : Supply::voltage; // the source keeps it
  return state;
}

} // namespace dielast::fem
