// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/rest.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/equilibrium/lowest_mode.hpp"
#include "fem/linear/modal.hpp"
#include "fem/linear/rigid_motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dielast::fem {
namespace {

/// Change that counts as none, over what is of order one: internal variables, voltages, the extent.
constexpr double still = 1e-4;

/// Change of internal variables that is rounding, or what Newton's method leaves.
constexpr double resolved = 1e-9;
/// Displacement still to come that counts as none, over the largest one so far, and over the extent where the
/// device is nearly back where it was drawn.
constexpr double still_to_come = 1e-3, still_to_come_at_all = 1e-6;
/// Change of the lowest eigenvalue of the tangent (twice that of a frequency) that counts as none, and one of
/// rounding, over the stiffness as drawn.
constexpr double as_stiff = 2e-3, no_stiffness = 1e-10;

/// By how much the internal variables change until they rest at this shape.
double flow_left(const Model& model, const State& state) {
  double largest = 0;
  const std::vector<double>& now = state.history->now;
  const std::vector<double> end = model.advanced_history(fem::relaxed(state))->now;
  for (std::size_t i = 0; i < now.size(); ++i)
    largest = std::max(largest, std::abs(end[i] - now[i]) / std::max(1.0, std::abs(now[i])));
  return largest;
}

/// Largest change of the stiffness in any direction x, |x'(K_there - K_here)x| / |x' K_here x|, by the power
/// method; infinite where there is none to compare with.
double stiffness_change(Equilibrium& equilibrium, const State& here, const State& there) {
  constexpr double none = std::numeric_limits<double>::infinity();
  constexpr int powers = 12;
  Assembler& assembler = equilibrium.assembler();
  assembler.tangent(there);
  SparseSymmetric change = assembler.matrix();
  assembler.tangent(here);
  const SparseSymmetric& K = assembler.matrix();
  if (K.rows != change.rows) return none; // another contact
  for (std::size_t i = 0; i < K.values.size(); ++i) change.values[i] -= K.values[i];
  if (!equilibrium.factor(here)) return none;
  const Eigen::VectorXd& D = equilibrium.stiffness();
  Eigen::VectorXd x = random_vectors(D.size(), 1).cwiseQuotient(D.cwiseSqrt()), y;
  double largest = 0;
  for (int power = 0; power < powers; ++power) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(x.size());
    change.for_each_entry([&](std::size_t k, int column, int row) {
      force[row] += change.values[k] * x[column];
      if (row != column) force[column] += change.values[k] * x[row];
    });
    equilibrium.tangent().solve(force, y);
    const double before = std::sqrt(x.dot(D.cwiseProduct(x)));
    largest = std::sqrt(y.dot(D.cwiseProduct(y))) / before;
    if (!(largest > 0)) return 0;
    x = y / (largest * before);
  }
  return largest;
}

/// What flows is little of what is of order one, but much of a stiff branch's stress may be beside a soft
/// film, and small stresses make thin ones stiffer or softer in bending: so that is judged by how far the
/// stresses that dashpots carry would move the device if they were let go, and by its lowest stiffness there.
bool matters(Equilibrium& equilibrium, const State& state) {
  const Model& model = equilibrium.model();
  if (model.dofs.free_count() == 0) return false;
  State at = fem::relaxed(state);
  const auto here = lowest_mode(equilibrium, at);
  Balance balance;
  equilibrium.balance(at, balance);
  if (!here || !equilibrium.factor(at)) return true;
  Eigen::VectorXd step;
  equilibrium.tangent().solve(-balance.force.head(model.dofs.free_count()), step);
  double moved = 0;
  for (const Eigen::Vector3d& u : state.displacement) moved = std::max(moved, u.norm());
  if (equilibrium.step_size(step) > std::max(still_to_come * moved / model.extent, still_to_come_at_all))
    return true;
  const State from = at;
  model.dofs.advance(at, step, 1);
  if (stiffness_change(equilibrium, from, at) > as_stiff) return true; // in any mode, of any part
  const auto there = lowest_mode(equilibrium, at);
  return !there || std::abs(there->eigenvalue - here->eigenvalue) >
                       as_stiff * std::max(std::abs(here->eigenvalue), no_stiffness);
}

bool flows(Equilibrium& equilibrium, const State& state) {
  if (!state.history) return false;
  const double left = flow_left(equilibrium.model(), state);
  return left > still || (left > resolved && matters(equilibrium, state));
}

