// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/orientation.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::orientation_test {
namespace {

Eigen::MatrixXd orthonormal(std::mt19937& random, Eigen::Index rows, Eigen::Index columns) {
  const Eigen::MatrixXd drawn =
      Eigen::MatrixXd::NullaryExpr(rows, rows, [&] { return std::normal_distribution()(random); });
  return symmetric_eigen(drawn + drawn.transpose()).vectors.leftCols(columns);
}

TEST(Orientation, depends_on_what_the_twins_span_alone) {
  std::mt19937 random(5);
  for (const Eigen::Index k : {1, 2, 3, 6}) {
    const Eigen::MatrixXd span = orthonormal(random, 20, k);
    const Eigen::VectorXd weight = Eigen::VectorXd::Ones(20);
    Eigen::MatrixXd first = span;
    orient_twins(first, weight);
    EXPECT_LT((first * first.transpose() - span * span.transpose()).norm(), 1e-13);
    for (int trial = 0; trial < 20; ++trial) {
      Eigen::MatrixXd other = span * orthonormal(random, k, k);
      orient_twins(other, weight);
      EXPECT_LT((other - first).norm(), 1e-12) << k;
    }
  }
}

TEST(Orientation, of_equal_peaks_the_first_is_positive_whatever_rounding_makes_of_them) {
  for (const double other : {-1 - 1e-9, -1 + 1e-9, -1.5})
    for (const double sign : {1.0, -1.0}) {
      Eigen::MatrixXd mode = sign * Eigen::Vector4d(0.5, 1, other, 0);
      orient_twins(mode, Eigen::Vector4d::Ones());
      EXPECT_EQ(mode(1), 1);
    }
}

TEST(Orientation, asks_rows_by_their_weight) {
  Eigen::MatrixXd mode = Eigen::Vector3d(5, -0.1, 1);
  orient_twins(mode, Eigen::Vector3d(0, 1, 0.15));
  EXPECT_EQ(mode(0), -5);
}

TEST(Orientation, turns_only_vectors_whose_eigenvalues_coincide) {
  std::mt19937 random(6);
  const Eigen::MatrixXd drawn = orthonormal(random, 12, 4);
  const Eigen::VectorXd weight = Eigen::VectorXd::Ones(12);
  Eigen::MatrixXd vectors = drawn;
  Eigen::VectorXd eigenvalues = Eigen::Vector4d(-2e-14, 1e-14, 1, 1 + 1e-5);
  orient(vectors, eigenvalues, 1e-13, weight);
  Eigen::MatrixXd twins = drawn.leftCols(2);
  orient_twins(twins, weight);
  EXPECT_EQ(vectors.leftCols(2), twins);
  EXPECT_EQ(eigenvalues[0], eigenvalues[1]);
  for (const int i : {2, 3}) EXPECT_EQ(vectors.col(i).cwiseAbs(), drawn.col(i).cwiseAbs());
}

} // namespace
} // namespace dielast::fem::orientation_test
