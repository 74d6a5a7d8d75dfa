// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"

namespace dielast::fem {

/// What an accepted state is held by.
struct Holding {
  /// What acts from outside, N and N m, per equation: internal forces and those of inertia, damping and drag
  /// at the state's own time, those on tied nodes moved to their masters. Less the dead forces these are the
  /// reactions at held equations; where no mass moves, zero at free ones.
  Eigen::VectorXd force;
  double energy = 0; ///< of the elements, J
};
Holding holding(Equilibrium& equilibrium, const State& state);

/// Of supports on the model at held equations, N and N m.
Eigen::VectorXd reactions(const Model& model, const State& state, const Holding& held);

} // namespace dielast::fem
