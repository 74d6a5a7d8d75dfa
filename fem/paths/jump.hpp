// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"

#include <functional>

namespace dielast::fem {

struct JumpOptions {
  NewtonOptions newton;
  double push = 1e-3;    ///< first displacement along the mode, over the model's extent
  int most_steps = 3000; ///< soft modes of thin shells take a thousand
  double farthest = 100; ///< displacement over the model's extent at which it is given up
  /// Asked before every step: false to leave the motion there (interrupt). Without it it goes on.
  std::function<bool()> goes_on{};
};

enum class JumpEnd { landed, ran_away, stuck, interrupted };

struct JumpResult {
  JumpEnd end{};
  int steps = 0;
  double energy_released = 0; ///< J, at fixed loads
  NewtonResult newton;        ///< of the state landed on
};

/// Lets an unstable state go, with the loads held: overdamped motion c D u' = -(R - f), D =
/// Equilibrium::stiffness(), by linearly implicit Euler steps (K + c/dt D) du = -(R - f). A step is taken
/// where K + c/dt D is positive definite and the energy falls; then the next may be longer, else it is
/// shorter. Where K has become positive definite Newton's method goes to the equilibrium. `direction` is the
/// mode to push along, per free equation; against it only where the energy is lower there by more than
/// round-off, so that a symmetric bifurcation is left along the mode. On success `state` is
/// stable; otherwise it is where the motion was left.
JumpResult jump(Equilibrium& equilibrium, State& state, const Eigen::VectorXd& direction,
                const JumpOptions& options);

} // namespace dielast::fem
