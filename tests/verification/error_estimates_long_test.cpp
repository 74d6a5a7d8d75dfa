// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/verification/error_estimate_cases.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

// The table of docs/verification.md.

namespace dielast::test::error_estimates_long_test {
namespace {

TEST(ErrorEstimates, HoldInFortyCases) {
  EstimateCount count;
  for (const EstimatedCase& one : estimated_cases()) add_estimates(one, count);
  fmt::print("{}\n{}", table(count), exceptions(count));
  EXPECT_GE(count.values.size(), 200u);
  EXPECT_GE(share(count.values), 0.95);
}

} // namespace
} // namespace dielast::test::error_estimates_long_test
