// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/branch.hpp"
#include "materials/laws/plane_stress.hpp"

namespace dielast::materials {

/// Potential of an axisymmetric membrane per undeformed volume and its derivatives in the meridional stretch
/// l1 and the hoop stretch l2: the nominal stresses are `first`; second = (11), (22), (12).
struct AxisymmetricPotential {
  double value;
  std::array<double, 2> first;
  std::array<double, 3> second;
};

/// Psi(C) at C = diag(l1^2, l2^2), as a function of the stretches.
inline AxisymmetricPotential in_stretches(const MembranePotential<double>& p, double l1, double l2) {
  return {p.value,
          {2 * l1 * p.first[0], 2 * l2 * p.first[1]},
          {4 * l1 * l1 * p.second[0] + 2 * p.first[0], 4 * l2 * l2 * p.second[1] + 2 * p.first[1],
           4 * l1 * l2 * p.second[3]}};
}

/// Law and field (see plane_stress.hpp).
template<class Law>
AxisymmetricPotential axisymmetric_potential(const Law& law, const Dielectric& dielectric, double l1,
                                             double l2, double k) {
  return in_stretches(membrane_potential(law, dielectric, InPlaneC<double>{l1 * l1, l2 * l2, 0}, k), l1, l2);
}

/// One branch (see branch.hpp).
inline AxisymmetricPotential axisymmetric_branch_potential(const Branch& branch, double l1, double l2,
                                                           const TimeScheme& scheme, const Internal& now,
                                                           const Internal& before) {
  return in_stretches(branch_potential(branch, {l1 * l1, l2 * l2, 0}, scheme, now, before), l1, l2);
}

} // namespace dielast::materials
