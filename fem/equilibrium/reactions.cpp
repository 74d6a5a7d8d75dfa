// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/reactions.hpp"

namespace dielast::fem {

Holding holding(Equilibrium& equilibrium, const State& state) {
  Holding held;
  held.energy = equilibrium.internal_force(state, held.force).energy;
  if (!state.motion) return held;
  const Model& model = equilibrium.model();
  const Motion& motion = *state.motion;
  Eigen::VectorXd inertial =
      model.inertia().mass * motion.acceleration_now + model.inertia().resistance(motion.velocity);
  model.dofs.gather(state, inertial);
  held.force += inertial;
  return held;
}

Eigen::VectorXd reactions(const Model& model, const State& state, const Holding& held) {
  Eigen::VectorXd dead = state.dead_force; // supports carry those on tied nodes
  model.dofs.gather(state, dead);
  Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(dead.size());
  for (const auto& block : model.blocks) block->add_forces_at_rest(state, model.dofs, at_rest);
  model.dofs.gather(state, at_rest);
  const auto supported = Eigen::seqN(model.dofs.free_count(), model.dofs.held_count());
  Eigen::VectorXd reaction = held.force - dead;
  reaction(supported) += at_rest(supported);
  return reaction;
}

} // namespace dielast::fem
