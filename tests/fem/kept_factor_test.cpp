// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/kept_factor.hpp"

#include "tests/fem/sample_matrices.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::fem::kept_factor_test {
namespace {

/// Matrices on the way from one to another of its pattern.
class Keeping : public testing::Test {
 protected:
  void go(double part) {
    for (std::size_t k = 0; k < matrix.values.size(); ++k)
      matrix.values[k] = first.values[k] + part * (last.values[k] - first.values[k]);
  }
  /// Error of a solution over the solution in the norm of the matrix; infinity where there is none.
  double error(double tolerance, double scale = 1) {
    std::mt19937 random(64);
    const Eigen::VectorXd expected = scale * test::random_vector(random, matrix.size);
    Eigen::VectorXd x;
    if (!kept.solve(test::times(matrix, expected), x, tolerance)) return INFINITY;
    const Eigen::VectorXd error = (x - expected) / scale, whole = expected / scale;
    return std::sqrt(error.dot(test::times(matrix, error)) / whole.dot(test::times(matrix, whole)));
  }

  const SparseSymmetric first = test::grid(60, 1), last = test::grid(60, 2);
  SparseSymmetric matrix = first;
  Supernodes supernodes{matrix};
  Workers workers{1};
  KeptFactor kept{matrix, supernodes, workers};
};

TEST_F(Keeping, one_factor_solves_with_matrices_close_by) {
  for (const double part : {0.0, 0.01, 0.02}) {
    go(part);
    ASSERT_TRUE(kept.prepare());
    EXPECT_LT(error(1e-3), 1e-3) << part;
    EXPECT_LT(error(1e-10), 1e-10) << part;
  }
  EXPECT_EQ(kept.factorisations(), 1);
}

TEST_F(Keeping, with_what_it_remembers_another_goes_on_in_the_same_bits) {
  ASSERT_TRUE(kept.prepare());
  EXPECT_LT(error(1e-3), 1e-3);
  go(0.05);
  ASSERT_TRUE(kept.prepare());
  EXPECT_LT(error(1e-3), 1e-3);
  KeptFactor other(matrix, supernodes, workers);
  other.recall(kept.memory());
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(matrix.size, -1, 1);
  for (const double part : {0.1, 0.5, 1.0}) {
    go(part);
    ASSERT_TRUE(kept.prepare() && other.prepare());
    Eigen::VectorXd x, y;
    ASSERT_TRUE(kept.solve(b, x, 1e-6) && other.solve(b, y, 1e-6));
    EXPECT_EQ(x, y) << part;
  }
  EXPECT_GT(other.factorisations(), 0);
}

TEST_F(Keeping, a_factor_of_a_matrix_far_away_is_replaced_on_the_way_to_the_solution) {
  ASSERT_TRUE(kept.prepare());
  EXPECT_LT(error(1e-3), 1e-3);
  go(1);
  ASSERT_TRUE(kept.prepare());
  EXPECT_EQ(kept.factorisations(), 1);
  EXPECT_LT(error(1e-10), 1e-10);
  EXPECT_EQ(kept.factorisations(), 2);
  ASSERT_TRUE(kept.prepare());
  EXPECT_EQ(kept.factorisations(), 3) << "matrices that change so fast are factored at once";
}

TEST_F(Keeping, a_factor_is_replaced_when_its_iterations_have_cost_as_much) {
  ASSERT_TRUE(kept.prepare());
  EXPECT_LT(error(1e-3), 1e-3);
  const int fresh = kept.solves();
  int solves = 0;
  go(0.1);
  for (int repeat = 0; kept.factorisations() == 1 && repeat < 50; ++repeat) {
    const int before = kept.solves();
    EXPECT_LT(error(1e-3), 1e-3);
    solves += kept.solves() - before - fresh;
    ASSERT_TRUE(kept.prepare());
  }
  EXPECT_EQ(kept.factorisations(), 2);
  EXPECT_GE(solves, KeptFactor::cost(supernodes));
  EXPECT_LT(solves, KeptFactor::cost(supernodes) + 2 * fresh);
}

TEST_F(Keeping, small_and_large_forces_are_in_the_range_of_single_precision) {
  ASSERT_TRUE(kept.prepare());
  for (const double scale : {1e-60, 1e-30, 1e30, 1e60}) EXPECT_LT(error(1e-8, scale), 1e-8) << scale;
  Eigen::VectorXd x;
  ASSERT_TRUE(kept.solve(Eigen::VectorXd::Zero(matrix.size), x, 1e-3));
  EXPECT_EQ(x.norm(), 0);
}

TEST_F(Keeping, an_indefinite_matrix_is_told) {
  ASSERT_TRUE(kept.prepare());
  matrix.values[static_cast<std::size_t>(matrix.column_start[1234])] = -5;
  EXPECT_EQ(error(1e-3), INFINITY);
  EXPECT_FALSE(kept.prepare());
}

// Columns in several blocks, of which each adds to rows of the others.
TEST(KeptFactor, gives_the_same_bits_with_any_number_of_threads) {
  const SparseSymmetric first = test::grid(150, 1);
  SparseSymmetric matrix = first;
  std::mt19937 random(5);
  const Eigen::VectorXd expected = test::random_vector(random, matrix.size);
  const auto solved = [&](int threads) {
    const Supernodes supernodes(matrix, threads);
    Workers workers(threads);
    matrix.values = first.values;
    KeptFactor kept(matrix, supernodes, workers);
    EXPECT_TRUE(kept.prepare());
    for (double& value : matrix.values) value *= 1.1;
    matrix.values[0] *= 1.1;
    Eigen::VectorXd x;
    EXPECT_TRUE(kept.solve(test::times(matrix, expected), x, 1e-10));
    return x;
  };
  const Eigen::VectorXd alone = solved(1);
  EXPECT_LT((alone - expected).norm(), 1e-7 * expected.norm());
  for (const int threads : {2, 3, 4}) EXPECT_EQ(solved(threads), alone) << threads;
}

// What a factor costs is counted: a grid of n x n has about n^3 operations and n^2 log n entries.
TEST(KeptFactor, costs_more_iterations_in_larger_matrices) {
  const auto cost = [](int side) { return KeptFactor::cost(Supernodes(test::grid(side, 1))); };
  EXPECT_LT(cost(10), KeptFactor::least_cost);
  EXPECT_GT(cost(200), KeptFactor::least_cost);
  EXPECT_GT(cost(200), 1.3 * cost(60));
}

} // namespace
} // namespace dielast::fem::kept_factor_test
