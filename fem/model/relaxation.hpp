// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/branch.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>

namespace dielast::fem {

/// Small motions exp(s t) of a branch about a state in which its dashpot does not flow. With its viscous
/// unknowns y, linearised: dW_b = A dC + X dy, 0 = X^T dC + (N + s H) dy, so that the tangent is
///   A - X (N + s H)^-1 X^T = relaxed tangent + sum_j w_j w_j^T s/(s + rate_j):
/// at most three Maxwell elements side by side, in a solid six. `weight`: in (C11, C22, C12), C12 counted
/// once (see materials::MembranePotential), in a solid likewise (see SolidPotential), sqrt(Pa); `rate`: 1/s.
template<int Size>
struct Relaxation {
  Eigen::Vector<double, Size> weight;
  double rate;
};

template<int Size>
struct RelaxationSpectrum {
  int count = 0;
  std::array<Relaxation<Size>, static_cast<std::size_t>(Size)> element;
};

/// From three of the branch's tangents: frozen A, relaxed, and one backward Euler step, which is s =
/// 1/dt. A minus each of the last two gives E_0 = X N^-1 X^T and E_1 = X (N + H/dt)^-1 X^T; E_1 v = beta E_0
/// v on the range of E_0 has beta = rate/(rate + 1/dt). Good for every law and dashpot, those that act along
/// one direction only as well.
template<int Size, class Tangent>
RelaxationSpectrum<Size> relaxation_spectrum(const materials::Branch& branch, const Tangent& tangent) {
  using Matrix = Eigen::Matrix<double, Size, Size>;
  constexpr double negligible = 1e-9; // of the largest stiffness
  const double dt = branch.viscosity / materials::initial_shear_modulus(branch.law);
  const Matrix frozen = tangent(materials::TimeScheme::frozen());
  const Matrix E_0 = frozen - tangent(materials::TimeScheme::relaxed());
  const Matrix E_1 = frozen - tangent(materials::TimeScheme::backward_euler(dt));
  const Eigen::SelfAdjointEigenSolver<Matrix> range(E_0);
  RelaxationSpectrum<Size> spectrum;
  for (int i = 0; i < Size; ++i) spectrum.count += range.eigenvalues()[i] > negligible * frozen.norm();
  const int n = spectrum.count; // ascending: the last ones
  const Eigen::MatrixXd root =
      range.eigenvectors().rightCols(n) * range.eigenvalues().tail(n).cwiseSqrt().asDiagonal();
  const Eigen::MatrixXd inverse =
      range.eigenvectors().rightCols(n) * range.eigenvalues().tail(n).cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> beta(inverse.transpose() * E_1 * inverse);
  for (int i = 0; i < n; ++i)
    spectrum.element[static_cast<std::size_t>(i)] = {
        root * beta.eigenvectors().col(i), beta.eigenvalues()[i] / (1 - beta.eigenvalues()[i]) / dt};
  return spectrum;
}

/// Of a film.
inline RelaxationSpectrum<3> relaxation_spectrum(const materials::Branch& branch,
                                                 const materials::InPlaneC<double>& C,
                                                 const materials::Internal& now) {
  return relaxation_spectrum<3>(branch, [&](const materials::TimeScheme& scheme) {
    const auto psi = materials::branch_potential(branch, C, scheme, now, {});
    Eigen::Matrix3d K;
    for (std::size_t p = 0; p < psi.second.size(); ++p) {
      const auto [i, j] = materials::component_pairs[p];
      K(i, j) = K(j, i) = psi.second[p];
    }
    return K;
  });
}

/// Whether a branch is where its dashpot lets it come to rest at C.
inline bool is_relaxed(const materials::Branch& branch, const materials::InPlaneC<double>& C,
                       const materials::Internal& now) {
  constexpr double still = 1e-4; // of internal variables, which are of order one
  const materials::Internal rest = materials::advance(branch, C, materials::TimeScheme::relaxed(), now, {});
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (std::abs(rest[i] - now[i]) > still * std::max(1.0, std::abs(now[i]))) return false;
  return true;
}

} // namespace dielast::fem
