#include "fem/model.hpp"

namespace dielast::fem {

State Model::initial_state() const {
  const auto nodes = static_cast<std::size_t>(dofs.node_count());
  State state;
  state.displacement.assign(nodes, Eigen::Vector3d::Zero());
  state.rotation.assign(nodes, Eigen::Quaterniond::Identity());
  state.voltage.assign(electrodes.size(), 0.0);
  state.dead_force = Eigen::VectorXd::Zero(dofs.count());
  state.isolated.assign(electrodes.size(), 0);
  state.charge.assign(electrodes.size(), 0.0);
  std::size_t internal = 0;
  for (const auto& block : blocks) internal += static_cast<std::size_t>(block->history_size());
  if (internal > 0) {
    History history{std::vector<double>(internal), {}, {}};
    for (const auto& block : blocks) block->start_history(history.now);
    state.history = std::make_shared<const History>(std::move(history));
    state.scheme = materials::TimeScheme::relaxed();
    return settled(std::move(state)); // relaxed as drawn
  }
  return state;
}

void Model::place_histories() {
  int first = 0;
  for (const auto& block : blocks) {
    block->place_history(first);
    first += block->history_size();
  }
}

Samples Model::sample(const State& state) const {
  Samples samples;
  for (const auto& block : blocks) block->sample(state, samples);
  return samples;
}

Charges Model::charges(const State& state, bool with_coupling) const {
  Charges charges{std::vector<double>(electrodes.size()), std::vector<double>(electrodes.size()), {}};
  if (with_coupling) charges.coupling.assign(electrodes.size(), Eigen::VectorXd::Zero(dofs.count()));
  for (const auto& block : blocks) block->add_charges(state, with_coupling ? &dofs : nullptr, charges);
  return charges;
}

EnergyParts Model::energies(const State& state) const {
  EnergyParts parts;
  for (const auto& block : blocks) block->add_energies(state, parts);
  const Charges held = charges(state, false);
  for (std::size_t e = 0; e < electrodes.size(); ++e) parts.electric += held.charge[e] * state.voltage[e] / 2;
  return parts;
}

std::shared_ptr<const History> Model::advanced_history(const State& state) const {
  if (!state.history || state.scheme.is_frozen()) return state.history;
  const History& last = *state.history;
  History next{last.now, {}, {}};
  for (const auto& block : blocks) block->advance_history(state, next.now);
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
  return state;
}

} // namespace dielast::fem
