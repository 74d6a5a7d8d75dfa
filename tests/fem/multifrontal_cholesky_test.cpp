// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/multifrontal_cholesky.hpp"

#include "fem/algebra/panel.hpp"
#include "tests/fem/sample_matrices.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::multifrontal_cholesky_test {
namespace {

/// Sizes of one panel, of a few, of many.
class MultifrontalCholeskyOfSize : public testing::TestWithParam<int> {};

TEST_P(MultifrontalCholeskyOfSize, solves_with_the_rounding_of_its_precision) {
  const SparseSymmetric matrix = test::grid(GetParam(), 1);
  std::mt19937 random(2);
  const Eigen::VectorXd expected = test::random_vector(random, matrix.size),
                        b = test::times(matrix, expected);
  const Supernodes supernodes(matrix);
  Eigen::VectorXd x;
  Workers workers(1);
  MultifrontalCholesky<double> twice(supernodes, workers);
  ASSERT_TRUE(twice.factor(matrix.values));
  twice.solve(b, x);
  EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm());
  MultifrontalCholesky<float> single(supernodes, workers);
  ASSERT_TRUE(single.factor(matrix.values));
  single.solve(b, x);
  EXPECT_LT((x - expected).norm(), 1e-2 * expected.norm());
  EXPECT_GT((x - expected).norm(), 1e-9 * expected.norm());
}

// What earlier matrices have left in the workspace must not matter.
TEST_P(MultifrontalCholeskyOfSize, gives_the_same_bits_again) {
  const SparseSymmetric matrix = test::grid(GetParam(), 3), other = test::grid(GetParam(), 6);
  std::mt19937 random(4);
  const Eigen::VectorXd b = test::random_vector(random, matrix.size);
  const Supernodes supernodes(matrix);
  Workers workers(1);
  MultifrontalCholesky<double> cholesky(supernodes, workers);
  Eigen::VectorXd first, again;
  ASSERT_TRUE(cholesky.factor(matrix.values));
  cholesky.solve(b, first);
  ASSERT_TRUE(cholesky.factor(other.values));
  ASSERT_TRUE(cholesky.factor(matrix.values));
  cholesky.solve(b, again);
  EXPECT_EQ(first, again);
}

TEST_P(MultifrontalCholeskyOfSize, gives_the_same_bits_with_any_number_of_threads) {
  const SparseSymmetric matrix = test::grid(GetParam(), 9);
  std::mt19937 random(4);
  const Eigen::VectorXd b = test::random_vector(random, matrix.size);
  const auto solved = [&]<class Real>(int threads, Real) {
    const Supernodes supernodes(matrix, threads);
    Workers workers(threads);
    MultifrontalCholesky<Real> cholesky(supernodes, workers);
    EXPECT_TRUE(cholesky.factor(matrix.values));
    Eigen::VectorXd x;
    cholesky.solve(b, x);
    return x;
  };
  const Eigen::VectorXd expected = solved(1, 1.0), single = solved(1, 1.0F);
  for (const int threads : {2, 3, 4, 4}) {
    EXPECT_EQ(solved(threads, 1.0), expected) << threads;
    EXPECT_EQ(solved(threads, 1.0F), single) << threads;
  }
}

// Vector registers must not make sums depend on how memory is aligned, which no two runs share.
TEST(Panels, give_the_same_bits_wherever_they_lie_in_memory) {
  constexpr int width = 7, height = 59;
  std::mt19937 random(8);
  std::uniform_real_distribution<float> entry(0.1F, 1.0F);
  std::vector<float> panel(width * height), x(height);
  for (float& value : panel) value = entry(random);
  for (float& value : x) value = entry(random);
  for (int k = 0; k < width; ++k) panel[static_cast<std::size_t>(k * height + k)] = 5;
  const auto solved = [&](std::size_t offset) {
    std::vector<float> there(offset + panel.size()), right(offset + x.size());
    std::ranges::copy(panel, there.begin() + static_cast<std::ptrdiff_t>(offset));
    std::ranges::copy(x, right.begin() + static_cast<std::ptrdiff_t>(offset));
    const Panel<float> moved(there.data() + offset, width, height);
    moved.forward(Panel<float>::Vector(right.data() + offset, height));
    moved.backward(Panel<float>::Vector(right.data() + offset, height));
    return std::vector<float>(right.begin() + static_cast<std::ptrdiff_t>(offset), right.end());
  };
  for (std::size_t offset = 1; offset <= 16; ++offset) EXPECT_EQ(solved(offset), solved(0)) << offset;
}

TEST_P(MultifrontalCholeskyOfSize, tells_what_is_not_positive_definite_wherever_it_is) {
  const SparseSymmetric matrix = test::grid(GetParam(), 5);
  const Supernodes supernodes(matrix, 2);
  Workers workers(2);
  MultifrontalCholesky<double> cholesky(supernodes, workers);
  for (int node = 0; node < matrix.size; node += 1 + matrix.size / 7) {
    std::vector<double> entries = matrix.values;
    entries[static_cast<std::size_t>(matrix.column_start[static_cast<std::size_t>(node)])] = -1;
    EXPECT_FALSE(cholesky.factor(entries)) << node;
  }
  EXPECT_TRUE(cholesky.factor(matrix.values));
}

INSTANTIATE_TEST_SUITE_P(Grids, MultifrontalCholeskyOfSize, testing::Values(3, 8, 40, 250));

} // namespace
} // namespace dielast::fem::multifrontal_cholesky_test
