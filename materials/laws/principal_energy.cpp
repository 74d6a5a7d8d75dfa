// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/principal_energy.hpp"

#include <cmath>

namespace dielast::materials {

namespace {

template<FirstInvariantLaw Law>
PrincipalEnergy at_unit_volume(const Law& law, const Eigen::Vector3d& b) {
  const InvariantDerivatives<double> W = law.derivatives(b.sum());
  Eigen::Matrix3d second = W.W11 * b * b.transpose();
  second.diagonal() += W.W1 * b;
  return {W.W, W.W1 * b, second, Eigen::Matrix3d::Constant(W.W1)};
}

PrincipalEnergy at_unit_volume(const MooneyRivlin& law, const Eigen::Vector3d& b) {
  const Eigen::Vector3d inverse = b.cwiseInverse();
  return {law.energy(b.sum(), inverse.sum()), law.c1 * b - law.c2 * inverse,
          (law.c1 * b + law.c2 * inverse).asDiagonal(),
          Eigen::Matrix3d::Constant(law.c1) + law.c2 * inverse * inverse.transpose()};
}

PrincipalEnergy at_unit_volume(const Ogden& law, const Eigen::Vector3d& b) {
  PrincipalEnergy W{law.energy(b[0], b[1], b[2]), Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(),
                    Eigen::Matrix3d::Zero()};
  for (std::size_t n = 0; n < law.moduli.size(); ++n) {
    const double p = law.exponents[n] / 2, half_modulus = law.moduli[n] / 2;
    const Eigen::Vector3d power = b.array().pow(p);
    W.first += half_modulus * power;
    W.second.diagonal() += half_modulus * p * power;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double x = std::log(b[i] / b[j]) / 2;
        const double ratio = x == 0 ? p : std::sinh(p * x) / std::sinh(x);
        W.difference(i, j) += half_modulus * std::pow(b[i] * b[j], (p - 1) / 2) * ratio;
      }
  }
  return W;
}

template<class Law>
PrincipalEnergy principal(const Law& law, const Eigen::Vector3d& b) {
  const double scale = std::cbrt(b.prod());
  PrincipalEnergy W = at_unit_volume(law, b / scale);
  const Eigen::Matrix3d deviator = Eigen::Matrix3d::Identity() - Eigen::Matrix3d::Constant(1.0 / 3);
  W.first = deviator * W.first;
  W.second = deviator * W.second * deviator;
  W.difference /= scale;
  return W;
}

PrincipalEnergy principal(const StVenantKirchhoff& law, const Eigen::Vector3d& b) {
  const double lambda = law.first_lame(), mu = law.initial_shear_modulus();
  const Eigen::Vector3d E = (b.array() - 1) / 2;
  const Eigen::Vector3d first = b.array() * (lambda / 2 * E.sum() + mu * E.array());
  Eigen::Matrix3d second = lambda / 4 * b * b.transpose(), difference;
  second.diagonal() += first + mu / 2 * b.cwiseAbs2();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) difference(i, j) = lambda / 2 * E.sum() + mu / 2 * (b[i] + b[j] - 1);
  return {lambda / 2 * E.sum() * E.sum() + mu * E.squaredNorm(), first, second, difference};
}

} // namespace

PrincipalEnergy principal_energy(const ElasticLaw& law, const Eigen::Vector3d& b) {
  return std::visit([&](const auto& one) { return principal(one, b); }, law);
}

} // namespace dielast::materials
