// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace dielast::fem {

// Decompositions of small dense matrices, which stand in one translation unit because their templates take
// the compiler half a minute wherever they are used; and vectors to start from.

/// A = vectors diag(values) vectors^T, values ascending, vectors orthonormal.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
/// Of a symmetric matrix, of which the lower triangle is read.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

/// A = U T U^H, T upper triangular, U unitary.
struct ComplexSchur {
  Eigen::MatrixXcd T, U;
};
ComplexSchur complex_schur(const Eigen::MatrixXcd& A);

/// A = U diag(values) V^T, values descending; as many as A has rows or columns, whichever are fewer.
struct SingularValues {
  Eigen::MatrixXd U;
  Eigen::VectorXd values;
  Eigen::MatrixXd V;
};
SingularValues singular_values(const Eigen::MatrixXd& A);

/// Lower triangular L with L L^T = A, A positive definite.
Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& A);

/// The x with the least |A x - b|, by columns.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);

void append_columns(Eigen::MatrixXd& matrix, const Eigen::MatrixXd& columns);

/// `count` columns of entries between -1/2 and 1/2, the same ones in every run.
Eigen::MatrixXd random_vectors(Eigen::Index rows, Eigen::Index count);

/// A^-1 b.
Eigen::MatrixXcd solve_dense(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& b);

} // namespace dielast::fem
