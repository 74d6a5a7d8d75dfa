// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/symmetric_solver.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "tests/fem/sample_matrices.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace dielast::fem::symmetric_solver_test {
namespace {

Workers one_thread(1);

/// The lower triangle of a dense matrix without its zeros, the diagonal kept.
SparseSymmetric sparse(const Eigen::MatrixXd& full) {
  SparseSymmetric matrix{
      .size = static_cast<int>(full.rows()), .column_start = {0}, .rows = {}, .values = {}};
  for (int c = 0; c < matrix.size; ++c) {
    for (int r = c; r < matrix.size; ++r)
      if (r == c || full(r, c) != 0) {
        matrix.rows.push_back(r);
        matrix.values.push_back(full(r, c));
      }
    matrix.column_start.push_back(static_cast<int>(matrix.rows.size()));
  }
  return matrix;
}

/// Random symmetric matrix with about four entries per row off the diagonal, plus `shift` on it.
Eigen::MatrixXd random_matrix(std::mt19937& random, int size, double shift) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(size, size);
  std::uniform_int_distribution<int> index(0, size - 1);
  for (int k = 0; k < 2 * size; ++k) {
    const int i = index(random), j = index(random);
    full(i, j) = full(j, i) = test::random_vector(random, 1)[0];
  }
  full.diagonal() = test::random_vector(random, size);
  full.diagonal().array() += shift;
  return full;
}

int negative_eigenvalues(const Eigen::MatrixXd& full) {
  return static_cast<int>((symmetric_eigen(full).values.array() < 0).count());
}

/// Chain of springs between `size` nodes, not held anywhere.
Eigen::MatrixXd free_chain(int size, double stiffness) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i + 1 < size; ++i)
    full.block<2, 2>(i, i) += stiffness * (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  return full;
}

TEST(SymmetricSolver, solves_and_tells_the_inertia_of_matrices_of_one_pattern) {
  std::mt19937 random(61);
  for (const int size : {1, 2, 7, 60, 200}) {
    const Eigen::MatrixXd pattern = random_matrix(random, size, 0);
    SparseSymmetric matrix = sparse(pattern);
    SymmetricSolver solver(matrix, one_thread);
    for (const double shift : {10.0, 0.0, -0.4, 0.7, -10.0, 10.0}) { // definite, indefinite, and back
      const Eigen::MatrixXd full = pattern + shift * Eigen::MatrixXd::Identity(size, size);
      std::ranges::copy(sparse(full).values, matrix.values.begin());
      ASSERT_TRUE(solver.factor());
      EXPECT_EQ(solver.negative_pivots(), negative_eigenvalues(full)) << size << " " << shift;
      const Eigen::VectorXd expected = test::random_vector(random, size);
      Eigen::VectorXd x;
      solver.solve(full * expected, x);
      const double condition = full.norm() * full.inverse().norm();
      EXPECT_LT((x - expected).norm(), 5e-15 * size * condition * expected.norm()) << size << " " << shift;
    }
  }
}

TEST(SymmetricSolver, saddle_points_have_as_many_negative_pivots_as_constraints) {
  std::mt19937 random(62);
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(40, 40); // zero diagonal below the first 30
  full.topLeftCorner(30, 30) = random_matrix(random, 30, 10);
  for (int i = 0; i < 10; ++i) full(30 + i, 3 * i) = full(3 * i, 30 + i) = 1;
  SparseSymmetric matrix = sparse(full);
  SymmetricSolver solver(matrix, one_thread);
  ASSERT_TRUE(solver.factor());
  EXPECT_EQ(solver.negative_pivots(), 10);
}

TEST(SymmetricSolver, refuses_singular_matrices) {
  for (const double stiffness : {1.0, 0.1, 1e5 / 3}) {
    const SparseSymmetric chain = sparse(free_chain(50, stiffness));
    SymmetricSolver solver(chain, one_thread);
    EXPECT_FALSE(solver.factor()) << "rigid mode, stiffness " << stiffness;
  }
  Eigen::MatrixXd full = free_chain(5, 1);
  full(0, 0) += 1;
  full.row(4).setZero();
  full.col(4).setZero();
  full(3, 3) = 1; // node 4 is attached to nothing
  const SparseSymmetric loose = sparse(full);
  SymmetricSolver solver(loose, one_thread);
  EXPECT_FALSE(solver.factor());
}

