// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/dual.hpp"

#include <gtest/gtest.h>

namespace dielast::materials::dual_test {
namespace {

using Dual2 = Dual<2>;

void expect_dual(const Dual2& actual, double value, const Eigen::Vector2d& gradient,
                 const Eigen::Matrix2d& hessian) {
  EXPECT_DOUBLE_EQ(actual.value, value);
  EXPECT_LT((actual.gradient - gradient).norm(), 1e-14 * (1 + gradient.norm()));
  EXPECT_LT((actual.hessian - hessian).norm(), 1e-14 * (1 + hessian.norm()));
}

Eigen::Matrix2d symmetric(double xx, double xy, double yy) {
  return (Eigen::Matrix2d() << xx, xy, xy, yy).finished();
}

class DualTest : public testing::Test {
 protected:
  const double a = 1.7, b = -0.6;
  const Dual2 x = Dual2::variable(a, 0), y = Dual2::variable(b, 1);
};

TEST_F(DualTest, constants_and_variables) {
  expect_dual(Dual2(3.0), 3, {0, 0}, Eigen::Matrix2d::Zero());
  expect_dual(y, b, {0, 1}, Eigen::Matrix2d::Zero());
  expect_dual(2.0 - x, 2 - a, {-1, 0}, Eigen::Matrix2d::Zero());
}

TEST_F(DualTest, products_and_quotients) {
  expect_dual(x * x * y, a * a * b, {2 * a * b, a * a}, symmetric(2 * b, 2 * a, 0));
  expect_dual(y / x, b / a, {-b / (a * a), 1 / a}, symmetric(2 * b / (a * a * a), -1 / (a * a), 0));
  Dual2 sum = x;
  sum += x * y;
  expect_dual(sum, a + a * b, {1 + b, a}, symmetric(0, 1, 0));
}

TEST_F(DualTest, functions_of_a_product) {
  const double p = a * a; // of x * x
  expect_dual(sqrt(x * x), a, {1, 0}, Eigen::Matrix2d::Zero());
  expect_dual(log(x * x), std::log(p), {2 / a, 0}, symmetric(-2 / p, 0, 0));
  expect_dual(log1p(x), std::log1p(a), {1 / (1 + a), 0}, symmetric(-1 / ((1 + a) * (1 + a)), 0, 0));
  const double s = std::sin(a * b), c = std::cos(a * b);
  expect_dual(sin(x * y), s, {b * c, a * c}, symmetric(-b * b * s, c - a * b * s, -a * a * s));
  expect_dual(cos(x * y), c, {-b * s, -a * s}, symmetric(-b * b * c, -s - a * b * c, -a * a * c));
}

} // namespace
} // namespace dielast::materials::dual_test
