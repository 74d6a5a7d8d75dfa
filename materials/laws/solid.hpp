// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/elastic_law.hpp"

#include <Eigen/Core>

#include <array>

namespace dielast::materials {

/// The places of the six components of a symmetric tensor of a solid.
constexpr std::array<std::array<int, 2>, 6> solid_components{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

/// Potential of a solid per undeformed volume and its derivatives in the components of the right Cauchy-Green
/// tensor C in the order 11, 22, 33, 12, 23, 13, each off-diagonal counted once: S_ii = 2 first, S_ij =
/// first.
struct SolidPotential {
  double value;
  Eigen::Vector<double, 6> first;
  Eigen::Matrix<double, 6, 6> second;
};

/// Up to which derivatives something is wanted; what lies beyond is not set.
enum class Derivatives { first, second };

/// The volume ratio J = sqrt(det C) and its derivatives in the components of C, counted as in SolidPotential.
SolidPotential volume_ratio(const Eigen::Matrix3d& C, Derivatives wanted = Derivatives::second);

/// Incompressible laws are made slightly compressible: W(J^(-2/3) C) + kappa/2 (J - 1)^2, J = sqrt(det C),
/// with the bulk modulus kappa (Pa). St. Venant-Kirchhoff is taken as it is and does not see kappa. Ogden's
/// law by spectral decomposition with divided differences, regular where principal stretches are equal.
SolidPotential solid_potential(const ElasticLaw& law, const Eigen::Matrix3d& C, double bulk_modulus,
                               Derivatives wanted = Derivatives::second);

} // namespace dielast::materials
