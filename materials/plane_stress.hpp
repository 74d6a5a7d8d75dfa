#pragma once

#include "materials/neo_hookean.hpp"

#include <array>

namespace dielast::materials {

/// In-plane right Cauchy-Green tensor of a membrane with respect to the UNSTRETCHED film.
template<class T>
struct InPlaneC {
  T C11, C22, C12;

  T det() const { return C11 * C22 - C12 * C12; }
};

/// Potential of a membrane per undeformed volume, and its derivatives in (C11, C22, C12), C12 counted once:
/// S11 = 2 first[0], S22 = 2 first[1], S12 = first[2]; second = (11,11), (22,22), (12,12), (11,22), (11,12),
/// (22,12).
template<class T>
struct MembranePotential {
  T value;
  std::array<T, 3> first;
  std::array<T, 6> second;
};

/// Plane stress, incompressible, ideal dielectric: C33 = 1/f with f = det C is eliminated, so that
///   Psi = W(I1, I2) - (k/2) f,   I1 = tr C + 1/f,   I2 = f + tr C / f,   k = eps (Phi/H)^2 in Pa
/// (Suo 2010, Acta Mech. Solida Sin. 23, eq. 4 for the electric part). T: double, a dual number, or a pack of
/// doubles.
template<class Law, class T>
T membrane_energy(const Law& law, const InPlaneC<T>& C, const T& k) {
  const T f = C.det();
  const T trace = C.C11 + C.C22;
  return law.energy(trace + 1.0 / f, f + trace / f) - 0.5 * k * f;
}

/// The same potential with its derivatives, by the chain rule. Requires det C > 0.
template<class Law, class T>
inline MembranePotential<T> membrane_potential(const Law& law, const InPlaneC<T>& C, const T& k) {
  constexpr std::array<std::array<int, 2>, 6> pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  constexpr std::array<double, 3> trace_1{1, 1, 0};
  constexpr std::array<double, 6> det_2{0, 0, -2, 1, 0, 0};

  const T f = C.det();
  const T g = 1.0 / f; // C33
  const T g2 = g * g;
  const T trace = C.C11 + C.C22;
  const std::array<T, 3> f_1{C.C22, C.C11, -2.0 * C.C12};
  const T I1 = trace + g;
  const T I2 = f + trace * g;
  const InvariantDerivatives<T> W = law.derivatives(I1, I2);

  MembranePotential<T> potential;
  potential.value = law.energy(I1, I2) - 0.5 * k * f;
  std::array<T, 3> g_1, I1_1, I2_1;
  for (int i = 0; i < 3; ++i) {
    g_1[i] = -g2 * f_1[i];
    I1_1[i] = trace_1[i] + g_1[i];
    potential.first[i] = W.W1 * I1_1[i] - 0.5 * k * f_1[i];
    if constexpr (!Law::linear_in_first_invariant) {
      I2_1[i] = f_1[i] + trace_1[i] * g + trace * g_1[i];
      potential.first[i] += W.W2 * I2_1[i];
    }
  }
  for (int p = 0; p < 6; ++p) {
    const auto [i, j] = pairs[p];
    const T g_2 = 2.0 * g2 * g * f_1[i] * f_1[j] - g2 * det_2[p];
    potential.second[p] = W.W1 * g_2 - 0.5 * det_2[p] * k;
    if constexpr (!Law::linear_in_first_invariant) {
      const T I2_2 = det_2[p] + trace_1[i] * g_1[j] + trace_1[j] * g_1[i] + trace * g_2;
      potential.second[p] += W.W2 * I2_2 + W.W11 * I1_1[i] * I1_1[j] + W.W22 * I2_1[i] * I2_1[j] +
                             W.W12 * (I1_1[i] * I2_1[j] + I2_1[i] * I1_1[j]);
    }
  }
  return potential;
}

} // namespace dielast::materials
