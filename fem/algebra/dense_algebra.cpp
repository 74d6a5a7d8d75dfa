// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/dense_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <random>

namespace dielast::fem {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
  if (A.rows() == 0) return {}; // Eigen's solver would read beyond it
  return A.eigenvalues();
}

ComplexSchur complex_schur(const Eigen::MatrixXcd& A) {
  const Eigen::ComplexSchur<Eigen::MatrixXcd> schur(A);
  return {schur.matrixT(), schur.matrixU()};
}

SingularValues singular_values(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  return A.colPivHouseholderQr().solve(b);
}

Eigen::MatrixXcd solve_dense(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& b) {
  return A.partialPivLu().solve(b);
}

void append_columns(Eigen::MatrixXd& matrix, const Eigen::MatrixXd& columns) {
  matrix.conservativeResize(Eigen::NoChange, matrix.cols() + columns.cols());
  matrix.rightCols(columns.cols()) = columns;
}

Eigen::MatrixXd random_vectors(Eigen::Index rows, Eigen::Index count) {
  std::mt19937 random(1);
  Eigen::MatrixXd vectors(rows, count);
  for (double& entry : vectors.reshaped())
    entry = static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 0.5;
  return vectors;
}

} // namespace dielast::fem
