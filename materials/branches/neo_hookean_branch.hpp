// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/plane_stress.hpp"

namespace dielast::materials {

/// What the viscous deformations at the last two accepted times make the next one start from: H = h1 Cv_n +
/// h2 Cv_{n-1} (see TimeScheme), a tensor in three dimensions with the film's normal as one principal
/// direction.
template<class T>
struct ViscousHistory {
  InPlaneC<T> plane;
  T normal;

  T det() const { return plane.det() * normal; }
};

/// Potential of a neo-Hookean branch (shear modulus mu, viscosity eta, logarithmic dashpot) over a step dt,
/// in closed form: with A = H + (dt mu/eta) C in three dimensions, C33 = 1/det C, the flow ends at Cv =
/// A/det(A)^(1/3) and
///   Psi = 3 eta/(2 dt) [det(A)^(1/3) - det(H)^(1/3)] - 3 mu/2.
/// T: double or Pack.
template<class T>
inline MembranePotential<T> neo_hookean_branch(double mu, double eta, double dt, const InPlaneC<T>& C,
                                               const ViscousHistory<T>& H) {
  constexpr std::array<double, 6> cofactor{0, 0, -2, 1, 0, 0};
  const double q = dt * mu / eta;
  const T D = C.det(), C33 = 1.0 / D;
  const InPlaneC<T> A{H.plane.C11 + q * C.C11, H.plane.C22 + q * C.C22, H.plane.C12 + q * C.C12};
  const T A33 = H.normal + q * C33;
  const T in_plane = 1.0 / A.det(), normal = 1.0 / A33;
  const T root = cbrt(A.det() * A33);
  const T factor = 0.5 * mu * root; // 3 eta/(2 dt) d(root) = factor d(ln det A)/q

  const std::array<T, 3> D_1{C.C22, C.C11, -2.0 * C.C12};
  const std::array<T, 3> a_1{in_plane * A.C22, in_plane * A.C11, -2.0 * in_plane * A.C12}; // d(ln det A)/q
  const T b = -normal * C33 * C33;                                                         // d(ln A33)/(q dD)
  MembranePotential<T> potential;
  potential.value = 1.5 * mu * ((root - cbrt(H.det())) / q - 1.0);
  std::array<T, 3> L_1;
  for (std::size_t i = 0; i < 3; ++i) {
    L_1[i] = a_1[i] + b * D_1[i];
    potential.first[i] = factor * L_1[i];
  }
  for (std::size_t p = 0; p < 6; ++p) {
    const auto i = static_cast<std::size_t>(component_pairs[p][0]);
    const auto j = static_cast<std::size_t>(component_pairs[p][1]);
    const T flow = cofactor[p] * in_plane - a_1[i] * a_1[j] - b * b * D_1[i] * D_1[j] + L_1[i] * L_1[j] / 3.0;
    potential.second[p] = factor * (q * flow - 2.0 * C33 * b * D_1[i] * D_1[j] + b * cofactor[p]);
  }
  return potential;
}

} // namespace dielast::materials
