// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/verification/error_estimate_cases.hpp"

#include <gtest/gtest.h>

// Printed errors against solutions with elements and time steps four times smaller.

namespace dielast::test::error_estimates_test {
namespace {

TEST(ErrorEstimates, HoldInEightCases) {
  EstimateCount count;
  for (const EstimatedCase& one : quick_estimated_cases()) add_estimates(one, count);
  EXPECT_GE(count.values.size(), 60u) << exceptions(count);
  EXPECT_GE(share(count.values), 0.95) << exceptions(count);
  EXPECT_LE(median_ratio(count.values), 10) << "too large to be of use";
}

} // namespace
} // namespace dielast::test::error_estimates_test
