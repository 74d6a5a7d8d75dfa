// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/solid.hpp"

#include "materials/algebra/small_matrices.hpp"
#include "materials/laws/dual.hpp"
#include "materials/laws/power_sum.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>

namespace dielast::materials {

namespace {

using Gradient = Eigen::Vector<double, 6>;
using Hessian = Eigen::Matrix<double, 6, 6>;

/// A scalar function of C.
struct Scalar {
  double value;
  Gradient first;
  Hessian second;
};

Scalar first_invariant(const Eigen::Matrix3d& C) {
  return {C.trace(), Gradient{1, 1, 1, 0, 0, 0}, Hessian::Zero()};
}

Scalar second_invariant(const Eigen::Matrix3d& C) {
  static const Hessian second = [] {
    Hessian constant = Hessian::Zero();
    constant.topLeftCorner<3, 3>() = Eigen::Matrix3d::Ones() - Eigen::Matrix3d::Identity();
    constant.diagonal().tail<3>().setConstant(-2);
    return constant;
  }();
  return {(C.trace() * C.trace() - C.squaredNorm()) / 2,
          {C(1, 1) + C(2, 2), C(0, 0) + C(2, 2), C(0, 0) + C(1, 1), -2 * C(0, 1), -2 * C(1, 2), -2 * C(0, 2)},
          second};
}

Scalar third_invariant(const Eigen::Matrix3d& C, Derivatives wanted) {
  const double C11 = C(0, 0), C22 = C(1, 1), C33 = C(2, 2), C12 = C(0, 1), C23 = C(1, 2), C13 = C(0, 2);
  Scalar I3;
  I3.first << C22 * C33 - C23 * C23, C11 * C33 - C13 * C13, C11 * C22 - C12 * C12,
      2 * (C13 * C23 - C12 * C33), 2 * (C12 * C13 - C11 * C23), 2 * (C12 * C23 - C22 * C13);
  I3.value = C11 * I3.first[0] + (C12 * I3.first[3] + C13 * I3.first[5]) / 2;
  if (wanted == Derivatives::second)
    I3.second << 0, C33, C22, 0, -2 * C23, 0,       //
        C33, 0, C11, 0, 0, -2 * C13,                //
        C22, C11, 0, -2 * C12, 0, 0,                //
        0, 0, -2 * C12, -2 * C33, 2 * C13, 2 * C23, //
        -2 * C23, 0, 0, 2 * C13, -2 * C11, 2 * C12, //
        0, -2 * C13, 0, 2 * C23, 2 * C12, -2 * C22;
  return I3;
}

/// tr C^p: its derivatives are p C^(p-1) and the divided differences of p x^(p-1) in the principal axes.
Scalar power_trace(const SymmetricEigen<3>& principal, double p) {
  const auto& [c, Q] = principal;
  Eigen::Matrix3d differences;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double m = (c[i] + c[j]) / 2, s = (c[i] - c[j]) / (2 * m);
      differences(i, j) = std::pow(m, p - 2) * power_sum(p, s * s, c[i] * c[j] / (m * m)).first;
    }
  const Eigen::Vector3d slope = p * c.array().pow(p - 1);
  std::array<Eigen::Matrix3d, 6> turned; // unit changes of C in the principal axes
  Scalar S{c.array().pow(p).sum(), Gradient::Zero(), Hessian::Zero()};
  for (std::size_t a = 0; a < 6; ++a) {
    const auto [i, j] = solid_components[a];
    turned[a] = Q.row(i).transpose() * Q.row(j);
    if (i != j) turned[a] += Eigen::Matrix3d(turned[a].transpose());
    S.first[static_cast<int>(a)] = slope.dot(turned[a].diagonal());
    for (std::size_t b = 0; b <= a; ++b) {
      const double second = (differences.array() * turned[a].array() * turned[b].array()).sum();
      S.second(static_cast<int>(a), static_cast<int>(b)) = second;
      S.second(static_cast<int>(b), static_cast<int>(a)) = second;
    }
  }
  return S;
}

/// W(scalars) by the chain rule.
template<int N>
SolidPotential compose(const Dual<N>& W, const std::array<Scalar, N>& scalars, Derivatives wanted) {
  Eigen::Matrix<double, 6, N> slopes;
  for (int i = 0; i < N; ++i) slopes.col(i) = scalars[static_cast<std::size_t>(i)].first;
  SolidPotential potential;
  potential.value = W.value;
  potential.first = slopes * W.gradient;
  if (wanted == Derivatives::first) return potential;
  potential.second = (slopes * W.hessian).lazyProduct(slopes.transpose());
  for (int i = 0; i < N; ++i)
    if (W.gradient[i] != 0) potential.second += W.gradient[i] * scalars[static_cast<std::size_t>(i)].second;
  return potential;
}

template<int N>
Dual<N> volumetric(double bulk_modulus, const Dual<N>& I3) {
  const Dual<N> swelling = sqrt(I3) - 1.0;
  return 0.5 * bulk_modulus * swelling * swelling;
}

void add_volumetric(double bulk_modulus, const Scalar& I3, Derivatives wanted, SolidPotential& potential) {
  if (bulk_modulus == 0) return;
  const double J = std::sqrt(I3.value), swelling = J - 1;
  const Gradient first = I3.first / (2 * J);
  potential.value += bulk_modulus / 2 * swelling * swelling;
  potential.first += bulk_modulus * swelling * first;
  if (wanted == Derivatives::second)
    potential.second += bulk_modulus * (first * first.transpose() / J + swelling / (2 * J) * I3.second);
}

/// W(I3^(-1/3) I1), what most parts are made of: with less than compose() takes.
template<FirstInvariantLaw Law>
SolidPotential potential_of(const Law& law, const Eigen::Matrix3d& C, double bulk_modulus,
                            Derivatives wanted) {
  const Scalar I3 = third_invariant(C, wanted);
  const double I1 = C.trace(), shrink = 1 / std::cbrt(I3.value), inverse = 1 / (3 * I3.value);
  const auto [W, W1, W11] = law.derivatives(I1 * shrink);
  const Gradient shrinking = -inverse * I3.first; // d(I3^(-1/3)), and below d(I3^(-1/3) I1), over I3^(-1/3)
  Gradient slope = I1 * shrinking;
  slope.head<3>().array() += 1;
  SolidPotential potential;
  potential.value = W;
  potential.first = W1 * shrink * slope;
  if (wanted == Derivatives::second) {
    const Gradient along = W11 * shrink * shrink * slope + W1 * shrink * shrinking,
                   across = W1 * shrink * (slope + 2 * I1 * shrinking);
    potential.second =
        along * slope.transpose() + across * shrinking.transpose() - (W1 * shrink * I1 * inverse) * I3.second;
  }
  add_volumetric(bulk_modulus, I3, wanted, potential);
  return potential;
}

template<class Law>
SolidPotential potential_of(const Law& law, const Eigen::Matrix3d& C, double bulk_modulus,
                            Derivatives wanted) {
  using Dual3 = Dual<3>;
  const std::array<Scalar, 3> I{first_invariant(C), second_invariant(C), third_invariant(C, wanted)};
  const Dual3 I1 = Dual3::variable(I[0].value, 0), I2 = Dual3::variable(I[1].value, 1),
              I3 = Dual3::variable(I[2].value, 2);
  if constexpr (std::same_as<Law, StVenantKirchhoff>) {
    const Dual3 strain = 0.5 * (I1 - 3.0); // tr E
    return compose<3>(0.5 * law.first_lame() * strain * strain +
                          0.25 * law.initial_shear_modulus() * (I1 * I1 - 2.0 * I2 - 2.0 * I1 + 3.0),
                      I, wanted);
  } else {
    const Dual3 shrink = pow(I3, -1.0 / 3);
    return compose<3>(law.energy(I1 * shrink, Dual3(I2 * shrink * shrink)) + volumetric(bulk_modulus, I3), I,
                      wanted);
  }
}

SolidPotential potential_of(const Ogden& law, const Eigen::Matrix3d& C, double bulk_modulus,
                            Derivatives /*all*/) {
  using Dual2 = Dual<2>;
  const SymmetricEigen<3> principal = symmetric_eigen(C);
  const Scalar I3 = third_invariant(C, Derivatives::second);
  const Dual2 det = Dual2::variable(I3.value, 1);
  SolidPotential sum = compose<2>(volumetric(bulk_modulus, det),
                                  {Scalar{0, Gradient::Zero(), Hessian::Zero()}, I3}, Derivatives::second);
  for (std::size_t i = 0; i < law.moduli.size(); ++i) {
    const double p = law.exponents[i] / 2;
    const Scalar S = power_trace(principal, p);
    const Dual2 W = law.moduli[i] / law.exponents[i] * (Dual2::variable(S.value, 0) * pow(det, -p / 3) - 3.0);
    const SolidPotential term = compose<2>(W, {S, I3}, Derivatives::second);
    sum.value += term.value;
    sum.first += term.first;
    sum.second += term.second;
  }
  return sum;
}

} // namespace

SolidPotential volume_ratio(const Eigen::Matrix3d& C, Derivatives wanted) {
  const Scalar I3 = third_invariant(C, wanted);
  SolidPotential J;
  J.value = std::sqrt(I3.value);
  J.first = I3.first / (2 * J.value);
  if (wanted == Derivatives::second) J.second = (I3.second / 2 - J.first * J.first.transpose()) / J.value;
  return J;
}

SolidPotential solid_potential(const ElasticLaw& law, const Eigen::Matrix3d& C, double bulk_modulus,
                               Derivatives wanted) {
  return std::visit([&](const auto& one) { return potential_of(one, C, bulk_modulus, wanted); }, law);
}

} // namespace dielast::materials
