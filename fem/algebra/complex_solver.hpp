// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/sparse_matrix.hpp"

#include <Eigen/Core>

#include <complex>
#include <memory>
#include <vector>

namespace dielast::fem {

/// Direct solver for complex symmetric (not Hermitian) matrices of one sparsity pattern: multifrontal LDL^T
/// with pivoting.
class ComplexSolver {
 public:
  /// Analyses the pattern of `matrix` once; its values are not read.
  explicit ComplexSolver(const SparseSymmetric& matrix);
  ~ComplexSolver();
  ComplexSolver(const ComplexSolver&) = delete;
  ComplexSolver& operator=(const ComplexSolver&) = delete;

  /// `values` in the order of the pattern's; they must live until the last solve(). False: singular to
  /// working precision.
  [[nodiscard]] bool factor(std::vector<std::complex<double>>& values);
  /// A^-1 B, column by column. Requires a successful factor().
  Eigen::MatrixXcd solve(Eigen::MatrixXcd B);

 private:
  struct Factorisation;
  std::unique_ptr<Factorisation> factorisation_; ///< null: no unknowns
};

} // namespace dielast::fem
