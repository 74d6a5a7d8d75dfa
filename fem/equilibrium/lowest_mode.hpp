// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"

#include <optional>
#include <vector>

namespace dielast::fem {

/// Eigenvector of the tangent under the control of the state, K x = eigenvalue D x with D =
/// Equilibrium::stiffness().
struct Mode {
  double eigenvalue = 0;     ///< -: 1 is as stiff as drawn
  Eigen::VectorXd direction; ///< per free equation; the largest displacement of a node is 1 m
};

/// The mode whose eigenvalue is nearest to zero, by inverse iteration, the first of them where several share
/// it; oriented (see orient_twins(); rotations count times the model's length scale). Nothing where it does
/// not converge.
std::optional<Mode> lowest_mode(Equilibrium& equilibrium, const State& state);

/// Whether something meets no stiffness at a state: an eigenvalue below 1e-13. Rounding leaves 1e-16, and
/// thin shells and long beams have 1e-9. One factorisation and two solves.
bool moves_freely(Equilibrium& equilibrium, const State& state);

/// Scales a direction in the free equations so that the largest displacement of a node is 1 m.
void normalise(const DofMap& dofs, const State& state, Eigen::VectorXd& direction);

/// Displacements of the nodes along a direction in the free equations, at a state.
std::vector<Eigen::Vector3d> displacements(const DofMap& dofs, const State& state,
                                           const Eigen::VectorXd& direction);
/// Rotations of the nodes along it: spins about their rotations in the state.
std::vector<Eigen::Vector3d> spins(const DofMap& dofs, const State& state, const Eigen::VectorXd& direction);

} // namespace dielast::fem
