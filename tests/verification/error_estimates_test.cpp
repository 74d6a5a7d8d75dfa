// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/verification/error_estimate_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>

// Printed errors against solutions with elements and time steps four times smaller.

namespace dielast::test::error_estimates_test {
namespace {

/// That so many values have an estimate, and so large a part of them a true error below it.
void expect_to_hold(const std::vector<EstimatedCase>& cases, std::size_t values, double part) {
  EstimateCount count;
  for (const EstimatedCase& one : cases) add_estimates(one, count);
  EXPECT_GE(count.values.size(), values) << exceptions(count);
  EXPECT_GE(share(count.values), part) << exceptions(count);
  EXPECT_LE(median_ratio(count.values), 10) << "too large to be of use";
}

TEST(ErrorEstimates, HoldInEightCases) { expect_to_hold(quick_estimated_cases(), 60, 0.95); }

// The edges of hole and electrode have six sides with larger elements, too, which do not tell what that does;
// those of the last two with elements half as large, too.
TEST(ErrorEstimates, HoldWhereEdgesHaveFewSides) {
  for (const EstimatedCase& one :
       {EstimatedCase{"annulus", {"mesh.rings=6"}},
        EstimatedCase{"disc", {"mesh.rings=4", "disc.electrode_radius=25 mm"}},
        EstimatedCase{"annulus", {"mesh.rings=4", "annulus.inner_radius=6 mm"}, 8},
        EstimatedCase{"disc", {"mesh.rings=6", "disc.electrode_radius=9 mm", "drive.voltage=100 V"}, 8}}) {
    EstimateCount count;
    add_estimates(one, count);
    EXPECT_EQ(share(count.values), 1) << exceptions(count);
    EXPECT_GE(count.values.size(), 5u);
  }
}

// All discretisations stop at the corners of the wave, between which the stretch goes with its square.
TEST(ErrorEstimates, OfAMeanHoldWhatLiesBetweenTheStates) {
  for (const char* increments : {"step.waves.increments=20", "step.waves.increments=80"}) {
    EstimateCount count;
    add_estimates({"waved_patch", {increments}, 16}, count);
    const auto mean = std::ranges::find(count.values, "mean_stretch", &EstimatedValue::quantity);
    ASSERT_NE(mean, count.values.end());
    EXPECT_TRUE(mean->holds()) << exceptions(count);
    EXPECT_LT(mean->printed, 6 * mean->error());
  }
}

// No element resolves the layer along the rim, whose bending lowers the film by 3e-4.
TEST(ErrorEstimates, HoldWhatTheEdgeLayerOfAShellChanges) { expect_to_hold({{"shell_disc", {}, 4}}, 3, 1); }

// Elements half as large are compared with where there are none that are larger.
TEST(ErrorEstimates, HoldOnTheCoarsestMeshOfAShell) { expect_to_hold({{"unimorph", {}, 4}}, 5, 0.9); }

// All discretisations have the same barrier.
TEST(ErrorEstimates, HoldWhatTheBarrierOfContactChanges) {
  expect_to_hold({{"slab_on_table", {}, 2}}, 10, 0.95);
}

// Elements that would divide the edge otherwise would be too many.
TEST(ErrorEstimates, AreNoneWhereNoMeshTellsWhatFewSidesChange) {
  EstimateCount count;
  add_estimates({"disc", {"mesh.rings=40", "disc.electrode_radius=1 mm", "drive.voltage=100 V"}, 1}, count);
  EXPECT_NE(exceptions(count).find("as few sides with other elements"), std::string::npos);
}

} // namespace
} // namespace dielast::test::error_estimates_test
