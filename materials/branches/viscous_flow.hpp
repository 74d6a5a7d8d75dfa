// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/algebra/small_matrices.hpp"
#include "materials/branches/neo_hookean_branch.hpp"
#include "materials/branches/time_scheme.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <limits>

namespace dielast::materials {

/// A function of the viscous unknowns y, to second order; with three more: and of the in-plane C, which comes
/// behind them.
template<int N>
struct Joint {
  double value = 0;
  Eigen::Vector<double, N> first = Eigen::Vector<double, N>::Zero();
  Eigen::Matrix<double, N, N> second = Eigen::Matrix<double, N, N>::Zero();
};

inline Eigen::Vector3d cofactor_of(double m11, double m22, double m12) { return {m22, m11, -2 * m12}; }
inline Eigen::Matrix3d second_of_det() { return Eigen::Matrix3d{{0, 1, 0}, {1, 0, 0}, {0, 0, -2}}; }

/// Flow of the logarithmic dashpot over a step: y = (G11, G22, G12) of G = Cv^-1, G33 = 1/det G; the
/// dissipation over the step is weight (H : G), weight = eta/(2 dt).
struct LogFlow {
  static constexpr int unknowns = 3;
  double weight;
  ViscousHistory<double> H;

  bool admits(const Eigen::Vector3d& y) const { return y[0] > 0 && y[0] * y[1] > y[2] * y[2]; }

  /// C : G
  template<int N>
  Joint<N> trace(const InPlaneC<double>& C, const Eigen::Vector3d& y) const {
    Joint<N> T;
    T.value = C.C11 * y[0] + C.C22 * y[1] + 2 * C.C12 * y[2];
    T.first.template head<3>() << C.C11, C.C22, 2 * C.C12;
    if constexpr (N == 6) {
      T.first.template tail<3>() << y[0], y[1], 2 * y[2];
      T.second.template topRightCorner<3, 3>().diagonal() << 1, 1, 2;
      T.second.template bottomLeftCorner<3, 3>().diagonal() << 1, 1, 2;
    }
    return T;
  }
  /// det C det G
  template<int N>
  Joint<N> det(const InPlaneC<double>& C, const Eigen::Vector3d& y) const {
    const double c = C.det(), g = y[0] * y[1] - y[2] * y[2];
    const Eigen::Vector3d g_1 = cofactor_of(y[0], y[1], y[2]);
    Joint<N> D;
    D.value = c * g;
    D.first.template head<3>() = c * g_1;
    D.second.template topLeftCorner<3, 3>() = c * second_of_det();
    if constexpr (N == 6) {
      const Eigen::Vector3d c_1 = cofactor_of(C.C11, C.C22, C.C12);
      D.first.template tail<3>() = g * c_1;
      D.second.template topRightCorner<3, 3>() = g_1 * c_1.transpose();
      D.second.template bottomLeftCorner<3, 3>() = c_1 * g_1.transpose();
      D.second.template bottomRightCorner<3, 3>() = g * second_of_det();
    }
    return D;
  }
  template<int N>
  void add_dissipation(Joint<N>& sum, const Eigen::Vector3d& y) const {
    const double g = y[0] * y[1] - y[2] * y[2];
    const Eigen::Vector3d g_1 = cofactor_of(y[0], y[1], y[2]);
    const InPlaneC<double>& P = H.plane;
    sum.value += weight * (P.C11 * y[0] + P.C22 * y[1] + 2 * P.C12 * y[2] + H.normal / g - 3 * cbrt(H.det()));
    sum.first.template head<3>() +=
        weight * (Eigen::Vector3d(P.C11, P.C22, 2 * P.C12) - H.normal / (g * g) * g_1);
    sum.second.template topLeftCorner<3, 3>() +=
        weight * H.normal / (g * g) * (2 / g * g_1 * g_1.transpose() - second_of_det());
  }
};

/// What a step minimises: W(T, D), with T and D functions of y and C, and the dissipation over the step.
template<int N, class Law>
Joint<N> step_potential(const Law& law, const LogFlow& flow, const InPlaneC<double>& C,
                        const Eigen::Vector3d& y) {
  const Joint<N> T = flow.template trace<N>(C, y), D = flow.template det<N>(C, y);
  const PlanarDerivatives<double> w = planar(law, T.value, D.value);
  const Eigen::Vector<double, N> along_T = w.dTT * T.first + w.dTD * D.first,
                                 along_D = w.dTD * T.first + w.dDD * D.first;
  Joint<N> sum;
  sum.value = w.value;
  sum.first = w.dT * T.first + w.dD * D.first;
  sum.second =
      w.dT * T.second + w.dD * D.second + along_T * T.first.transpose() + along_D * D.first.transpose();
  flow.add_dissipation(sum, y);
  return sum;
}

/// Flow of the nominal dashpot over a step: y = (xi_1, xi_2); the dissipation over the step is weight sum (a0
/// xi_i - h_i)^2 over the `directions` that flow, weight = eta/(2 dt a0). The others stay where they are,
/// with a stiffness of one.
struct NominalFlow {
  static constexpr int unknowns = 2;
  double weight, a0;
  std::array<double, 2> h;
  std::array<bool, 2> directions;
  std::array<double, 2> expected; ///< y, from the last two

