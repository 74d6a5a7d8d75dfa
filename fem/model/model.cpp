// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/model.hpp"

#include <algorithm>
#include <stdexcept>

namespace dielast::fem {

void Model::place_histories() {
  int first = 0;
  for (const auto& block : blocks) {
    block->place_history(first);
    first += block->history_size();
  }
  circuit_history = static_cast<std::size_t>(first);
  SheetMap map(sheets);
  for (const auto& block : blocks) block->place_sheets(map);
  sheet_points = map.points();
  if (!sheets.empty()) weigh_sheets();
}

/// Scales of charges, and leakage spread like the capacitance, as drawn.
void Model::weigh_sheets() {
  const Eigen::VectorXd capacitances = sheet_matrices(initial_state()).capacitance;
  for (const Sheet& sheet : sheets) {
    double whole = 0;
    bool connected = false;
    for (std::size_t a = 0; a < sheet_points.size(); ++a)
      if (sheet_points[a].electrode == sheet.electrode) {
        whole += capacitances[static_cast<Eigen::Index>(a)];
        connected = connected || sheet_points[a].at_terminal;
      }
    const auto electrode = static_cast<std::size_t>(sheet.electrode);
    if (!connected)
      throw std::invalid_argument("the terminal of electrode \"" + electrodes[electrode] +
                                  "\" is no corner of its film");
    const Circuit* circuit = circuit_of(electrode);
    for (std::size_t a = 0; a < sheet_points.size(); ++a)
      if (SheetPoint& point = sheet_points[a]; point.electrode == sheet.electrode) {
        const double capacitance = capacitances[static_cast<Eigen::Index>(a)];
        point.charge_scale = capacitance * sheet.voltage_scale;
        point.leakage = circuit ? circuit->leakage * capacitance / whole : 0;
      }
  }
}

State Model::initial_state() const {
  const auto nodes = static_cast<std::size_t>(dofs.node_count());
  State state;
  state.displacement.assign(nodes, Eigen::Vector3d::Zero());
  state.rotation.assign(nodes, Eigen::Quaterniond::Identity());
  state.angle.assign(nodes, Eigen::Vector3d::Zero());
  state.scalar.assign(static_cast<std::size_t>(dofs.scalar_count()), 0.0);
  state.voltage.assign(port_count(), 0.0);
  state.dead_force = Eigen::VectorXd::Zero(dofs.count());
  state.supply.assign(port_count(), Supply::voltage);
  state.charge.assign(port_count(), 0.0);
  state.source.assign(port_count(), 0.0);
  const std::size_t internal = sheet_history() + sheet_points.size();
  if (internal > 0) {
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
  Charges charges{std::vector<double>(port_count()), std::vector<double>(port_count()), {}};
  if (with_coupling) charges.coupling.assign(port_count(), Eigen::VectorXd::Zero(dofs.count()));
  for (const auto& block : blocks) block->add_charges(state, with_coupling ? &dofs : nullptr, charges);
  return charges;
}

const Circuit* Model::circuit_of(std::size_t electrode) const {
  const auto found = std::ranges::find(circuits, static_cast<int>(electrode), &Circuit::electrode);
  return found == circuits.end() ? nullptr : &*found;
}

Circuit::Drawn Model::taken(const State& state, std::size_t electrode) const {
  const Circuit& circuit = *circuit_of(electrode);
  const double voltage = state.voltage[electrode];
  return state.supply[electrode] == Supply::leak
             ? circuit.leaked(voltage, state.scheme)
             : circuit.drawn(state.source[electrode], voltage, state.scheme);
}

double Model::leak(const State& state, std::size_t electrode) const {
  const Circuit* circuit = circuit_of(electrode);
  if (!circuit) return 0;
  double current = circuit->leakage * state.voltage[electrode];
  for (Eigen::Index a = 0; a < state.sheet_drop.size(); ++a)
    if (const SheetPoint& point = sheet_points[static_cast<std::size_t>(a)];
        static_cast<std::size_t>(point.electrode) == electrode)
      current -= point.leakage * state.sheet_drop[a];
  return current;
}

double Model::given_charge(const State& state, std::size_t port) const {
  if (const Chamber* chamber = chamber_of(port))
    return chamber->filled(state.charge[port], state.voltage[port]);
  if (!flows(state.supply[port])) return state.charge[port];
  const Circuit* circuit = circuit_of(port);
  const std::size_t place = circuit_history + static_cast<std::size_t>(circuit - circuits.data());
  const History& past = *state.history;
  const double before = past.before.empty() ? 0 : past.before[place];
  double given = circuit->charge_scale * (state.scheme.h1 * past.now[place] + state.scheme.h2 * before) /
                 state.scheme.a0;
  for (Eigen::Index a = 0; a < state.sheet_drop.size(); ++a) // less leaks where the voltage is lower
    if (const SheetPoint& point = sheet_points[static_cast<std::size_t>(a)];
        static_cast<std::size_t>(point.electrode) == port)
      given += state.scheme.dt / state.scheme.a0 * point.leakage * state.sheet_drop[a];
  return given;
}

double Model::capacitance(const State& state, std::size_t electrode) const {
  double capacitance = charges(state, false).capacitance[electrode];
  for (const auto& block : blocks) capacitance -= block->screened_capacitance(state, electrode);
  return capacitance;
}

void Model::balance_fields(State& state) const {
  for (const auto& block : blocks) block->balance_field(state);
}

std::optional<std::size_t> Model::closed_chamber(const State& state) const {
  for (std::size_t port = electrodes.size(); port < port_count(); ++port)
    if (state.supply[port] == Supply::charge) return port;
  return std::nullopt;
}

bool Model::fill(State& state, const Eigen::VectorXd& direction) const {
  constexpr double exact = 1e-14, good = 1e-11; // of the volume
  constexpr int most_steps = 30;
  const std::size_t port = *closed_chamber(state);
  const double wanted = given_charge(state, port);
  const double scale = std::max(std::abs(wanted), least_volume());
  const auto gap = [&](const State& at) { return wanted - charges(at, false).charge[port]; };
  double missing = gap(state);
  if (std::abs(missing) <= good * scale) return true;
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
    if (std::abs(missing) <= exact * scale || (!closer && std::abs(missing) <= good * scale)) return true;
  }
  return std::abs(missing) <= good * scale;
}

Charges Model::surplus(const State& state, bool with_coupling) const {
  Charges surplus = charges(state, with_coupling);
  for (std::size_t e = 0; e < port_count(); ++e) {
    if (state.supply[e] == Supply::voltage) continue;
    const double given = given_charge(state, e);
    surplus.charge[e] -= given;
    if (const Chamber* chamber = chamber_of(e))
      surplus.capacitance[e] += chamber->compliance(std::max(given, least_volume()), state.voltage[e]);
    if (!flows(state.supply[e])) continue;
    const Circuit::Drawn more = taken(state, e);
    surplus.charge[e] += more.charge;
    surplus.capacitance[e] += more.capacitance;
  }
  return surplus;
}

double Model::supply_energy(const State& state) const {
  double energy = 0;
  for (std::size_t e = 0; e < port_count(); ++e) {
    if (state.supply[e] == Supply::voltage) continue;
    const Chamber* chamber = chamber_of(e);
    energy += chamber ? chamber->energy(state.charge[e], state.voltage[e])
                      : given_charge(state, e) * state.voltage[e];
    if (flows(state.supply[e])) energy -= taken(state, e).energy;
  }
  return energy;
}

SheetMatrices Model::sheet_matrices(const State& state) const {
  SheetMatrices matrices{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(sheet_points.size())), {}};
  for (const auto& block : blocks) block->add_sheets(state, matrices);
  for (auto& entry : matrices.conductance)
    entry = {entry.row(), entry.col(),
             entry.value() / sheet_points[static_cast<std::size_t>(entry.row())].resistance};
  return matrices;
}

