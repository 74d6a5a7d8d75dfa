// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"

namespace dielast::fem {

/// The mass matrix of the free equations, kg, and omega^2 of single unknowns, 1/s^2: the sum of their
/// stiffnesses over that of their masses.
struct FreeMass {
  Eigen::SparseMatrix<double> M;
  double fastest = 0;
};
FreeMass free_mass(const Equilibrium& equilibrium, const State& state);

/// What of small rigid motions a model resists with its mass alone: of translations along and turns about x,
/// y and z those that its unknowns admit, and of these those without stiffness, but for what forces that do
/// not balance make of one; where `damped`, without dampers, too. Columns per free equation, orthonormal in
/// the mass matrix, 1/sqrt(kg).
struct RigidMotions {
  Eigen::MatrixXd motions, momenta; ///< momenta = M motions

  /// Takes them off columns per free equation: where nothing pushes a device as a whole, what of them its
  /// motion has is rounding.
  void take_off(Eigen::MatrixXd& X) const;
};
RigidMotions rigid_motions(Equilibrium& equilibrium, const State& state, const FreeMass& mass,
                           bool damped = false);

/// V^T A V of the symmetric matrix with these values in a pattern.
Eigen::MatrixXd projected(const SparseSymmetric& pattern, const std::vector<double>& values,
                          const Eigen::MatrixXd& V);

/// Of the columns of X, one after another, what is not in the span of V (orthonormal in M) nor in that of
/// those before, orthonormal in M; columns of which nothing is left are left out.
Eigen::MatrixXd orthonormal_to(const Eigen::MatrixXd& V, const Eigen::SparseMatrix<double>& M,
                               Eigen::MatrixXd X);

} // namespace dielast::fem
