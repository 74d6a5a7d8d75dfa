// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/planar.hpp"

#include <array>

namespace dielast::materials {

/// Dielectric elastomer with D = eps(C) E. For a film of undeformed thickness H under the voltage Phi the
/// potential per undeformed volume is -(k/2) e(C) det C, with k = eps (Phi/H)^2 and the in-plane C:
///   e = eps(C)/eps = 1 + c (l1 + l2 - 2),  l1 + l2 = sqrt(tr C + 2 sqrt det C)
/// (Zhao & Suo 2008, J. Appl. Phys. 104, 123530); c = 0 is the ideal dielectric (Zhao & Suo 2007). The
/// thickness is that of an incompressible film. Breakdown at the true field E_B (l1 l2)^(n/2): a power n of
/// the equal-biaxial stretch (Koh et al. 2011).
struct Dielectric {
  double permittivity = 0;        ///< eps of the undeformed film, F/m
  double breakdown_field = 100e6; ///< E_B of the undeformed film, V/m
  double electrostriction = 0;    ///< c
  double breakdown_exponent = 0;  ///< n

  static constexpr std::array parameters{
      ParameterOf<Dielectric>{{.name = "permittivity", .unit = "F/m", .meaning = "permittivity eps"},
                              &Dielectric::permittivity},
      ParameterOf<Dielectric>{{.name = "breakdown_field",
                               .unit = "V/m",
                               .meaning = "true electric field at breakdown",
                               .fallback = 100e6},
                              &Dielectric::breakdown_field},
      ParameterOf<Dielectric>{
          {.name = "electrostriction",
           .unit = "1",
           .meaning = "c of the permittivity eps (1 + c (l1 + l2 - 2)), l1, l2: in-plane stretches",
           .above = any_sign,
           .fallback = 0},
          &Dielectric::electrostriction},
      ParameterOf<Dielectric>{
          {.name = "breakdown_exponent",
           .unit = "1",
           .meaning = "power of the equal-biaxial stretch that the breakdown field follows",
           .above = any_sign,
           .fallback = 0},
          &Dielectric::breakdown_exponent}};

  /// F/m, where the in-plane C has this trace and determinant.
  double permittivity_at(double trace, double det) const {
    return permittivity * (1 + electrostriction * (sqrt(trace + 2 * sqrt(det)) - 2));
  }
  /// V/m, where the in-plane C has this determinant.
  double breakdown_field_at(double det) const { return breakdown_field * pow(det, breakdown_exponent / 4); }
};

/// e det C: the film's capacitance over that of the undeformed film.
template<class T>
T capacitance_ratio_value(const Dielectric& dielectric, const T& trace, const T& det) {
  return det * (1.0 + dielectric.electrostriction * (sqrt(trace + 2.0 * sqrt(det)) - 2.0));
}

/// The same with its derivatives in the trace and the determinant.
template<class T>
PlanarDerivatives<T> capacitance_ratio(const Dielectric& dielectric, const T& trace, const T& det) {
  const double c = dielectric.electrostriction;
  if (c == 0) return {det, T{}, T{} + 1.0, T{}, T{}, T{}};
  const T area = sqrt(det), s = sqrt(trace + 2.0 * area); // l1 l2, l1 + l2
  const T s_T = 0.5 / s, s_D = s_T / area;
  const T s_TT = -0.5 * s_T / (s * s), s_TD = s_TT / area;
  const T s_DD = (s_TD - 0.5 * s_D / area) / area;
  const T e = 1.0 + c * (s - 2.0);
  return {e * det,        c * s_T * det,          e + c * s_D * det,
          c * s_TT * det, c * (s_T + s_TD * det), c * (2.0 * s_D + s_DD * det)};
}

} // namespace dielast::materials