  bool admits(const Eigen::Vector2d& y) const { return y[0] > 0 && y[1] > 0; }
};

/// The same with T = C11/xi_1^2 + C22/xi_2^2 and D = det C/(xi_1 xi_2)^2; N = 5: and of the in-plane C.
/// Entry by entry: this is what runs with dashpots spend their time on.
template<int N, class Law>
Joint<N> step_potential(const Law& law, const NominalFlow& flow, const InPlaneC<double>& C,
                        const Eigen::Vector2d& y) {
  const std::array<double, 2> c{C.C11, C.C22};
  std::array<double, 2> g, T_1{}, D_1{}, rate{}; // rate: of ln g_i with y_i
  for (std::size_t i = 0; i < 2; ++i) {
    const double inverse = 1 / y[static_cast<Eigen::Index>(i)];
    g[i] = inverse * inverse;
    if (flow.directions[i]) rate[i] = -2 * inverse;
    T_1[i] = c[i] * g[i] * rate[i];
  }
  const double g_det = g[0] * g[1], D = C.det() * g_det;
  for (std::size_t i = 0; i < 2; ++i) D_1[i] = D * rate[i];
  const PlanarDerivatives<double> w = planar(law, c[0] * g[0] + c[1] * g[1], D);
  Joint<N> sum;
  sum.value = w.value;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (!flow.directions[i]) {
      sum.second(row, row) = 1;
      continue;
    }
    const double step = flow.a0 * y[row] - flow.h[i];
    sum.value += flow.weight * step * step;
    sum.first[row] = w.dT * T_1[i] + w.dD * D_1[i] + 2 * flow.weight * flow.a0 * step;
    const double along_T = w.dTT * T_1[i] + w.dTD * D_1[i],
                 along_D = w.dTD * T_1[i] + w.dDD * D_1[i] + w.dD * rate[i];
    for (std::size_t j = 0; j < 2; ++j)
      sum.second(row, static_cast<Eigen::Index>(j)) = along_T * T_1[j] + along_D * D_1[j];
    sum.second(row, row) +=
        1.5 * w.dT * T_1[i] * rate[i] + 0.5 * w.dD * D_1[i] * rate[i] + 2 * flow.weight * flow.a0 * flow.a0;
    if constexpr (N == 5) {
      const std::array<double, 3> D_C{g_det * C.C22, g_det * C.C11, -2 * g_det * C.C12};
      for (std::size_t k = 0; k < 3; ++k) {
        const double T_C = k < 2 ? g[k] : 0, T_mixed = k == i ? g[i] * rate[i] : 0;
        const auto column = static_cast<Eigen::Index>(2 + k);
        sum.second(row, column) = sum.second(column, row) = along_T * T_C + along_D * D_C[k] + w.dT * T_mixed;
      }
    }
  }
  if constexpr (N == 5) {
    const MembranePotential<double> of_C =
        in_components<linear_in_first_invariant<Law>>(w, C, InPlaneC<double>{g[0], g[1], 0}, g_det);
    for (std::size_t k = 0; k < 3; ++k) sum.first[static_cast<Eigen::Index>(2 + k)] = of_C.first[k];
    for (std::size_t p = 0; p < component_pairs.size(); ++p) {
      const auto [k, l] = component_pairs[p];
      sum.second(2 + k, 2 + l) = sum.second(2 + l, 2 + k) = of_C.second[p];
    }
  }
  return sum;
}

