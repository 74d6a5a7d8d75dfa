// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/sparse_matrix.hpp"
#include "fem/machine/workers.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace dielast::fem {

struct FactorMemory;

/// Solver for symmetric matrices of one sparsity pattern. Positive definite ones are factored by
/// MultifrontalCholesky, others by a multifrontal LDL^T with Bunch-Kaufman-type pivoting that tells the
/// inertia. Which one it was is hidden behind negative_pivots(). Where it is known that a matrix is positive
/// definite, KeptFactor saves most factorisations.
class SymmetricSolver {
 public:
  static constexpr double exact = 1e-10; ///< tolerance of solve()
  static constexpr double estimate = 1;  ///< the same: one solve with the factor at hand does

  /// Analyses the pattern of `matrix` once; its values may change afterwards. `indefinite`: it is known never
  /// to be positive definite. Matrix and workers must outlive this.
  SymmetricSolver(const SparseSymmetric& matrix, Workers& workers, bool indefinite = false);
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
  /// Instead of factor(): a factor in single precision, where it proves the current values to be positive
  /// definite. Where that is `known`, the factor of earlier values may do; so does the last such factor where
  /// the values are `close` to those that it was made of. `right`: what solve() will be asked for next, if
  /// that is known.
  [[nodiscard]] bool precondition(bool known, bool close = false, const Eigen::VectorXd* right = nullptr);
  /// x with A x = b, size entries each. Requires a successful factor() or precondition(). After the latter
  /// the error in the norm of A is about `tolerance` times x; not a number where A was singular after all.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance = exact);

  /// What solutions after precondition() depend on beside the current values; null before the first.
  const FactorMemory* memory() const;
  void recall(FactorMemory memory);

  /// What has been done since the solver was made.
  struct Work {
    int factorisations = 0;
    int solves = 0; ///< with a factor, those of every iteration included
  };
  Work work() const;

 private:
  struct Cholesky;
  struct Indefinite;
  const SparseSymmetric& matrix_;
  std::unique_ptr<Cholesky> cholesky_;
  std::unique_ptr<Indefinite> indefinite_; ///< made when first needed
  std::vector<double> shifted_;            ///< values with something on the diagonal
  bool definite_ = true, iterates_ = false;
  int singular_equation_ = -1;
  Work work_;
};

} // namespace dielast::fem
