// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/branch.hpp"

#include <Eigen/Core>

#include <array>

namespace dielast::materials {

/// Small motions exp(s t) of a branch about a state in which its dashpot does not flow. With its viscous
/// unknowns y, linearised: dW_b = A dC + X dy, 0 = X^T dC + (N + s H) dy, so that the tangent is
///   A - X (N + s H)^-1 X^T = relaxed tangent + sum_j w_j w_j^T s/(s + rate_j):
/// at most three Maxwell elements side by side, in a solid six. `weight`: in (C11, C22, C12), C12 counted
/// once (see MembranePotential), in a solid likewise (see SolidPotential), sqrt(Pa); `rate`: 1/s.
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

/// From three of the branch's tangents: frozen A, relaxed, and one backward Euler step dt, which is s = 1/dt.
/// A minus each of the last two gives E_0 = X N^-1 X^T and E_1 = X (N + H/dt)^-1 X^T; E_1 v = beta E_0 v on
/// the range of E_0 has beta = rate/(rate + 1/dt). Good for every law and dashpot, those that act along one
/// direction only as well. Size = 3 or 6.
template<int Size>
RelaxationSpectrum<Size> relaxation_spectrum(const Eigen::Matrix<double, Size, Size>& frozen,
                                             const Eigen::Matrix<double, Size, Size>& relaxed,
                                             const Eigen::Matrix<double, Size, Size>& euler, double dt);

/// `tangent(scheme)`: of the branch over a step.
template<int Size, class Tangent>
RelaxationSpectrum<Size> relaxation_spectrum(const Branch& branch, const Tangent& tangent) {
  const double dt = branch.viscosity / initial_shear_modulus(branch.law);
  return relaxation_spectrum<Size>(tangent(TimeScheme::frozen()), tangent(TimeScheme::relaxed()),
                                   tangent(TimeScheme::backward_euler(dt)), dt);
}

/// Of a film.
RelaxationSpectrum<3> relaxation_spectrum(const Branch& branch, const InPlaneC<double>& C,
                                          const Internal& now);

/// Whether a branch is where its dashpot lets it come to rest at C.
bool is_relaxed(const Branch& branch, const InPlaneC<double>& C, const Internal& now);

} // namespace dielast::materials
