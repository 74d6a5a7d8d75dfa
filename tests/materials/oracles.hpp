// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/axisymmetric.hpp"
#include "materials/branches/solid_branch.hpp"
#include "materials/laws/dual.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

/// Energies as their formulas say them, for dual numbers: what the hand-written derivatives are tested
/// against. They are singular where principal values are equal.
namespace dielast::materials::test {

/// W in terms of the principal values of the in-plane C.
template<class Law, class T>
T energy_at(const Law& law, const T& c1, const T& c2) {
  const T c3 = 1.0 / (c1 * c2);
  if constexpr (FirstInvariantLaw<Law>)
    return law.energy(T(c1 + c2 + c3));
  else if constexpr (std::same_as<Law, MooneyRivlin>)
    return law.energy(T(c1 + c2 + c3), T(1.0 / c1 + 1.0 / c2 + 1.0 / c3));
  else if constexpr (std::same_as<Law, Ogden>)
    return law.energy(c1, c2, c3);
  else
    return law.plane_stress_energy(c1, c2);
}

/// The first `kept` rows and columns of a form that is stationary in the `flowing` variables behind them.
Eigen::MatrixXd condensed(const Eigen::MatrixXd& form, int kept, int flowing);

/// Minimum over `flowing` of K variables, which come behind the first N; `joint` is given there.
template<int N, int K>
Dual<N> minimum(const Dual<K>& joint, int flowing) {
  Dual<N> y(joint.value);
  y.gradient = joint.gradient.template head<N>();
  y.hessian = joint.hessian.template topLeftCorner<N, N>();
  if (flowing == 0) return y;
  EXPECT_LT(joint.gradient.segment(N, flowing).norm(),
            1e-9 * joint.hessian.block(N, N, flowing, flowing).norm())
      << "not a minimum";
  y.hessian = condensed(joint.hessian, N, flowing);
  return y;
}

// --- films

/// Step potential of a branch in the last three of K variables: G11, G22, G12 or xi_1, xi_2 and one that is
/// not used; `end`: internal variables.
template<int K, class Law>
Dual<K> film_step(const Law& law, const Branch& branch, const InPlaneC<Dual<K>>& C, const TimeScheme& s,
                  const Internal& now, const Internal& before, const Internal& end) {
  const bool flows = !s.is_frozen(), dissipates = flows && !s.is_relaxed();
  const auto variable = [&](double value, int i) {
    return flows ? Dual<K>::variable(value, K - 3 + i) : Dual<K>(value);
  };
  const auto energy = [&](const InPlaneC<Dual<K>>& G) {
    return planar_energy(law, Dual<K>(C.C11 * G.C11 + C.C22 * G.C22 + 2.0 * C.C12 * G.C12),
                         Dual<K>(C.det() * G.det()));
  };
  const double weight = dissipates ? branch.viscosity / (2 * s.dt) : 0;
  const auto h = [&](double a, double b) { return s.h1 * a + s.h2 * b; };
  if (branch.dashpot == Dashpot::nominal) {
    const std::array<Dual<K>, 2> xi{variable(end[0], 0), variable(end[1], 1)};
    Dual<K> sum = energy({1.0 / (xi[0] * xi[0]), 1.0 / (xi[1] * xi[1]), 0.0});
    for (std::size_t i = 0; i < 2; ++i) {
      const Dual<K> step = s.a0 * xi[i] - h(now[i], before[i]);
      sum += weight / s.a0 * step * step;
    }
    return sum;
  }
  const double det = end[0] * end[1] - end[2] * end[2];
  const InPlaneC<Dual<K>> G{variable(end[1] / det, 0), variable(end[0] / det, 1), variable(-end[2] / det, 2)};
  if (!dissipates) return energy(G);
  const InPlaneC<double> H{h(now[0], before[0]), h(now[1], before[1]), h(now[2], before[2])};
  const double H33 =
      h(1 / (now[0] * now[1] - now[2] * now[2]), 1 / (before[0] * before[1] - before[2] * before[2]));
  return energy(G) + weight * (H.C11 * G.C11 + H.C22 * G.C22 + 2 * H.C12 * G.C12 + H33 / G.det() -
                               3 * std::cbrt(H.det() * H33));
}

// --- solids

/// Symmetric tensor in the order 11, 22, 33, 12, 23, 13.
template<class T>
using Tensor = std::array<T, 6>;

template<class T>
T det(const Tensor<T>& A) {
  return A[0] * (A[1] * A[2] - A[4] * A[4]) - A[3] * (A[3] * A[2] - A[4] * A[5]) +
         A[5] * (A[3] * A[4] - A[1] * A[5]);
}
template<class T>
T contraction(const Tensor<T>& A, const Tensor<T>& B) {
  return A[0] * B[0] + A[1] * B[1] + A[2] * B[2] + 2.0 * (A[3] * B[3] + A[4] * B[4] + A[5] * B[5]);
}
/// Inverse times determinant.
template<class T>
Tensor<T> cofactor(const Tensor<T>& A) {
  return {A[1] * A[2] - A[4] * A[4], A[0] * A[2] - A[5] * A[5], A[0] * A[1] - A[3] * A[3],
          A[4] * A[5] - A[3] * A[2], A[3] * A[5] - A[0] * A[4], A[3] * A[4] - A[1] * A[5]};
}
inline Eigen::Matrix3d matrix(const Tensor<double>& A) {
  return Eigen::Matrix3d{{A[0], A[3], A[5]}, {A[3], A[1], A[4]}, {A[5], A[4], A[2]}};
}
inline Tensor<double> components(const Eigen::Matrix3d& A) {
  return {A(0, 0), A(1, 1), A(2, 2), A(0, 1), A(1, 2), A(0, 2)};
}

/// Root of x^3 - I1 x^2 + I2 x - I3 near `start`, with its derivatives.
template<int K>
Dual<K> root_near(double start, const Dual<K>& I1, const Dual<K>& I2, const Dual<K>& I3) {
  Dual<K> x(start);
  for (int i = 0; i < 3; ++i) {
    const Dual<K> value = ((x - I1) * x + I2) * x - I3;
    x = x - value / ((3.0 * x - 2.0 * I1) * x + I2);
  }
  return x;
}

/// Of x^3 - I1 x^2 + I2 x - I3, by Viete's angle.
inline Eigen::Vector3d real_roots(double I1, double I2, double I3) {
  const double mean = I1 / 3, p = mean * mean - I2 / 3, q = mean * (mean * mean - I2 / 2) + I3 / 2;
  const double angle = std::acos(std::clamp(q / (p * std::sqrt(p)), -1.0, 1.0));
  Eigen::Vector3d x;
  for (int i = 0; i < 3; ++i)
    x[i] = mean + 2 * std::sqrt(p) * std::cos((angle + 2 * std::numbers::pi * i) / 3);
  return x;
}

/// W of C G, at constant volume but for St. Venant-Kirchhoff.
template<int K, class Law>
Dual<K> solid_energy(const Law& law, const Tensor<Dual<K>>& C, const Tensor<Dual<K>>& G) {
  using T = Dual<K>;
  const T I1 = contraction(C, G), I2 = contraction(cofactor(C), cofactor(G)), I3 = det(C) * det(G);
  const T shrink = pow(I3, -1.0 / 3);
  if constexpr (FirstInvariantLaw<Law>) {
    return law.energy(T(I1 * shrink));
  } else if constexpr (std::same_as<Law, MooneyRivlin>) {
    return law.energy(T(I1 * shrink), T(I2 * shrink * shrink));
  } else if constexpr (std::same_as<Law, Ogden>) {
    const Eigen::Vector3d c = real_roots(I1.value, I2.value, I3.value);
    return law.energy(T(shrink * root_near(c[0], I1, I2, I3)), T(shrink * root_near(c[1], I1, I2, I3)),
                      T(shrink * root_near(c[2], I1, I2, I3)));
  } else {
    const T strain = 0.5 * (I1 - 3.0);
    return 0.5 * law.first_lame() * strain * strain +
           0.25 * law.initial_shear_modulus() * (I1 * I1 - 2.0 * I2 - 2.0 * I1 + 3.0);
  }
}

/// Step potential of a branch in C and six components of G, which is scaled to unit determinant.
template<class Law>
Dual<12> solid_step(const Law& law, const Branch& branch, const Tensor<double>& C, const TimeScheme& s,
                    const SolidInternal& now, const SolidInternal& before, const SolidInternal& end) {
  using T = Dual<12>;
  const Tensor<double> inverse = components(matrix(end).inverse());
  Tensor<T> x, G;
  for (std::size_t i = 0; i < 6; ++i) {
    x[i] = T::variable(C[i], static_cast<int>(i));
    G[i] = s.is_frozen() ? T(inverse[i]) : T::variable(inverse[i], 6 + static_cast<int>(i));
  }
  const T volume = det(G), shrink = pow(volume, -1.0 / 3), growth = log(volume);
  for (T& g : G) g = g * shrink;
  T sum = solid_energy(law, x, G);
  if (s.is_frozen()) return sum;
  sum += branch.viscosity * growth * growth; // fixes the scale of the six components
  if (s.is_relaxed()) return sum;
  Tensor<double> H{};
  Tensor<T> H_dual;
  for (std::size_t i = 0; i < 6; ++i) H_dual[i] = T(H[i] = s.h1 * now[i] + s.h2 * before[i]);
  return sum + branch.viscosity / (2 * s.dt) * (contraction(H_dual, G) - 3 * std::cbrt(det(H)));
}

} // namespace dielast::materials::test
