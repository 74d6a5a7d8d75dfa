// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/dielectric.hpp"
#include "materials/laws/planar.hpp"

#include <array>

namespace dielast::materials {

/// In-plane right Cauchy-Green tensor of a membrane with respect to the UNSTRETCHED film.
template<class T>
struct InPlaneC {
  T C11, C22, C12;

  T det() const { return C11 * C22 - C12 * C12; }
  T trace() const { return C11 + C22; }
};

/// Potential of a membrane per undeformed volume, and its derivatives in (C11, C22, C12), C12 counted once:
/// S11 = 2 first[0], S22 = 2 first[1], S12 = first[2]; second = (11,11), (22,22), (12,12), (11,22), (11,12),
/// (22,12). What gives one is always inlined: ten packs stay in registers, or are left out where nobody asks.
template<class T>
struct MembranePotential {
  T value;
  std::array<T, 3> first;
  std::array<T, 6> second;
};

/// The pair of components behind each entry of MembranePotential::second.
constexpr std::array<std::array<int, 2>, 6> component_pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

/// From derivatives in (tr(C G), det(C G)) to those in C, for a symmetric metric G = `metric` of determinant
/// `metric_det`; `linear`: only dT, dD and dDD are not zero.
template<bool linear, class T, class Metric>
[[gnu::always_inline]] inline MembranePotential<T>
in_components(const PlanarDerivatives<T>& w, const InPlaneC<T>& C, const InPlaneC<Metric>& metric,
              const Metric& metric_det) {
  constexpr std::array<double, 6> cofactor{0, 0, -2, 1, 0, 0}; // d2 det C
  const std::array<Metric, 3> T_1{metric.C11, metric.C22, 2.0 * metric.C12};
  const std::array<T, 3> D_1{metric_det * C.C22, metric_det * C.C11, -2.0 * metric_det * C.C12};
  MembranePotential<T> potential;
  potential.value = w.value;
  for (std::size_t i = 0; i < 3; ++i) potential.first[i] = w.dT * T_1[i] + w.dD * D_1[i];
  for (std::size_t p = 0; p < 6; ++p) {
    const auto i = static_cast<std::size_t>(component_pairs[p][0]);
    const auto j = static_cast<std::size_t>(component_pairs[p][1]);
    potential.second[p] = w.dDD * D_1[i] * D_1[j] + cofactor[p] * metric_det * w.dD;
    if constexpr (!linear)
      potential.second[p] += w.dTT * T_1[i] * T_1[j] + w.dTD * (T_1[i] * D_1[j] + D_1[i] * T_1[j]);
  }
  return potential;
}

/// Membrane in plane stress with its field: Psi = W(T, D) - (k/2) e(T, D) D, T = tr C, D = det C, k = eps
/// (Phi/H)^2 in Pa with eps of the undeformed film (Suo 2010, Acta Mech. Solida Sin. 23, eq. 4 for the
/// electric part). T: double or Pack. Requires det C > 0; the value is not finite in a state the law cannot
/// be in.
template<class Law, class T>
[[gnu::always_inline]] inline MembranePotential<T>
membrane_potential(const Law& law, const Dielectric& dielectric, const InPlaneC<T>& C, const T& k) {
  constexpr InPlaneC<double> identity{1, 1, 0};
  const T trace = C.trace(), det = C.det();
  PlanarDerivatives<T> w = planar(law, trace, det);
  if (dielectric.electrostriction == 0) {
    w.value -= 0.5 * k * det;
    w.dD -= 0.5 * k;
    return in_components<linear_in_first_invariant<Law>>(w, C, identity, 1.0);
  }
  const PlanarDerivatives<T> Q = capacitance_ratio(dielectric, trace, det);
  w.value -= 0.5 * k * Q.value;
  w.dT -= 0.5 * k * Q.dT;
  w.dD -= 0.5 * k * Q.dD;
  w.dTT -= 0.5 * k * Q.dTT;
  w.dTD -= 0.5 * k * Q.dTD;
  w.dDD -= 0.5 * k * Q.dDD;
  return in_components<false>(w, C, identity, 1.0);
}

/// W of the elastic deformation of a branch, C measured by the metric G, the inverse of the viscous Cv.
template<class Law, class T>
inline MembranePotential<T> membrane_potential(const Law& law, const InPlaneC<T>& C, const InPlaneC<T>& G) {
  const T det = G.det();
  const PlanarDerivatives<T> w =
      planar(law, T(C.C11 * G.C11 + C.C22 * G.C22 + 2.0 * C.C12 * G.C12), T(C.det() * det));
  return in_components<linear_in_first_invariant<Law>>(w, C, G, det);
}

/// The first potential alone, by the laws' own formulas (see planar_energy): also for dual numbers.
template<class Law, class T>
T membrane_energy(const Law& law, const Dielectric& dielectric, const InPlaneC<T>& C, const T& k) {
  const T trace = C.trace(), det = C.det();
  return planar_energy(law, trace, det) - 0.5 * k * capacitance_ratio_value(dielectric, trace, det);
}

} // namespace dielast::materials
