// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/profile.hpp"

#include "meshing/meridian.hpp"
#include "tests/post/samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace dielast::post::profile_test {
namespace {

TEST(Profile, IsACurvePerStateInMillimetres) {
  const meshing::Mesh mesh = meshing::disc_meridian(30e-3, 10e-3, 3, 2);
  std::vector<Eigen::Vector3d> sunk = mesh.nodes;
  for (auto& x : sunk) x.z() = x.x() - 30e-3;
  const Plot plot = profile_plot(mesh, "Shape", {{"before", mesh.nodes, {}}, {"after", sunk, {}}});
  EXPECT_EQ(plot.title, "Shape");
  ASSERT_EQ(plot.series.size(), 2u);
  EXPECT_EQ(plot.series[0].label, "before");
  EXPECT_EQ(plot.series[1].label, "after");
  const std::vector<double> r{30, 25, 20, 15, 10, 5, 0}; // middle nodes between the corners
  ASSERT_EQ(plot.series[1].x.size(), r.size());
  for (std::size_t i = 0; i < r.size(); ++i) {
    EXPECT_NEAR(plot.series[0].x[i], r[i], 1e-12);
    EXPECT_EQ(plot.series[0].y[i], 0);
    EXPECT_NEAR(plot.series[1].y[i], r[i] - 30, 1e-12);
  }
  EXPECT_TRUE(plot.equal_axes);
  EXPECT_FALSE(profile_plot(mesh, "", {{"flat", mesh.nodes, {}}}).equal_axes);
}

// Rounding along z, or a bar along the axis, would fill the picture.
TEST(Profile, OfALineHasAxesThatShowIt) {
  meshing::Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {20e-3, 0, 1e-12}};
  mesh.blocks = {{meshing::CellType::meridian2, {0, 1}}};
  const auto least = [&mesh] { return profile_plot(mesh, "", {{"", mesh.nodes, {}}}).least_extent; };
  EXPECT_NEAR(least(), 2, 1e-9); // mm
  mesh.nodes[1] = {0, 0, 20e-3};
  EXPECT_NEAR(least(), 2, 1e-9);
  mesh.nodes[1] = {20e-3, 0, 1e-3};
  EXPECT_EQ(least(), 0);
}

TEST(Profile, LeavesAGapBetweenSeparatePieces) {
  meshing::Mesh mesh;
  mesh.nodes = {{4, 0, 0}, {3, 0, 0}, {2, 0, 0}, {1, 0, 0}};
  mesh.blocks = {{meshing::CellType::meridian2, {0, 1, 2, 3}}};
  const Series curve = profile_plot(mesh, "", {{"", mesh.nodes, {}}}).series.at(0);
  ASSERT_EQ(curve.x.size(), 5u);
  EXPECT_TRUE(std::isnan(curve.x[2]) && std::isnan(curve.y[2]));
  EXPECT_EQ(curve.x[3], 2000);
}

TEST(Profile, RejectsWhatHasNone) {
  EXPECT_THROW(profile_plot(square_mesh(), "", {}), std::invalid_argument);
  EXPECT_THROW(profile_plot(meshing::balloon_meridian(1, 4, 1), "", {{"", {{0, 0, 0}}, {}}}),
               std::invalid_argument);
}

} // namespace
} // namespace dielast::post::profile_test
