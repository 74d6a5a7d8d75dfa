// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/energy_point.hpp"

#include "fem/model/contact_block.hpp"

#include <cmath>
#include <memory>

namespace dielast::fem {

EnergyPoint energy_point(Equilibrium& equilibrium, const State& state, double length, const Holding& held) {
  const Model& model = equilibrium.model();
  const DofMap& dofs = model.dofs;
  const Ports& ports = model.ports;
  const auto count = static_cast<Eigen::Index>(ports.size());
  EnergyPoint point{.length = length, .time = state.time, .moves = state.motion != nullptr};
  if (state.motion) {
    const Eigen::VectorXd& velocity = state.motion->velocity;
    point.power[EnergyPoint::dampers] = velocity.dot(model.inertia().resistance(velocity));
  }
  // The reactions are external, too; dead forces on tied nodes do work of their own.
  const auto supported = Eigen::seqN(dofs.free_count(), dofs.held_count());
  point.mechanical.force = state.dead_force;
  point.mechanical.force(supported) += reactions(model, state, held)(supported);
  point.mechanical.coordinate = position(state, dofs);
  // What is given is known to the last digit; the rest follows.
  std::vector<double> charges = model.charges(state, false).charge;
  for (std::size_t p = 0; p < ports.size(); ++p)
    if (state.supply[p] == Supply::charge) charges[p] = ports.given_charge(state, p);
  // What the pressure does is mechanical work: it moves the chamber's walls.
  point.electrical = {Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  point.mechanical.force.conservativeResizeLike(Eigen::VectorXd::Zero(dofs.count() + count));
  point.mechanical.coordinate.conservativeResizeLike(Eigen::VectorXd::Zero(dofs.count() + count));
  for (Eigen::Index p = 0; p < count; ++p) {
    const auto port = static_cast<std::size_t>(p);
    const bool is_electrode = ports[port].is_electrode();
    Conjugates& part = is_electrode ? point.electrical : point.mechanical;
    const Eigen::Index place = is_electrode ? p : dofs.count() + p;
    part.force[place] = state.voltage[port];
    part.coordinate[place] = charges[port];
  }
  point.resistance = {Eigen::VectorXd::Zero(count), point.electrical.coordinate};
  point.given_through = Eigen::VectorXd::Zero(count);
  for (std::size_t p = 0; p < ports.size(); ++p) {
    if (!ports[p].circuit) continue;
    const Circuit& circuit = *ports[p].circuit;
    // Without time what leaks for ever is left out, and what it takes of the source's voltage.
    const bool leads = state.supply[p] == Supply::voltage;
    const double source = leads ? circuit.steady_voltage(state.source[p]) : state.source[p];
    const double drop = is_isolated(state.supply[p]) ? 0 : source - state.voltage[p];
    const auto e = static_cast<Eigen::Index>(p);
    point.resistance.force[e] = drop;
    const bool given = state.supply[p] == Supply::charge; // its source pays for what leaks
    if (given) {
      const double leaks = ports.leak(state, p);
      point.given_through[e] = circuit.resistance;
      point.resistance.force[e] = 2 * circuit.resistance * leaks;
      point.power[EnergyPoint::leak_through_resistance] += circuit.resistance * leaks * leaks;
    }
    if (!(flows(state.supply[p]) || given) || ports[p].sheet) continue;
    point.power[EnergyPoint::leak] += circuit.leakage * state.voltage[p] * state.voltage[p];
    if (!given)
      point.power[EnergyPoint::leak_through_resistance] += circuit.leakage * state.voltage[p] * drop;
  }
  if (ports.any_sheet()) {
    point.at_source = Eigen::VectorXd::Zero(count);
    for (std::size_t p = 0; p < ports.size(); ++p)
      if (ports[p].sheet && state.supply[p] == Supply::voltage)
        point.at_source[static_cast<Eigen::Index>(p)] = 1;
    point.sheet = {state.sheet_drop, ports.sheet_charges(state)};
    if (state.sheet_drop.size() == 0) point.sheet.force.setZero(point.sheet.coordinate.size());
    for (std::size_t a = 0; a < ports.sheet_points().size(); ++a) {
      const SheetPoint& at = ports.sheet_points()[a];
      const double drop = point.sheet.force[static_cast<Eigen::Index>(a)];
      const double there = ports.sheet_voltage(state, a), current = at.leakage * there;
      point.power[EnergyPoint::leak] += current * there;
      point.power[EnergyPoint::leak_through_sheet] += current * drop;
      if (state.supply[static_cast<std::size_t>(at.electrode)] != Supply::charge)
        point.power[EnergyPoint::leak_through_resistance] +=
            current * point.resistance.force[static_cast<Eigen::Index>(at.electrode)];
    }
  }
  point.energy = model.energies(state);
  point.friction = friction_heat(model, state);
  point.power[EnergyPoint::dashpots] = point.energy.dissipation;
  return point;
}

double flow_heat(Equilibrium& equilibrium, const State& from, double energy_from, const State& to,
                 double energy_to) {
  if (!from.history || !to.history || from.history->now == to.history->now) return 0;
  const Eigen::Map<const Eigen::VectorXd> first(from.history->now.data(), std::ssize(from.history->now)),
      last(to.history->now.data(), std::ssize(to.history->now));
  Eigen::VectorXd unused;
  const auto energy = [&](State shape, double part) { // of the way between the dashpots' states
    auto history = std::make_shared<History>(*from.history);
    Eigen::VectorXd::Map(history->now.data(), first.size()) = first + part * (last - first);
    shape.history = std::move(history);
    shape.scheme = materials::TimeScheme::frozen();
    return equilibrium.internal_force(shape, unused).energy;
  };
  const double at_first = energy_from - energy(from, 1), at_last = energy(to, 0) - energy_to;
  const double between = (at_first + at_last) / 2;
  if (at_first >= 0 && at_last >= 0) return between;
  const auto power = [&](const State& shape, double part) { // exact for polynomials of degree 4
    const auto falls = [&](double by) { return energy(shape, part - by) - energy(shape, part + by); };
    return (8 * falls(0.5) - falls(1)) / 6;
  };
  const double at_both = (power(from, 0) + power(to, 1)) / 2;
  return std::isfinite(at_both) ? at_both : between; // an increment may be too long to be gone back
}

} // namespace dielast::fem
