// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <optional>

namespace dielast::materials {

// Decompositions of the matrices of a point. They stand in one translation unit because Eigen's templates
// take the compiler up to ten seconds wherever they are used.

/// A = vectors diag(values) vectors^T, values ascending, vectors orthonormal.
template<int N>
struct SymmetricEigen {
  Eigen::Vector<double, N> values;
  Eigen::Matrix<double, N, N> vectors;
};
/// Of a symmetric matrix, of which the lower triangle is read; N = 2, 3 or 6.
template<int N>
SymmetricEigen<N> symmetric_eigen(const Eigen::Matrix<double, N, N>& A);

/// Lower triangular L with L L^T = A, of which the lower triangle is read; none where A is not positive
/// definite. N = 2 or 3.
template<int N>
std::optional<Eigen::Matrix<double, N, N>> cholesky_factor(const Eigen::Matrix<double, N, N>& A);

} // namespace dielast::materials
