// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/dense_products.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <limits>

namespace dielast::fem::dense_products_test {
namespace {

template<class Real>
class DenseProducts : public testing::Test {
 protected:
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

  static constexpr Real rounding(int depth) { return 4 * Real(depth) * std::numeric_limits<Real>::epsilon(); }

  /// What is needed of a panel that factor_panel makes.
  static Matrix factored(Matrix panel, int threads) {
    Workers workers(threads);
    const auto width = static_cast<int>(panel.cols());
    EXPECT_TRUE(factor_panel(width, static_cast<int>(panel.rows()), panel.data(), workers));
    panel.topRows(width).template triangularView<Eigen::StrictlyUpper>().setZero();
    return panel;
  }
};

using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(DenseProducts, Precisions, );

// Sizes below, at and beyond those of tiles, of blocks of rows and columns, and of what is done at once.
TYPED_TEST(DenseProducts, squares_are_those_of_the_whole_matrix) {
  using Dense = typename TestFixture::Matrix;
  Workers workers(1), more(3);
  std::srand(5);
  for (const int size : {1, 3, 8, 16, 33, 96, 131, 600})
    for (const int depth : {1, 7, 32, 256, 300}) {
      const Dense A = Dense::Random(size + 5, depth), product = A.topRows(size) * A.topRows(size).transpose();
      Dense C = Dense::Constant(size + 2, size, 7), D = C;
      minus_square(size, depth, A.data(), size + 5, C.data(), size + 2, workers);
      minus_square(size, depth, A.data(), size + 5, D.data(), size + 2, more);
      double error = 0, other = 0;
      for (int j = 0; j < size; ++j)
        for (int i = j; i < size; ++i) {
          error = std::max<double>(error, std::abs(C(i, j) + product(i, j)));
          other = std::max<double>(other, std::abs(C(i, j) - D(i, j)));
        }
      EXPECT_LT(error, TestFixture::rounding(depth)) << size << " x " << depth;
      EXPECT_EQ(other, 0) << size << " x " << depth << ", three threads";
      EXPECT_TRUE((C.bottomRows(2).array() == 7).all()) << "nothing else is written";
    }
}

TYPED_TEST(DenseProducts, panels_are_those_of_the_factor) {
  using Dense = typename TestFixture::Matrix;
  std::srand(6);
  for (const int width : {1, 5, 32, 33, 70, 200})
    for (const int below : {0, 1, 17, 150, 400}) {
      const int height = width + below;
      const Dense root = Dense::Random(height, height) / height + Dense::Identity(height, height);
      const Dense whole = root * root.transpose();
      const Dense expected = Dense(whole.llt().matrixL()).leftCols(width);
      const Dense panel = TestFixture::factored(whole.leftCols(width), 1);
      EXPECT_LT((panel - expected).cwiseAbs().maxCoeff(), 10 * TestFixture::rounding(width))
          << width << " of " << height;
      EXPECT_EQ(panel, TestFixture::factored(whole.leftCols(width), 3)) << "three threads";
    }
}

TYPED_TEST(DenseProducts, what_is_not_positive_definite_is_told) {
  using Dense = typename TestFixture::Matrix;
  using Real = TypeParam;
  Workers workers(1);
  for (const Real diagonal : {Real(0), Real(-1), std::numeric_limits<Real>::quiet_NaN()})
    for (const int at : {0, 31, 40, 69}) {
      Dense panel = Dense::Identity(90, 70);
      panel(at, at) = diagonal;
      EXPECT_FALSE(factor_panel(70, 90, panel.data(), workers)) << at;
    }
}

} // namespace
} // namespace dielast::fem::dense_products_test
