#include "fem/model.hpp"

#include <algorithm>

namespace dielast::fem {

void Model::place_histories() {
  int first = 0;
  for (const auto& block : blocks) {
    block->place_history(first);
    first += block->history_size();
  }
  circuit_history = static_cast<std::size_t>(first);
}

State Model::initial_state() const {
  const auto nodes = static_cast<std::size_t>(dofs.node_count());
  State state;
  state.displacement.assign(nodes, Eigen::Vector3d::Zero());
  state.rotation.assign(nodes, Eigen::Quaterniond::Identity());
  state.voltage.assign(port_count(), 0.0);
  state.dead_force = Eigen::VectorXd::Zero(dofs.count());
  state.supply.assign(port_count(), Supply::voltage);
  state.charge.assign(port_count(), 0.0);
  state.source.assign(port_count(), 0.0);
  const std::size_t internal = circuit_history + circuits.size();
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

double Model::given_charge(const State& state, std::size_t port) const {
  if (state.supply[port] != Supply::circuit) return state.charge[port];
  const Circuit* circuit = circuit_of(port);
  const std::size_t place = circuit_history + static_cast<std::size_t>(circuit - circuits.data());
  const History& past = *state.history;
  const double before = past.before.empty() ? 0 : past.before[place];
  return circuit->charge_scale * (state.scheme.h1 * past.now[place] + state.scheme.h2 * before) /
         state.scheme.a0;
}

Charges Model::surplus(const State& state, bool with_coupling) const {
  Charges surplus = charges(state, with_coupling);
  for (std::size_t e = 0; e < port_count(); ++e) {
    if (state.supply[e] == Supply::voltage) continue;
    surplus.charge[e] -= given_charge(state, e);
    if (state.supply[e] != Supply::circuit) continue;
    const Circuit::Drawn drawn = circuit_of(e)->drawn(state.source[e], state.voltage[e], state.scheme);
    surplus.charge[e] += drawn.charge;
    surplus.capacitance[e] += drawn.capacitance;
  }
  return surplus;
}

double Model::supply_energy(const State& state) const {
  double energy = 0;
  for (std::size_t e = 0; e < port_count(); ++e) {
    if (state.supply[e] == Supply::voltage) continue;
    energy += given_charge(state, e) * state.voltage[e];
    if (state.supply[e] == Supply::circuit)
      energy -= circuit_of(e)->drawn(state.source[e], state.voltage[e], state.scheme).energy;
  }
  return energy;
}

EnergyParts Model::energies(const State& state) const {
  EnergyParts parts;
  for (const auto& block : blocks) block->add_energies(state, parts);
  const Charges held = charges(state, false);
  for (std::size_t e = 0; e < electrodes.size(); ++e) parts.electric += held.charge[e] * state.voltage[e] / 2;
  if (state.motion) {
    const Eigen::VectorXd& velocity = state.motion->velocity;
    parts.kinetic = velocity.dot(inertia.mass * velocity) / 2;
    parts.dissipation += velocity.dot(inertia.damping * velocity);
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
