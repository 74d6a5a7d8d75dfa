// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/renumbering.hpp"

#include "fem/equilibrium/moving_bodies.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

namespace dielast::fem {

Renumbering::Renumbering(const DofMap& from, const DofMap& to)
    : to_(to), from_(static_cast<std::size_t>(to.count()), DofMap::absent), was_held_(from_.size()) {
  for (int node = 0; node < to.node_count(); ++node)
    for (int c = 0; c < DofMap::unknowns; ++c)
      if (const int e = to.equation(node, c); e != DofMap::absent) {
        const auto at = static_cast<std::size_t>(e);
        from_[at] = from.equation(node, c);
        if (from_[at] == DofMap::absent) throw std::logic_error("a node turns in another way than before");
        was_held_[at] = from.is_held(from_[at]);
      }
  for (int scalar = 0; scalar < to.scalar_count(); ++scalar)
    from_[static_cast<std::size_t>(to.scalar_equation(scalar))] = from.scalar_equation(scalar);
  if (std::ranges::count(from_, DofMap::absent) > 0)
    throw std::logic_error("an unknown has no place in the numbering before");
}

/// Per node whether something of the body that it is tied to is held from now on.
std::vector<char> Renumbering::caught() const {
  std::vector<char> caught(static_cast<std::size_t>(to_.node_count()));
  for (int node = 0; node < to_.node_count(); ++node)
    for (int c = 0; c < DofMap::unknowns; ++c)
      if (const int e = to_.equation(node, c); e != DofMap::absent && to_.is_held(e))
        caught[static_cast<std::size_t>(node)] |= !was_held_[static_cast<std::size_t>(e)];
  std::vector<char> tied(caught.size());
  for (bool more = true; std::exchange(more, false);) // bodies may be tied to one another
    for (const Tie& tie : to_.ties()) {
      const auto node = static_cast<std::size_t>(tie.node), master = static_cast<std::size_t>(tie.master);
      if (tied[node] || !(caught[master] || tied[master])) continue;
      tied[node] = 1;
      more = true;
    }
  return tied;
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
    if (part == &motion.position) continue;
    for (int e = to_.free_count(); e < to_.free_count() + to_.held_count(); ++e) // what was held moves on
      if (!was_held_[static_cast<std::size_t>(e)]) (*part)[e] = 0;
  }
  if (const std::vector<char> bodies = caught(); std::ranges::count(bodies, 1) > 0) {
    const Eigen::SparseMatrix<double> jacobian = to_.jacobian(state);
    const Eigen::VectorXd carried = jacobian * motion.velocity.head(to_.free_count());
    for (const Tie& tie : to_.ties())
      for (int c = 0; c < 3 && bodies[static_cast<std::size_t>(tie.node)]; ++c)
        if (const int e = to_.equation(tie.node, c); e != DofMap::absent) motion.velocity[e] = carried[e];
    for (Eigen::VectorXd* rates : {&motion.acceleration, &motion.acceleration_now})
      carry_accelerations(to_, state, motion.velocity, *rates);
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
