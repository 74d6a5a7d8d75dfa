// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/model.hpp"

#include <algorithm>

namespace dielast::fem {

const Inertia& Model::inertia() const {
  if (!known_inertia) known_inertia = Inertia::of(blocks, dofs);
  return *known_inertia;
}

void Model::place_histories() {
  int first = 0;
  for (const auto& block : blocks) {
    block->place_history(first);
    first += block->history_size();
  }
  ports.place_history(static_cast<std::size_t>(first), blocks);
  if (ports.any_sheet()) ports.weigh_sheets(sheet_matrices(initial_state()).capacitance);
}

State Model::initial_state() const {
  const auto nodes = static_cast<std::size_t>(dofs.node_count());
  State state;
  state.displacement.assign(nodes, Eigen::Vector3d::Zero());
  state.rotation.assign(nodes, Eigen::Quaterniond::Identity());
  state.angle.assign(nodes, Eigen::Vector3d::Zero());
  state.scalar.assign(static_cast<std::size_t>(dofs.scalar_count()), 0.0);
  state.voltage.assign(ports.size(), 0.0);
  state.dead_force = Eigen::VectorXd::Zero(dofs.count());
  state.supply.assign(ports.size(), Supply::voltage);
  state.charge.assign(ports.size(), 0.0);
  state.source.assign(ports.size(), 0.0);
  if (const std::size_t internal = ports.history_end(); internal > 0) {
    History history{std::vector<double>(internal), {}, {}};
    for (const auto& block : blocks) block->start_history(history.now);
    state.history = std::make_shared<const History>(std::move(history));
    state.scheme = materials::TimeScheme::relaxed();
    return settled(std::move(state)); // relaxed as drawn
  }
  return state;
}

Samples Model::sample(const State& state) const {
  Samples samples;
  for (const auto& block : blocks) block->sample(state, samples);
  return samples;
}

Charges Model::charges(const State& state, bool with_coupling) const {
  Charges charges{std::vector<double>(ports.size()), std::vector<double>(ports.size()), {}};
  if (with_coupling) charges.coupling.assign(ports.size(), Eigen::VectorXd::Zero(dofs.count()));
  for (const auto& block : blocks) block->add_charges(state, with_coupling ? &dofs : nullptr, charges);
  return charges;
}

double Model::capacitance(const State& state, std::size_t electrode) const {
  double capacitance = charges(state, false).capacitance[electrode];
  for (const auto& block : blocks) capacitance -= block->screened_capacitance(state, electrode);
  return capacitance;
}

void Model::balance_fields(State& state) const {
  for (const auto& block : blocks) block->balance_field(state);
}

bool Model::fill(State& state, const Eigen::VectorXd& direction) const {
  constexpr double exact = 1e-14, good = 1e-11; // of the volume
  constexpr double rounding = 1e-8;             // of the least volume: positions are known to a rounding
  constexpr int most_steps = 30;
  const std::size_t port = *ports.closed_chamber(state);
  const double wanted = ports.given_charge(state, port);
  const double admitted = std::max(good * std::abs(wanted), rounding * least_volume());
  const auto gap = [&](const State& at) { return wanted - charges(at, false).charge[port]; };
  double missing = gap(state);
  if (std::abs(missing) <= admitted) return true;
  if (direction.isZero(0)) return false;
  // secants, from the slope here
  Eigen::VectorXd coupling = charges(state, true).coupling[port];
  dofs.gather(state, coupling);
  double slope = coupling.head(direction.size()).dot(direction);
  for (int i = 0; i < most_steps; ++i) {
    const double step = missing / slope;
    if (!std::isfinite(step)) return false;
    State there = state;
    dofs.advance(there, direction, step);
    const double left = gap(there);
    slope = (missing - left) / step;
    const bool closer = std::abs(left) < std::abs(missing);
    if (closer) {
      state = std::move(there);
      missing = left;
    }
    if (std::abs(missing) <= exact * std::abs(wanted) || (!closer && std::abs(missing) <= admitted))
      return true;
  }
  return std::abs(missing) <= admitted;
}

Charges Model::surplus(const State& state, bool with_coupling) const {
  Charges surplus = charges(state, with_coupling);
  ports.take_off_given(state, least_volume(), surplus);
  return surplus;
}

SheetMatrices Model::sheet_matrices(const State& state) const {
  const std::vector<SheetPoint>& points = ports.sheet_points();
  SheetMatrices matrices{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(points.size())), {}};
  for (const auto& block : blocks) block->add_sheets(state, matrices);
  for (auto& entry : matrices.conductance)
    entry = {entry.row(), entry.col(),
             entry.value() / points[static_cast<std::size_t>(entry.row())].resistance};
  return matrices;
}

EnergyParts Model::energies(const State& state) const {
  EnergyParts parts;
  for (const auto& block : blocks) block->add_energies(state, parts);
  const Charges held = charges(state, false);
  for (std::size_t p = 0; p < ports.size(); ++p)
    if (ports[p].is_electrode()) parts.electric += held.charge[p] * state.voltage[p] / 2;
  if (state.sheet_drop.size() > 0) {
    const SheetMatrices matrices = sheet_matrices(state);
    for (Eigen::Index a = 0; a < state.sheet_drop.size(); ++a) {
      const double voltage = ports.sheet_voltage(state, static_cast<std::size_t>(a));
      parts.electric -= matrices.capacitance[a] * voltage * state.sheet_drop[a] / 2;
    }
  }
  if (state.motion) {
    const Eigen::VectorXd& velocity = state.motion->velocity;
    parts.kinetic = velocity.dot(inertia().mass * velocity) / 2;
  }
  return parts;
}

void Model::charge_circuits(State& state) const {
  if (!ports.any_circuit()) return;
  History history{state.history->now, {}, {}};
  ports.remember(charges(state, false).charge, history.now);
  state.history = std::make_shared<const History>(std::move(history));
}

std::shared_ptr<const History> Model::advanced_history(const State& state) const {
  if (!state.history || state.scheme.is_frozen()) return state.history;
  const History& last = *state.history;
  History next{last.now, {}, {}};
  for (const auto& block : blocks) block->advance_history(state, next.now);
  if (ports.any_circuit()) ports.remember(charges(state, false).charge, next.now);
  if (ports.any_sheet()) ports.remember_sheets(state, sheet_matrices(state).capacitance, next.now);
  if (!state.scheme.is_relaxed()) {
    next.before = last.now;
    next.step = state.scheme.dt;
    if (last.step > 0) {
      next.older = last.before;
      next.step_before = last.step;
    }
  }
  return std::make_shared<const History>(std::move(next));
}

State Model::settled(State state) const {
  state.history = advanced_history(state);
  state.scheme = materials::TimeScheme::frozen();
  if (!state.motion_scheme.is_static()) {
    state.motion = std::make_shared<const Motion>(InertialForce(inertia(), dofs, state).arrived());
    state.motion_scheme = {};
  }
  return state;
}

} // namespace dielast::fem
