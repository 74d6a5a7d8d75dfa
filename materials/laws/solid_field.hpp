// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/solid.hpp"

namespace dielast::materials {

/// J E0 . C^-1 E0 and its derivatives in the components of C and of E0, the field per undeformed length: an
/// ideal dielectric has the potential -eps/2 times it per undeformed volume (Dorfmann & Ogden 2005, Acta
/// Mech. 174, 167; Suo, Zhao & Greene 2008, J. Mech. Phys. Solids 56, 467).
struct SolidField {
  double value;
  Eigen::Vector<double, 6> in_C;
  Eigen::Vector3d in_E;
  Eigen::Matrix<double, 6, 6> in_CC;
  Eigen::Matrix<double, 6, 3> in_CE;
  Eigen::Matrix3d in_EE;
};

/// `J`: volume_ratio() of C.
SolidField solid_field(const Eigen::Matrix3d& C, const SolidPotential& J, const Eigen::Vector3d& E0,
                       Derivatives wanted = Derivatives::second);

} // namespace dielast::materials
