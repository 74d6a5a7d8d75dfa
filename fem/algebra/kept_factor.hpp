// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/multifrontal_cholesky.hpp"

#include <optional>

namespace dielast::fem {

/// Solves with positive definite matrices of one pattern that change little from one to the next: conjugate
/// gradients (Hestenes & Stiefel 1952), preconditioned by the factor of an earlier matrix in single
/// precision. A factor is replaced when the iterations that a new one would have saved have cost as much as
/// it. Costs are counted, not measured: results do not depend on a clock.
class KeptFactor {
 public:
  /// Both must outlive this.
  KeptFactor(const SparseSymmetric& matrix, const Supernodes& supernodes);

  /// What a factor costs, in iterations with it.
  static double cost(const Supernodes& supernodes);
  /// Where a factor costs less, it is not worth keeping.
  static constexpr double least_cost = 3;
  /// To be called when the matrix has changed. False: single precision does not do for matrices like this
  /// one.
  [[nodiscard]] bool prepare();
  /// x = A^-1 b with the current values, by corrections until one is below `tolerance` of x, in the norm of
  /// A. False: A has turned out not to be positive definite, or not in single precision.
  [[nodiscard]] bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance);

  int factorisations() const { return factorisations_; }
  int solves() const { return solves_; } ///< with the factor

 private:
  bool make();
  std::optional<int> iterate(Eigen::VectorXd& x, double& square, double tolerance, int most);

  const SparseSymmetric& matrix_;
  MultifrontalCholesky<float> factor_;
  double cost_;
  bool made_ = false, fails_ = false; ///< single precision does not do here
  double fresh_ = 0; ///< iterations per decade of the tolerance, of the first solve with the factor; 0 before
  double debt_ = 0;  ///< iterations beyond those
  int factorisations_ = 0, solves_ = 0;
  Eigen::VectorXd r_, z_, p_, Ap_;
};

} // namespace dielast::fem
