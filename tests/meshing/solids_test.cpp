// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/mesh_error.hpp"
#include "meshing/quality.hpp"
#include "meshing/solids/grid.hpp"
#include "meshing/solids/sides.hpp"
#include "meshing/solids/slab.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace dielast::meshing {
namespace {

TEST(GradedLine, IsFineWhereItIsAskedToBe) {
  const std::vector<double> line = graded_line({0, 4, 20, 24}, {4, 20}, 0.05, 0.5);
  EXPECT_TRUE(std::ranges::is_sorted(line));
  EXPECT_EQ(line.front(), 0);
  EXPECT_EQ(line.back(), 24);
  for (const double at : {4.0, 20.0}) {
    const auto place = std::ranges::find(line, at);
    ASSERT_NE(place, line.end());
    EXPECT_NEAR(*place - *(place - 1), 0.05, 0.02);
    EXPECT_NEAR(*(place + 1) - *place, 0.05, 0.02);
  }
  double longest = 0;
  for (std::size_t i = 1; i < line.size(); ++i) longest = std::max(longest, line[i] - line[i - 1]);
  EXPECT_NEAR(longest, 0.5, 0.05);
}

TEST(Slab, HasItsPlacesAndItsArea) {
  for (const bool upright : {false, true}) {
    const Mesh mesh = slab_mesh({24, 0.6, 3, {4, 20}, 0.05}, 12, 6, upright);
    const QualityReport report = quality(mesh);
    EXPECT_EQ(report.inverted, 0);
    EXPECT_NEAR(report.area, 24 * 0.6, 1e-10);
    EXPECT_GT(report.smallest_angle, 5);
    EXPECT_EQ(mesh.cell_sets.at("electrode").cells.size() + mesh.cell_sets.at("passive").cells.size(),
              mesh.cell_sets.at("film").cells.size());
    Mesh part = mesh;
    part.blocks = {subset(mesh.blocks[0], mesh.cell_sets.at("electrode").cells)};
    EXPECT_NEAR(quality(part).area, 16 * 0.5, 1e-10);
    for (const int n : mesh.node_sets.at("left")) EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(n)].x(), 3);
    for (const int n : mesh.node_sets.at("top"))
      EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(n)][upright ? 2 : 1], 0.6);
  }
  EXPECT_THROW(slab_mesh({24, 0.6, 0, {4, 25}, 0.05}, 12, 6, false), std::invalid_argument);
  EXPECT_THROW(slab_mesh({24, 0.6, 0, {4, 20}, 0.3}, 12, 6, false), std::invalid_argument);
}

TEST(HollowSphere, HasTheAreaOfItsHalfPlane) {
  const Mesh mesh = hollow_sphere_mesh(10, 12, 3);
  const QualityReport report = quality(mesh);
  EXPECT_EQ(report.inverted, 0);
  EXPECT_NEAR(report.area, std::numbers::pi / 2 * (144 - 100), 1e-3);
  EXPECT_THROW(hollow_sphere_mesh(12, 10, 3), std::invalid_argument);
}

/// From the south to the north around the hollow, so that what it encloses has a positive volume.
TEST(Sides, LeadAroundTheHollow) {
  const Mesh mesh = hollow_sphere_mesh(10, 12, 2);
  const CellBlock inner = sides_at(mesh, "inner", CellType::meridian3);
  EXPECT_EQ(static_cast<std::size_t>(2 * inner.size() + 1), mesh.node_sets.at("inner").size());
  for (int side = 0; side < inner.size(); ++side) {
    const auto nodes = inner.cell(side);
    EXPECT_LT(mesh.nodes[static_cast<std::size_t>(nodes[0])].z(),
              mesh.nodes[static_cast<std::size_t>(nodes[1])].z());
  }
  Mesh with_line = mesh;
  with_line.node_sets["nothing"] = {0};
  EXPECT_THROW(sides_at(with_line, "nothing", CellType::meridian3), MeshError);
  EXPECT_THROW(sides_at(with_line, "equator", CellType::meridian3), MeshError); // inside the wall
}

} // namespace
} // namespace dielast::meshing
