// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/elastic_law.hpp"

#include <Eigen/Core>

namespace dielast::materials {

/// An energy density of a solid as a function of the principal values b_i of its elastic deformation.
struct PrincipalEnergy {
  double value;
  Eigen::Vector3d first;      ///< in ln b_i
  Eigen::Matrix3d second;     ///< in ln b_i, ln b_j
  Eigen::Matrix3d difference; ///< off the diagonal: (first_i - first_j)/(b_i - b_j), regular where b_i = b_j
};

/// Incompressible laws see b_i/(b_1 b_2 b_3)^(1/3).
PrincipalEnergy principal_energy(const ElasticLaw& law, const Eigen::Vector3d& b);

} // namespace dielast::materials