Eigen::VectorXd Model::past_sheet_charges(const State& state) const {
  const History& past = *state.history;
  Eigen::VectorXd charges(static_cast<Eigen::Index>(sheet_points.size()));
  for (std::size_t a = 0; a < sheet_points.size(); ++a) {
    const double before = past.before.empty() ? 0 : past.before[sheet_history() + a];
    charges[static_cast<Eigen::Index>(a)] =
        sheet_points[a].charge_scale *
        (state.scheme.h1 * past.now[sheet_history() + a] + state.scheme.h2 * before) / state.scheme.a0;
  }
  return charges;
}

EnergyParts Model::energies(const State& state) const {
  EnergyParts parts;
  for (const auto& block : blocks) block->add_energies(state, parts);
  const Charges held = charges(state, false);
  for (std::size_t e = 0; e < electrodes.size(); ++e) parts.electric += held.charge[e] * state.voltage[e] / 2;
  if (state.sheet_drop.size() > 0) {
    const Eigen::VectorXd& drop = state.sheet_drop;
    const SheetMatrices matrices = sheet_matrices(state);
    for (Eigen::Index a = 0; a < drop.size(); ++a) {
      const SheetPoint& point = sheet_points[static_cast<std::size_t>(a)];
      const double voltage = state.voltage[static_cast<std::size_t>(point.electrode)] - drop[a];
      parts.electric -= matrices.capacitance[a] * voltage * drop[a] / 2;
    }
  }
  if (state.motion) {
    const Eigen::VectorXd& velocity = state.motion->velocity;
    parts.kinetic = velocity.dot(inertia.mass * velocity) / 2;
  }
  return parts;
}

void Model::charge_circuits(State& state) const {
  if (circuits.empty()) return;
  History history{state.history->now, {}, {}};
  const Charges held = charges(state, false);
  for (std::size_t c = 0; c < circuits.size(); ++c)
    history.now[circuit_history + c] =
        held.charge[static_cast<std::size_t>(circuits[c].electrode)] / circuits[c].charge_scale;
  state.history = std::make_shared<const History>(std::move(history));
}

std::shared_ptr<const History> Model::advanced_history(const State& state) const {
  if (!state.history || state.scheme.is_frozen()) return state.history;
  const History& last = *state.history;
  History next{last.now, {}, {}};
  for (const auto& block : blocks) block->advance_history(state, next.now);
  if (!circuits.empty()) {
    const Charges held = charges(state, false);
    for (std::size_t c = 0; c < circuits.size(); ++c)
      next.now[circuit_history + c] =
          held.charge[static_cast<std::size_t>(circuits[c].electrode)] / circuits[c].charge_scale;
  }
  if (!sheets.empty()) {
    const Eigen::VectorXd capacitance = sheet_matrices(state).capacitance;
    for (std::size_t a = 0; a < sheet_points.size(); ++a) {
      const SheetPoint& point = sheet_points[a];
      const auto i = static_cast<Eigen::Index>(a);
      const double drop = state.sheet_drop.size() > 0 ? state.sheet_drop[i] : 0;
      const double voltage = state.voltage[static_cast<std::size_t>(point.electrode)] - drop;
      next.now[sheet_history() + a] = capacitance[i] * voltage / point.charge_scale;
    }
  }
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
    state.motion = std::make_shared<const Motion>(InertialForce(inertia, dofs, state).arrived());
    state.motion_scheme = {};
  }
  return state;
}

} // namespace dielast::fem