// A bar of springs whose last node hangs on nothing, or that has no support: one spring more makes it
// regular.
TEST(SymmetricSolver, tells_where_a_pivot_vanished_and_takes_a_stiffness_there) {
  Eigen::MatrixXd loose = free_chain(5, 1);
  loose(0, 0) += 1;
  loose.row(4).setZero();
  loose.col(4).setZero();
  loose(3, 3) = 1;
  for (const Eigen::MatrixXd& full : {free_chain(50, 0.1), loose, Eigen::MatrixXd(-free_chain(9, 2))}) {
    const SparseSymmetric matrix = sparse(full);
    SymmetricSolver solver(matrix, one_thread);
    ASSERT_FALSE(solver.factor());
    const int weakest = solver.singular_equation();
    ASSERT_GE(weakest, 0);
    ASSERT_LT(weakest, matrix.size);
    const Eigen::VectorXd spring = 3 * Eigen::VectorXd::Unit(matrix.size, weakest);
    ASSERT_TRUE(solver.factor(&spring));
    std::mt19937 random(63);
    const Eigen::VectorXd expected = test::random_vector(random, matrix.size);
    Eigen::VectorXd x;
    solver.solve(full * expected + spring.cwiseProduct(expected), x);
    EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm());
    EXPECT_FALSE(solver.factor()) << "the spring is gone again";
  }
}

// Where a matrix is not what it was said to be, the solution is right, or none.
TEST(SymmetricSolver, solves_what_only_seemed_positive_definite) {
  SparseSymmetric matrix = test::grid(200, 1); // large enough for a factor to be kept
  SymmetricSolver solver(matrix, one_thread);
  ASSERT_TRUE(solver.precondition(true));
  matrix.values[static_cast<std::size_t>(matrix.column_start[1234])] = -5;
  ASSERT_TRUE(solver.precondition(true));
  EXPECT_EQ(solver.work().factorisations, 1);
  std::mt19937 random(65);
  const Eigen::VectorXd expected = test::random_vector(random, matrix.size);
  Eigen::VectorXd x;
  solver.solve(test::times(matrix, expected), x);
  EXPECT_LT((x - expected).norm(), 1e-8 * expected.norm());
  EXPECT_EQ(solver.negative_pivots(), 1);
}

// A spring that pulls or pushes every node of a grid that nothing else holds: softer than what single
// precision rounds, it must be left to double precision.
TEST(SymmetricSolver, does_not_take_rounding_for_a_proof) {
  constexpr double held = 1e-3; // test::grid
  for (const double spring : {1e-4, 1e-9, -1e-9, -1e-4}) {
    SparseSymmetric matrix = test::grid(400, 1);
    for (int c = 0; c < matrix.size; ++c)
      matrix.values[static_cast<std::size_t>(matrix.column_start[static_cast<std::size_t>(c)])] +=
          spring - held;
    SymmetricSolver solver(matrix, one_thread);
    ASSERT_TRUE(solver.precondition(false));
    EXPECT_EQ(solver.negative_pivots() > 0, spring < 0) << spring;
  }
}

// The order in which a solver eliminates must not be drawn by lot.
TEST(SymmetricSolver, gives_the_same_bits_again_where_the_matrix_is_indefinite) {
  SparseSymmetric matrix = test::grid(60, 1);
  for (int c = 0; c < matrix.size; ++c)
    matrix.values[static_cast<std::size_t>(matrix.column_start[static_cast<std::size_t>(c)])] -= 0.5;
  std::mt19937 random(66);
  const Eigen::VectorXd b = test::random_vector(random, matrix.size);
  const auto solved = [&] {
    SymmetricSolver solver(matrix, one_thread);
    EXPECT_TRUE(solver.factor());
    EXPECT_GT(solver.negative_pivots(), 1);
    Eigen::VectorXd x;
    solver.solve(b, x);
    return x;
  };
  const Eigen::VectorXd first = solved();
  for (int again = 0; again < 4; ++again) EXPECT_EQ(solved(), first);
}

// Large enough for a factor in single precision to tell.
TEST(SymmetricSolver, proves_what_is_positive_definite_and_counts_what_is_not) {
  SparseSymmetric matrix = test::grid(400, 1);
  SymmetricSolver solver(matrix, one_thread);
  std::mt19937 random(66);
  const Eigen::VectorXd expected = test::random_vector(random, matrix.size);
  const auto solves = [&](double tolerance) {
    Eigen::VectorXd x;
    solver.solve(test::times(matrix, expected), x, tolerance);
    EXPECT_LT((x - expected).norm(), 10 * tolerance * expected.norm());
  };
  ASSERT_TRUE(solver.precondition(false));
  solves(1e-3);
  EXPECT_EQ(solver.negative_pivots(), 0);
  double& diagonal = matrix.values[static_cast<std::size_t>(matrix.column_start[1234])];
  const double before = diagonal;
  // Nearly singular, and next to it unstable: the double precision tells them apart.
  Eigen::VectorXd response;
  ASSERT_TRUE(solver.factor());
  solver.solve(Eigen::VectorXd::Unit(matrix.size, 1234), response);
  const double singular = before - 1 / response[1234];
  for (const int sign : {1, -1}) {
    diagonal = singular + sign * 1e-7 * before;
    ASSERT_TRUE(solver.precondition(false));
    EXPECT_EQ(solver.negative_pivots(), sign > 0 ? 0 : 1);
    solves(1e-6);
  }
}

} // namespace
} // namespace dielast::fem::symmetric_solver_test
