// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/sparse_matrix.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace dielast::fem {

/// Direct solver for symmetric matrices of one sparsity pattern. Positive definite ones are factored by a
/// supernodal Cholesky decomposition (Chen, Davis, Hager & Rajamanickam 2008), others by a multifrontal LDL^T
/// with Bunch-Kaufman-type pivoting that tells the inertia. Which one it was is hidden behind
/// negative_pivots().
class SymmetricSolver {
 public:
  /// Analyses the pattern of `matrix` once; its values may change afterwards. `indefinite`: it is known never
  /// to be positive definite.
  explicit SymmetricSolver(const SparseSymmetric& matrix, bool indefinite = false);
  ~SymmetricSolver();
  SymmetricSolver(const SymmetricSolver&) = delete;
  SymmetricSolver& operator=(const SymmetricSolver&) = delete;

  /// Factors the current values, with `added` on the diagonal where it is given. False: singular to working
  /// precision, no solve possible.
  [[nodiscard]] bool factor(const Eigen::VectorXd* added = nullptr);
  /// After a factor() that failed: the equation whose pivot vanished, -1 where that is not known.
  int singular_equation() const { return singular_equation_; }
  /// Number of negative eigenvalues of the matrix last factored; 0 means positive definite.
  int negative_pivots() const;
  /// x with A x = b, size entries each. Requires a successful factor().
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

 private:
  struct Cholesky;
  struct Indefinite;
  const SparseSymmetric& matrix_;
  std::unique_ptr<Cholesky> cholesky_;
  std::unique_ptr<Indefinite> indefinite_; ///< made when first needed
  std::vector<double> shifted_;            ///< values with something on the diagonal
  bool definite_ = true;
  int singular_equation_ = -1;
};

} // namespace dielast::fem
