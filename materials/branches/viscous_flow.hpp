// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/neo_hookean_branch.hpp"
#include "materials/branches/time_scheme.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <limits>

namespace dielast::materials {

/// A function of three viscous unknowns y, to second order; N = 6: and of the in-plane C, which comes behind
/// them.
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

/// Flow of the nominal dashpot over a step: y = (xi_1, xi_2, nothing); the dissipation over the step is
/// weight sum (a0 xi_i - h_i)^2 over the `directions` that flow, weight = eta/(2 dt a0).
struct NominalFlow {
  double weight, a0;
  std::array<double, 2> h;
  std::array<bool, 2> directions;

  bool admits(const Eigen::Vector3d& y) const { return y[0] > 0 && y[1] > 0; }
  bool flows(int i) const { return i < 2 && directions[static_cast<std::size_t>(i)]; }

  /// C11/xi_1^2 + C22/xi_2^2
  template<int N>
  Joint<N> trace(const InPlaneC<double>& C, const Eigen::Vector3d& y) const {
    Joint<N> T;
    for (int i = 0; i < 2; ++i) {
      const double g = 1 / (y[i] * y[i]), c = i == 0 ? C.C11 : C.C22;
      T.value += c * g;
      if constexpr (N == 6) T.first[3 + i] = g;
      if (!flows(i)) continue;
      T.first[i] = -2 * c * g / y[i];
      T.second(i, i) = 6 * c * g * g;
      if constexpr (N == 6) T.second(i, 3 + i) = T.second(3 + i, i) = -2 * g / y[i];
    }
    return T;
  }
  /// det C/(xi_1 xi_2)^2
  template<int N>
  Joint<N> det(const InPlaneC<double>& C, const Eigen::Vector3d& y) const {
    const double g = 1 / (y[0] * y[0] * y[1] * y[1]), c = C.det();
    Eigen::Vector3d rate = Eigen::Vector3d::Zero(); // of ln D with y
    for (int i = 0; i < 2; ++i)
      if (flows(i)) rate[i] = -2 / y[i];
    Joint<N> D;
    D.value = c * g;
    D.first.template head<3>() = c * g * rate;
    D.second.template topLeftCorner<3, 3>() = c * g * rate * rate.transpose();
    D.second.template topLeftCorner<3, 3>().diagonal() += 0.5 * c * g * rate.cwiseAbs2();
    if constexpr (N == 6) {
      const Eigen::Vector3d c_1 = cofactor_of(C.C11, C.C22, C.C12);
      D.first.template tail<3>() = g * c_1;
      D.second.template topRightCorner<3, 3>() = g * rate * c_1.transpose();
      D.second.template bottomLeftCorner<3, 3>() = g * c_1 * rate.transpose();
      D.second.template bottomRightCorner<3, 3>() = g * second_of_det();
    }
    return D;
  }
  template<int N>
  void add_dissipation(Joint<N>& sum, const Eigen::Vector3d& y) const {
    for (int i = 0; i < 3; ++i) {
      if (!flows(i)) {
        sum.second(i, i) = 1; // not an unknown: it stays
        continue;
      }
      const double step = a0 * y[i] - h[static_cast<std::size_t>(i)];
      sum.value += weight * step * step;
      sum.first[i] += 2 * weight * a0 * step;
      sum.second(i, i) += 2 * weight * a0 * a0;
    }
  }
};

/// What a step minimises: W(T, D), with T and D functions of y and C, and the dissipation over the step.
template<int N, class Law, class Flow>
Joint<N> step_potential(const Law& law, const Flow& flow, const InPlaneC<double>& C,
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

inline bool positive_definite(const Eigen::Matrix3d& K) {
  return K(0, 0) > 0 && K(0, 0) * K(1, 1) > K(0, 1) * K(0, 1) && K.determinant() > 0;
}

/// Viscous unknowns at the end of a step; not found: the law cannot be in any state that was tried.
struct Settled {
  bool found;
  Eigen::Vector3d y;
};

/// Damped Newton for the viscous unknowns that minimise the step potential at a fixed C, from y. The value is
/// not a number when none was found.
template<class Law, class Flow>
Settled settle(const Law& law, const Flow& flow, const InPlaneC<double>& C, Eigen::Vector3d y) {
  Joint<3> at = step_potential<3>(law, flow, C, y);
  for (int iteration = 0; iteration < 60 && std::isfinite(at.value); ++iteration) {
    const Eigen::Vector3d slope = at.first;
    const Eigen::Matrix3d curvature = at.second;
    const bool convex = positive_definite(curvature);
    Eigen::Vector3d step;
    if (convex) {
      step = -(curvature.inverse() * slope);
    } else { // far from the minimum: turn the concave directions downhill
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(curvature);
      const double least = 1e-6 * eigen.eigenvalues().cwiseAbs().maxCoeff();
      const Eigen::Vector3d stiffness = eigen.eigenvalues().cwiseAbs().cwiseMax(least);
      step = -eigen.eigenvectors() * (eigen.eigenvectors().transpose() * slope).cwiseQuotient(stiffness);
    }
    // Convergence is quadratic: from a relative error of 1e-8 one more step reaches the last digits.
    const double scale = y.dot(curvature * y);
    const bool last = convex && -slope.dot(step) <= 1e-16 * scale;
    if (last && flow.admits(y + step)) return {true, y + step};
    const double noise = 1e-14 * std::abs(scale);
    for (int halving = 0; halving < 40; ++halving, step /= 2) {
      if (!flow.admits(y + step)) continue;
      const Joint<3> trial = step_potential<3>(law, flow, C, y + step);
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
                                    const Settled& settled) {
  if (!settled.found) return {std::numeric_limits<double>::quiet_NaN(), {}, {}};
  const Joint<6> joint = step_potential<6>(law, flow, C, settled.y);
  const Eigen::Matrix3d mixed = joint.second.topRightCorner<3, 3>();
  const Eigen::Matrix3d K = joint.second.bottomRightCorner<3, 3>() -
                            mixed.transpose() * joint.second.topLeftCorner<3, 3>().inverse() * mixed;
  MembranePotential<double> potential{joint.value, {joint.first[3], joint.first[4], joint.first[5]}, {}};
  for (std::size_t p = 0; p < 6; ++p) potential.second[p] = K(component_pairs[p][0], component_pairs[p][1]);
  return potential;
}

} // namespace dielast::materials
