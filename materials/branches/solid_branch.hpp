// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/branch.hpp"
#include "materials/laws/solid.hpp"

namespace dielast::materials {

/// What a branch remembers at a point of a solid: Cv11, Cv22, Cv33, Cv12, Cv23, Cv13.
using SolidInternal = std::array<double, 6>;

constexpr SolidInternal undeformed_solid() { return {1, 1, 1, 0, 0, 0}; }

/// Potential of a branch of a solid over a step of time, the three-dimensional form of branch_potential():
///   Psi_b(C) = min over G, det G = 1, of W_b(J^(-2/3) C G) + eta/(2 dt) [H : G - 3 det(H)^(1/3)],
/// with J^2 = det C, G = Cv^-1 and H = h1 Cv_n + h2 Cv_{n-1} (see TimeScheme); `before` is not read where h2
/// is 0. It feels no change of volume. St. Venant-Kirchhoff branches do: they store W_b(C G), flow at
/// constant volume, and keep W_b(J^(2/3) 1) when they are relaxed. Only for logarithmic dashpots, as the
/// nominal one is defined along the axes of a film: throws std::invalid_argument. The value is not finite
/// where the law cannot be or no viscous deformation was found.
SolidPotential solid_branch_potential(const Branch& branch, const Eigen::Matrix3d& C,
                                      const TimeScheme& scheme, const SolidInternal& now,
                                      const SolidInternal& before);

/// Internal variables at the end of the step that ends at C.
SolidInternal solid_branch_advance(const Branch& branch, const Eigen::Matrix3d& C, const TimeScheme& scheme,
                                   const SolidInternal& now, const SolidInternal& before);

/// See BranchPower.
BranchPower solid_branch_power(const Branch& branch, const Eigen::Matrix3d& C, const SolidInternal& internal);

} // namespace dielast::materials
