#pragma once

#include "materials/branch.hpp"

namespace dielast::materials {

/// Homogeneous tests with one stretch l of an incompressible film. The principal stretches are
///   uniaxial: l, l^(-1/2), l^(-1/2);  pure shear: l, 1, 1/l;  equal-biaxial: l, l, 1/l^2.
enum class Mode { uniaxial, pure_shear, equal_biaxial };

/// Potential per undeformed volume with its derivatives in l. `first` is the nominal stress, Pa;
/// equal-biaxial: twice the nominal stress, as two axes are pulled.
struct LinePotential {
  double value, first, second;
};

/// W(l) of the law. St. Venant-Kirchhoff in uniaxial stress: W = Y/2 E^2, E = (l^2 - 1)/2.
LinePotential line_potential(const ElasticLaw& law, Mode mode, double l);

/// The same for a branch whose viscous deformation, with the stretch xi, stays in the class of the test, over
/// a step of time: W_b(l/xi) plus what the dashpot dissipates, at the xi that makes the sum stationary.
///   log:     2 m eta xi'/xi = -xi dW_b/dxi, m the sum of squared logarithmic strains per (ln xi)^2: 3/2, 2,
///   6; nominal: n eta xi' = -dW_b/dxi, n the number of axes that are pulled: 1, 1, 2.
/// In uniaxial and equal-biaxial tests the log rule is that of Branch in three dimensions; in pure shear it
/// is that rule with no viscous strain across.
LinePotential line_branch_potential(const Branch& branch, Mode mode, double l, const TimeScheme& scheme,
                                    double now, double before);

/// xi at the end of the step that ends at l; 1 is undeformed.
double line_branch_advance(const Branch& branch, Mode mode, double l, const TimeScheme& scheme, double now,
                           double before);

} // namespace dielast::materials