bool conducts(Equilibrium& equilibrium, const State& state) {
  if (state.sheet_drop.size() == 0) return false;
  State rest = fem::relaxed(state);
  equilibrium.conduct(rest);
  double largest = 0;
  const Ports& ports = equilibrium.model().ports;
  for (std::size_t p = 0; p < ports.size(); ++p)
    if (ports[p].is_electrode()) largest = std::max(largest, std::abs(state.voltage[p]));
  largest = std::max(largest, state.sheet_drop.lpNorm<Eigen::Infinity>());
  return (rest.sheet_drop - state.sheet_drop).lpNorm<Eigen::Infinity>() > still * largest;
}

/// What a port's charge does that is not at its end.
std::string charges(const Model& model, const State& state) {
  for (std::size_t e = 0; e < model.ports.size(); ++e) {
    const Port& port = model.ports[e];
    if (!port.circuit) continue;
    const Circuit& circuit = *port.circuit;
    const double voltage = state.voltage[e];
    if (state.supply[e] == Supply::leak &&
        std::abs(model.charges(state, false).charge[e]) > still * circuit.charge_scale)
      return "electrode \"" + port.name + "\" is isolated and leaks";
    // What leaks under a sheet is known as drawn only; where nothing does, the source's voltage is the end.
    if (is_isolated(state.supply[e]) || (port.sheet && circuit.leakage > 0)) continue;
    const double end = circuit.steady_voltage(state.source[e]);
    if (std::abs(end - voltage) > still * std::max(std::abs(end), std::abs(voltage)))
      return "charge flows through the circuit of electrode \"" + port.name + "\"";
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
  Eigen::VectorXd momentum = equilibrium.model().inertia().mass * state.motion->velocity;
  equilibrium.model().dofs.gather(state, momentum);
  momentum.conservativeResize(free);
  if (!equilibrium.factor(at)) { // what nothing holds drifts on, if it does, for as long as this takes
    if (momentum.isZero(0)) return false;
    at.motion_scheme = mass_times(least_shift * free_mass(equilibrium, at).fastest);
    if (!equilibrium.factor(at)) return true;
  }
  Eigen::VectorXd step, swing;
  equilibrium.tangent().solve(-balance.force.head(free), step);
  equilibrium.tangent().solve(momentum, swing);
  const double kinetic = momentum.dot(velocity);                                               // twice
  const double seconds = kinetic > 0 ? std::sqrt(std::abs(momentum.dot(swing)) / kinetic) : 0; // 1/omega
  return equilibrium.step_size(step) + seconds * equilibrium.step_size(velocity) > still;
}

std::string unrest(Equilibrium& equilibrium, const State& state) {
  if (flows(equilibrium, state)) return "dashpots flow";
  if (conducts(equilibrium, state)) return "current flows along an electrode";
  if (std::string found = charges(equilibrium.model(), state); !found.empty()) return found;
  if (moves_on(equilibrium, state)) return "the device moves";
  return "";
}

double skew_stiffness(Equilibrium& equilibrium, const State& state) {
  const DofMap& dofs = equilibrium.model().dofs;
  const Eigen::Index free = dofs.free_count();
  State at = fem::relaxed(state);
  Balance balance;
  equilibrium.balance(at, balance);
  // What is inside balances it: dead moments, and where a turn is held its reaction, too.
  Eigen::VectorXd moment = at.dead_force;
  moment.tail(moment.size() - free) += balance.force.tail(moment.size() - free);
  const SparseSymmetric& K = equilibrium.assembler().matrix();
  bool assembled = false;
  double largest = 0;
  for (int node = 0; node < dofs.node_count(); ++node)
    for (int c = 0; c < 3; ++c) {
      const int across = dofs.equation(node, 3 + c), one = dofs.equation(node, 3 + (c + 1) % 3),
                other = dofs.equation(node, 3 + (c + 2) % 3);
      const auto turns = [free](int e) { return e != DofMap::absent && e < free; };
      if (across == DofMap::absent || !turns(one) || !turns(other) || moment[across] == 0) continue;
      if (!std::exchange(assembled, true)) equilibrium.assembler().tangent(at);
      const auto stiffness = [&K](int e) { return K.values[static_cast<std::size_t>(K.place(e, e))]; };
      const double both = std::sqrt(std::abs(stiffness(one) * stiffness(other)));
      largest = std::max(largest, std::abs(moment[across]) / 2 / both);
    }
  return largest;
}

State relaxed(State state) {
  if (state.history) state.scheme = materials::TimeScheme::relaxed();
  for (Supply& supply : state.supply)
    if (flows(supply)) supply = is_isolated(supply) ? Supply::charge : Supply::voltage; // the source keeps it
  return state;
}

} // namespace dielast::fem
