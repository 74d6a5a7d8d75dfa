// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/richardson.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace dielast::cases::richardson_test {
namespace {

/// exact + size^order, with a field that is as steep at its extreme as the error says.
Sampled sample(double size, double order, double rise = 0) { return {size, 7 + std::pow(size, order), rise}; }

// The series converge to 7 with errors of 1 at size 1.
TEST(ErrorEstimate, FollowsTheObservedOrder) {
  for (const double order : {0.6, 1.0, 1.5, 2.0}) {
    const std::vector<Sampled> others{sample(2, order), sample(4, order)};
    EXPECT_NEAR(*estimate_error(sample(1, order), others, {0.5, 2}, 0).error, 1.25, 1e-6) << order;
  }
}

TEST(ErrorEstimate, KnowsHowMuchLargerTheElementsAre) {
  const std::vector<Sampled> others{sample(2.5, 1.5), sample(5, 1.5)};
  EXPECT_NEAR(*estimate_error(sample(1, 1.5), others, {0.5, 2}, 0).error, 1.25, 1e-6);
}

// Faster than is believed: what the farther difference tells at the highest believed order is the larger.
TEST(ErrorEstimate, StaysAboveTheErrorWhereConvergenceIsFast) {
  const std::vector<Sampled> others{sample(2, 4), sample(4, 4)};
  const ErrorEstimate estimate = estimate_error(sample(1, 4), others, {1, 3}, 0);
  EXPECT_GT(*estimate.error, 1);
  EXPECT_LT(*estimate.error, 10);
}

TEST(ErrorEstimate, OfTwoSolutionsTakesTheLeastOrder) {
  const std::vector<Sampled> others{sample(2, 2)};
  EXPECT_NEAR(*estimate_error(sample(1, 2), others, {1, 2}, 0).error, 1.25 * 3, 1e-12);
}

// Otherwise two values that happen to be equal would have no error.
TEST(ErrorEstimate, IsNotFooledByACrossing) {
  const std::vector<Sampled> others{{2, 7}, {4, 9}};
  EXPECT_GE(*estimate_error({1, 7}, others, {1, 2}, 0).error, 1);
  const std::vector<Sampled> turning{{2, 6}, {4, 6.5}};
  EXPECT_GE(*estimate_error({1, 6.5}, turning, {1, 2}, 0).error, 0.5);
}

TEST(ErrorEstimate, FromAFinerSolutionIsNearlyTheDifference) {
  for (const double order : {1.0, 2.0}) {
    const std::vector<Sampled> others{sample(0.5, order)};
    const double error = *estimate_error(sample(1, order), others, {1, 2}, 0).error;
    EXPECT_GE(error, 1) << order;
    EXPECT_LE(error, 2) << order;
  }
}

// As next to a corner that neither this mesh nor the finer one resolves.
TEST(ErrorEstimate, FromAFinerAndACoarserSolutionIsTheLarger) {
  const std::vector<Sampled> others{{0.5, 7.1}, {2, 5}};
  EXPECT_NEAR(*estimate_error({1, 7}, others, {1, 1}, 0).error, 1.25 * 2, 1e-12);
  const std::vector<Sampled> slow{{0.5, 8}, {2, 6.9}};
  EXPECT_NEAR(*estimate_error({1, 7}, slow, {1, 1}, 0).error, 1.25 * 2, 1e-12);
}

TEST(ErrorEstimate, OfAnExtremeIsNoLessThanItsRise) {
  const std::vector<Sampled> others{{2, 7.01, 0.6}, {4, 7.03, 1.2}};
  EXPECT_EQ(*estimate_error({1, 7, 0.3}, others, {0.5, 1}, 1).error, 0.3);
}

TEST(ErrorEstimate, OfASingularExtremeIsNone) {
  // r^-1/2: every mesh sees 1.4 times more, and so much over one element.
  const std::vector<Sampled> grows{{2, 10 / std::sqrt(2), 3 / std::sqrt(2)}, {4, 5, 1.5}};
  const ErrorEstimate estimate = estimate_error({1, 10, 3}, grows, {0.5, 1}, 1);
  EXPECT_TRUE(estimate.singular);
  EXPECT_FALSE(estimate.error);
  EXPECT_EQ(estimate.remark, "grows as the mesh is refined: no converged value");
  // A minimum that rises, and a number that is no extreme, are not.
  EXPECT_TRUE(estimate_error({1, 10, 3}, grows, {0.5, 1}, -1).error);
  EXPECT_TRUE(estimate_error({1, 10, 0}, grows, {0.5, 1}, 0).error);
  const std::vector<Sampled> falls{{2, -10 / std::sqrt(2), 3 / std::sqrt(2)}, {4, -5, 1.5}};
  EXPECT_TRUE(estimate_error({1, -10, 3}, falls, {0.5, 1}, -1).singular);
  EXPECT_FALSE(estimate_error({1, -10, 3}, falls, {0.5, 1}, -1, 20).singular); // all of it is rounding
}

// A boundary layer is read the nearer to the boundary the smaller the elements are: first order.
TEST(ErrorEstimate, OfASteepExtremeIsGiven) {
  const std::vector<Sampled> others{{2, 8, 1}, {4, 6, 1.9}};
  const ErrorEstimate estimate = estimate_error({1, 9, 0.5}, others, {0.5, 1}, 1);
  EXPECT_FALSE(estimate.singular);
  EXPECT_GE(*estimate.error, 1);
}

TEST(ErrorEstimate, OfWhatIsNotKnownIsNone) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Sampled> none, nan{{2, unknown}}, half{{2, 8}, {4, unknown}};
  EXPECT_FALSE(estimate_error({1, 7}, none, {1, 2}, 0).error);
  EXPECT_FALSE(estimate_error({1, 7}, nan, {1, 2}, 0).error);
  EXPECT_FALSE(estimate_error({1, unknown}, half, {1, 2}, 0).error);
  EXPECT_NEAR(*estimate_error({1, 7}, half, {1, 2}, 0).error, 1.25, 1e-12);
}

} // namespace
} // namespace dielast::cases::richardson_test
