// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/algebra/small_matrices.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace dielast::materials {

template<int N>
SymmetricEigen<N> symmetric_eigen(const Eigen::Matrix<double, N, N>& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}
template SymmetricEigen<2> symmetric_eigen(const Eigen::Matrix2d& A);
template SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix3d& A);
template SymmetricEigen<6> symmetric_eigen(const Eigen::Matrix<double, 6, 6>& A);

// Eigen's LLT would bring its products of large matrices along.
template<int N>
std::optional<Eigen::Matrix<double, N, N>> cholesky_factor(const Eigen::Matrix<double, N, N>& A) {
  Eigen::Matrix<double, N, N> L = Eigen::Matrix<double, N, N>::Zero();
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) {
      double rest = A(i, j);
      for (int k = 0; k < j; ++k) rest -= L(i, k) * L(j, k);
      if (j < i)
        L(i, j) = rest / L(j, j);
      else if (rest > 0)
        L(i, i) = std::sqrt(rest);
      else
        return std::nullopt;
    }
  return L;
}
template std::optional<Eigen::Matrix2d> cholesky_factor(const Eigen::Matrix2d& A);
template std::optional<Eigen::Matrix3d> cholesky_factor(const Eigen::Matrix3d& A);

} // namespace dielast::materials
