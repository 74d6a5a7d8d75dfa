// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"

namespace dielast::fem {

/// Largest relative difference between derivatives and central differences of the energy, over random
/// directions.
struct TangentCheck {
  double residual = 0; ///< dE/du . d
  double tangent = 0;  ///< d . d2E/du2 d
  int directions = 0;
};

/// Compares residual and tangent with differences of the energy along `directions` random directions at a
/// randomly perturbed `state` (by `amplitude`, m; rotations by amplitude over the model's length scale).
/// Seeded: repeatable.
TangentCheck check_tangent(Equilibrium& equilibrium, const State& state, double amplitude, int directions);

} // namespace dielast::fem