inline bool positive_definite(const Eigen::Matrix2d& K) { return K(0, 0) > 0 && K.determinant() > 0; }
inline bool positive_definite(const Eigen::Matrix3d& K) {
  return K(0, 0) > 0 && K(0, 0) * K(1, 1) > K(0, 1) * K(0, 1) && K.determinant() > 0;
}

/// Viscous unknowns at the end of a step; not found: the law cannot be in any state that was tried.
template<class Flow>
struct Settled {
  bool found;
  Eigen::Vector<double, Flow::unknowns> y;
};

/// Damped Newton for the viscous unknowns that minimise the step potential at a fixed C, from y. The value is
/// not a number when none was found.
template<class Law, class Flow>
Settled<Flow> settle(const Law& law, const Flow& flow, const InPlaneC<double>& C,
                     Eigen::Vector<double, Flow::unknowns> y) {
  constexpr int N = Flow::unknowns;
  using Vector = Eigen::Vector<double, N>;
  using Matrix = Eigen::Matrix<double, N, N>;
  Joint<N> at = step_potential<N>(law, flow, C, y);
  for (int iteration = 0; iteration < 60 && std::isfinite(at.value); ++iteration) {
    const Vector slope = at.first;
    const Matrix curvature = at.second;
    const bool convex = positive_definite(curvature);
    Vector step;
    if (convex) {
      step = -(curvature.inverse() * slope);
    } else { // far from the minimum: turn the concave directions downhill
      const auto [values, axes] = symmetric_eigen(curvature);
      const Vector stiffness = values.cwiseAbs().cwiseMax(1e-6 * values.cwiseAbs().maxCoeff());
      step = -axes * (axes.transpose() * slope).cwiseQuotient(stiffness);
    }
    // Convergence is quadratic: from a relative error of 1e-8 one more step reaches the last digits.
    const double scale = y.dot(curvature * y);
    const bool last = convex && -slope.dot(step) <= 1e-16 * scale;
    if (last && flow.admits(y + step)) return {true, y + step};
    const double noise = 1e-14 * std::abs(scale);
    for (int halving = 0; halving < 40; ++halving, step /= 2) {
      if (!flow.admits(y + step)) continue;
      const Joint<N> trial = step_potential<N>(law, flow, C, y + step);
      if (!(trial.value <= at.value + noise)) continue;
      y += step;
      at = trial;
      break;
    }
    if (last) return {true, y};
  }
  return {false, y};
}

/// The step potential as a function of C alone, around the settled y that follows C.
template<class Law, class Flow>
MembranePotential<double> condensed(const Law& law, const Flow& flow, const InPlaneC<double>& C,
                                    const Settled<Flow>& settled) {
  if (!settled.found) return {std::numeric_limits<double>::quiet_NaN(), {}, {}};
  constexpr int N = Flow::unknowns;
  const Joint<N + 3> joint = step_potential<N + 3>(law, flow, C, settled.y);
  const Eigen::Matrix<double, N, N> own = joint.second.template topLeftCorner<N, N>();
  const Eigen::Matrix<double, N, 3> mixed = joint.second.template topRightCorner<N, 3>(),
                                    follows = own.inverse().lazyProduct(mixed);
  const Eigen::Matrix3d K =
      joint.second.template bottomRightCorner<3, 3>() - mixed.transpose().lazyProduct(follows);
  MembranePotential<double> potential{
      joint.value, {joint.first[N], joint.first[N + 1], joint.first[N + 2]}, {}};
  for (std::size_t p = 0; p < 6; ++p) potential.second[p] = K(component_pairs[p][0], component_pairs[p][1]);
  return potential;
}

} // namespace dielast::materials
