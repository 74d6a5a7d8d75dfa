// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"

namespace dielast::fem {

/// Largest relative differences between derivatives and central differences, over random directions.
struct TangentCheck {
  double residual = 0; ///< r . d, r = dE/du, and differences of the energy E
  double tangent = 0;  ///< d . K d, and differences of r . d
  int directions = 0;
};

/// Compares the residual with differences of the energy, and the tangent with those of the residual, along
/// `directions` random directions at a randomly perturbed `state` (by `amplitude`, m; rotations by amplitude
/// over the model's length scale). Seeded: repeatable.
TangentCheck check_tangent(Equilibrium& equilibrium, const State& state, double amplitude, int directions);

} // namespace dielast::fem
