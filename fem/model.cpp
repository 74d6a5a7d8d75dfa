#include "fem/model.hpp"

namespace dielast::fem {

State Model::initial_state() const {
  const auto nodes = static_cast<std::size_t>(dofs.node_count());
  State state;
  state.displacement.assign(nodes, Eigen::Vector3d::Zero());
  state.rotation.assign(nodes, Eigen::Quaterniond::Identity());
  state.voltage.assign(electrodes.size(), 0.0);
  state.dead_force = Eigen::VectorXd::Zero(dofs.count());
  return state;
}

Samples Model::sample(const State& state) const {
  Samples samples;
  for (const auto& block : blocks) block->sample(state, samples);
  return samples;
}

} // namespace dielast::fem
