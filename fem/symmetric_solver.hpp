#pragma once

#include "fem/sparse_matrix.hpp"

#include <Eigen/Core>

#include <memory>

namespace dielast::fem {

/// Direct solver for symmetric matrices of one sparsity pattern. Positive definite ones are factored by a
/// supernodal Cholesky decomposition (Chen, Davis, Hager & Rajamanickam 2008), others by a multifrontal LDL^T
/// with Bunch-Kaufman-type pivoting that tells the inertia. Which one it was is hidden behind
/// negative_pivots().
class SymmetricSolver {
 public:
  /// Analyses the pattern of `matrix` once; its values may change afterwards.
  explicit SymmetricSolver(const SparseSymmetric& matrix);
  ~SymmetricSolver();
  SymmetricSolver(const SymmetricSolver&) = delete;
  SymmetricSolver& operator=(const SymmetricSolver&) = delete;

  /// Factors the current values. False: singular to working precision, no solve possible.
  [[nodiscard]] bool factor();
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
  bool definite_ = true;
};

} // namespace dielast::fem
