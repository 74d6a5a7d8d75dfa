// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/unseen_motion.hpp"

namespace dielast::fem {

void UnseenMotion::pass(const Model& model, const State& from, const State& to) {
  const Eigen::VectorXd before = position(from, model.dofs), x = position(to, model.dofs);
  if (start.size() == 0) start = before;
  const Eigen::VectorXd d = x - start;
  if (const double now = d.dot(model.inertia().mass * d); now > size) {
    size = now;
    farthest = d;
  }
  const double time = to.time - from.time;
  if (time <= 0) return;
  const Eigen::VectorXd velocity = (x - before) / time;
  kinetic = std::max(kinetic, velocity.dot(model.inertia().mass * velocity) / 2);
}

double UnseenMotion::work(Assembler& assembler, const State& state) const {
  if (farthest.size() == 0) return 0;
  assembler.tangent(state);
  return assembler.matrix().quadratic_form(farthest) / 2;
}

} // namespace dielast::fem
