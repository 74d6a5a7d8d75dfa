// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/renumbering.hpp"

#include <memory>
#include <stdexcept>

namespace dielast::fem {

Renumbering::Renumbering(const DofMap& from, const DofMap& to)
    : to_(to), from_(static_cast<std::size_t>(to.count())), was_held_(from_.size()) {
  for (int node = 0; node < to.node_count(); ++node)
    for (int c = 0; c < DofMap::unknowns; ++c)
      if (const int e = to.equation(node, c); e != DofMap::absent) {
        const auto at = static_cast<std::size_t>(e);
        from_[at] = from.equation(node, c);
        if (from_[at] == DofMap::absent) throw std::logic_error("a node turns in another way than before");
        was_held_[at] = from.is_held(from_[at]);
      }
}

Eigen::VectorXd Renumbering::operator()(const Eigen::VectorXd& values) const {
  Eigen::VectorXd moved = values;
  for (std::size_t e = 0; e < from_.size(); ++e) moved[static_cast<Eigen::Index>(e)] = values[from_[e]];
  return moved;
}

State Renumbering::operator()(State state) const {
  state.dead_force = (*this)(state.dead_force);
  if (!state.motion) return state;
  Motion motion = *state.motion;
  for (Eigen::VectorXd* part : {&motion.position, &motion.velocity, &motion.acceleration, &motion.unbalanced,
                                &motion.acceleration_now}) {
    *part = (*this)(*part);
    if (part != &motion.position) part->segment(to_.free_count(), to_.held_count()).setZero();
  }
  for (int e = 0; e < to_.free_count(); ++e)
    if (was_held_[static_cast<std::size_t>(e)]) motion.unbalanced[e] = 0;
  motion.step = 0; // time steps begin anew
  state.motion = std::make_shared<const Motion>(std::move(motion));
  return state;
}

Eigen::VectorXd Renumbering::let_go(const Eigen::VectorXd& values) const {
  Eigen::VectorXd freed = Eigen::VectorXd::Zero(to_.count());
  for (int e = 0; e < to_.free_count(); ++e)
    if (was_held_[static_cast<std::size_t>(e)]) freed[e] = values[from_[static_cast<std::size_t>(e)]];
  return freed;
}

} // namespace dielast::fem
