// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/dense_algebra.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace dielast::fem {

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A) {
  if (A.rows() == 0) return {}; // Eigen's solver would read beyond it
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& A) { return Eigen::LLT<Eigen::MatrixXd>(A).matrixL(); }

} // namespace dielast::fem
