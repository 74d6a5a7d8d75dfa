// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/elastic_law.hpp"

namespace dielast::materials {

/// An energy density in the plane of a film and its derivatives in T = tr C and D = det C, where C is the
/// in-plane right Cauchy-Green tensor. Everything that an isotropic film stores is a function of these two:
/// incompressible laws have C33 = 1/D, the St. Venant-Kirchhoff law the strain E33 of plane stress.
template<class T>
struct PlanarDerivatives {
  T value, dT, dD, dTT, dTD, dDD;
};

/// W of T and D with derivatives, J/m^3; D > 0. I1 = T + 1/D.
template<FirstInvariantLaw Law, class T>
PlanarDerivatives<T> planar(const Law& law, const T& trace, const T& det) {
  const T C33 = 1.0 / det, slope = -C33 * C33; // dI1/dD
  const InvariantDerivatives<T> W = law.derivatives(trace + C33);
  const T curvature = -2.0 * C33 * slope; // d2I1/dD2
  if constexpr (linear_in_first_invariant<Law>)
    return {W.W, W.W1, W.W1 * slope, T{}, T{}, W.W1 * curvature};
  else
    return {W.W, W.W1, W.W1 * slope, W.W11, W.W11 * slope, W.W11 * slope * slope + W.W1 * curvature};
}

/// I1 = T + 1/D, I2 = D + T/D.
template<class T>
PlanarDerivatives<T> planar(const MooneyRivlin& law, const T& trace, const T& det) {
  const T C33 = 1.0 / det, C33_1 = -C33 * C33, C33_2 = -2.0 * C33 * C33_1;
  return {law.energy(trace + C33, det + trace * C33),
          law.c1 + law.c2 * C33,
          law.c1 * C33_1 + law.c2 * (1.0 + trace * C33_1),
          T{},
          law.c2 * C33_1,
          (law.c1 + law.c2 * trace) * C33_2};
}

/// c1, c2 = T/2 (1 +- sqrt y) with y = 1 - 4D/T^2, c3 = 1/D (see power_sum.hpp).
PlanarDerivatives<double> planar(const Ogden& law, double trace, double det);

inline PlanarDerivatives<Pack> planar(const Ogden& law, const Pack& trace, const Pack& det) {
  PlanarDerivatives<Pack> all{};
  for (int l = 0; l < pack_lanes; ++l) {
    const PlanarDerivatives<double> one = planar(law, trace[l], det[l]);
    all.value[l] = one.value;
    all.dT[l] = one.dT;
    all.dD[l] = one.dD;
    all.dTT[l] = one.dTT;
    all.dTD[l] = one.dTD;
    all.dDD[l] = one.dDD;
  }
  return all;
}

/// tr E = (T - 2)/2 and tr E^2 = (T^2 - 2D - 2T + 2)/4 in the plane.
template<class T>
PlanarDerivatives<T> planar(const StVenantKirchhoff& law, const T& trace, const T& det) {
  const double nu = law.poisson_ratio;
  const double a = law.youngs_modulus * nu / (1 - nu * nu), b = law.youngs_modulus / (1 + nu);
  const T strain = trace - 2.0;
  return {a / 8 * strain * strain + b / 8 * (trace * trace - 2.0 * det - 2.0 * strain - 2.0),
          a / 4 * strain + b / 4 * (trace - 1.0),
          T{} - b / 4,
          T{} + (a + b) / 4,
          T{},
          T{}};
}

/// The same energies alone, from the laws' own formulas in invariants or principal values: the reference that
/// the derivatives are tested against, in dual numbers. Ogden's is singular at equal principal stretches.
template<class Law, class T>
T planar_energy(const Law& law, const T& trace, const T& det) {
  if constexpr (FirstInvariantLaw<Law>) {
    return law.energy(trace + 1.0 / det);
  } else if constexpr (std::same_as<Law, MooneyRivlin>) {
    return law.energy(trace + 1.0 / det, det + trace / det);
  } else {
    const T radius = sqrt(0.25 * trace * trace - det);
    const T c1 = 0.5 * trace + radius, c2 = det / c1;
    if constexpr (std::same_as<Law, Ogden>)
      return law.energy(c1, c2, T(1.0 / det));
    else
      return law.plane_stress_energy(c1, c2);
  }
}

} // namespace dielast::materials
