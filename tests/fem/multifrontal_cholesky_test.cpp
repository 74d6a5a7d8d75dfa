// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/multifrontal_cholesky.hpp"

#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem {
namespace {

/// Springs between the neighbours of a square grid of `side` nodes a side, each held by a weak one: entries
/// of 1 + noise.
SparseSymmetric grid(int side, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> stiffness(0.5, 1.5);
  SparseSymmetric matrix{.size = side * side, .column_start = {0}, .rows = {}, .values = {}};
  std::vector<double> diagonal(static_cast<std::size_t>(matrix.size), 1e-3);
  for (int node = 0; node < matrix.size; ++node) {
    matrix.rows.push_back(node);
    matrix.values.push_back(0);
    for (const int neighbour : {node + 1, node + side}) {
      if (neighbour >= matrix.size || (neighbour == node + 1 && neighbour % side == 0)) continue;
      const double spring = stiffness(random);
      matrix.rows.push_back(neighbour);
      matrix.values.push_back(-spring);
      diagonal[static_cast<std::size_t>(node)] += spring;
      diagonal[static_cast<std::size_t>(neighbour)] += spring;
    }
    matrix.column_start.push_back(static_cast<int>(matrix.rows.size()));
  }
  for (int node = 0; node < matrix.size; ++node)
    matrix.values[static_cast<std::size_t>(matrix.column_start[static_cast<std::size_t>(node)])] =
        diagonal[static_cast<std::size_t>(node)];
  return matrix;
}

Eigen::VectorXd times(const SparseSymmetric& matrix, const Eigen::VectorXd& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(matrix.size);
  for (int c = 0; c < matrix.size; ++c)
    for (int k = matrix.column_start[static_cast<std::size_t>(c)];
         k < matrix.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int r = matrix.rows[static_cast<std::size_t>(k)];
      y[r] += matrix.values[static_cast<std::size_t>(k)] * x[c];
      if (r != c) y[c] += matrix.values[static_cast<std::size_t>(k)] * x[r];
    }
  return y;
}

/// Sizes of one panel, of a few, of many.
class MultifrontalCholeskyOfSize : public testing::TestWithParam<int> {};

TEST_P(MultifrontalCholeskyOfSize, solves_with_the_rounding_of_its_precision) {
  const SparseSymmetric matrix = grid(GetParam(), 1);
  std::mt19937 random(2);
  const Eigen::VectorXd expected = test::random_vector(random, matrix.size), b = times(matrix, expected);
  const Supernodes supernodes(matrix);
  Eigen::VectorXd x;
  MultifrontalCholesky<double> twice(supernodes);
  ASSERT_TRUE(twice.factor(matrix.values));
  twice.solve(b, x);
  EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm());
  MultifrontalCholesky<float> single(supernodes);
  ASSERT_TRUE(single.factor(matrix.values));
  single.solve(b, x);
  EXPECT_LT((x - expected).norm(), 1e-2 * expected.norm());
  EXPECT_GT((x - expected).norm(), 1e-9 * expected.norm());
}

// What earlier matrices have left in the workspace must not matter.
TEST_P(MultifrontalCholeskyOfSize, gives_the_same_bits_again) {
  const SparseSymmetric matrix = grid(GetParam(), 3), other = grid(GetParam(), 6);
  std::mt19937 random(4);
  const Eigen::VectorXd b = test::random_vector(random, matrix.size);
  const Supernodes supernodes(matrix);
  MultifrontalCholesky<double> cholesky(supernodes);
  Eigen::VectorXd first, again;
  ASSERT_TRUE(cholesky.factor(matrix.values));
  cholesky.solve(b, first);
  ASSERT_TRUE(cholesky.factor(other.values));
  ASSERT_TRUE(cholesky.factor(matrix.values));
  cholesky.solve(b, again);
  EXPECT_EQ(first, again);
}

TEST_P(MultifrontalCholeskyOfSize, tells_what_is_not_positive_definite_wherever_it_is) {
  const SparseSymmetric matrix = grid(GetParam(), 5);
  const Supernodes supernodes(matrix);
  MultifrontalCholesky<double> cholesky(supernodes);
  for (int node = 0; node < matrix.size; node += 1 + matrix.size / 7) {
    std::vector<double> entries = matrix.values;
    entries[static_cast<std::size_t>(matrix.column_start[static_cast<std::size_t>(node)])] = -1;
    EXPECT_FALSE(cholesky.factor(entries)) << node;
  }
  EXPECT_TRUE(cholesky.factor(matrix.values));
}

INSTANTIATE_TEST_SUITE_P(Grids, MultifrontalCholeskyOfSize, testing::Values(3, 8, 40, 250));

} // namespace
} // namespace dielast::fem
