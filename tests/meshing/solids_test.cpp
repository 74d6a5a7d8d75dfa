// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/gmsh_reader.hpp"
#include "meshing/gmsh/gmsh_text.hpp"
#include "meshing/gmsh/refine.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/quality.hpp"
#include "meshing/solids/grid.hpp"
#include "meshing/solids/sides.hpp"
#include "meshing/solids/slab.hpp"
#include "tests/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>

namespace dielast::meshing::solids_test {
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

/// Its tetrahedra fill it and fit each other: their outer sides are those of the block.
TEST(Block, IsFilledByTetrahedraThatFit) {
  const Mesh mesh = block_mesh({{4, 0.6, 0, {1, 3}, 0.1}, 3, 2}, 3, 4);
  const QualityReport report = quality(mesh);
  EXPECT_EQ(report.inverted, 0);
  EXPECT_EQ(report.tetrahedra, mesh.film()->size());
  EXPECT_NEAR(report.volume, 4 * 0.6 * 3, 1e-12);
  EXPECT_GT(report.smallest_angle, 5);
  std::map<int, int> tetrahedra; // at each node
  for (const int node : mesh.blocks[0].nodes) ++tetrahedra[node];
  EXPECT_EQ(static_cast<int>(tetrahedra.size()), mesh.node_count());
  double outside = 0;
  for (const OuterSide& side : outer_sides(mesh.blocks[0])) {
    const auto x = [&](std::size_t k) { return mesh.nodes[static_cast<std::size_t>(side.own[k])]; };
    const Eigen::Vector3d twice_area = (x(1) - x(0)).cross(x(2) - x(0));
    outside += twice_area.norm() / 2;
    const Eigen::Vector3d from_middle = x(3) - Eigen::Vector3d(2, 0.3, 0);
    EXPECT_GT(twice_area.dot(from_middle), 0);
    EXPECT_NEAR((x(3) - (x(0) + x(1)) / 2).norm(), 0, 1e-12);
  }
  EXPECT_NEAR(outside, 2 * (4 * 0.6 + 4 * 3 + 0.6 * 3), 1e-10);
  Mesh part = mesh;
  part.blocks = {subset(mesh.blocks[0], mesh.cell_sets.at("electrode").cells)};
  EXPECT_NEAR(quality(part).volume, 2 * 0.4 * 2, 1e-12);
  part.blocks = {subset(mesh.blocks[0], mesh.cell_sets.at("passive").cells)};
  EXPECT_NEAR(quality(part).volume, 4 * 0.6 * 3 - 2 * 0.4 * 2, 1e-12);
  for (const int n : mesh.node_sets.at("front")) EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(n)].z(), 1.5);
  for (const int n : mesh.node_sets.at("top")) EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(n)].y(), 0.6);
  EXPECT_FALSE(is_closed(faces_at(mesh, "top")));
  EXPECT_TRUE(is_closed(faces_at(mesh, "film")));
  EXPECT_THROW(block_mesh({{4, 0.6, 0, {1, 3}, 0.1}, 3, 3.1}, 3, 4), std::invalid_argument);
}

TEST(SphereEighth, HasItsVolumeAndIsEnclosed) {
  const Mesh mesh = sphere_eighth_mesh(10, 12, 3);
  const QualityReport report = quality(mesh);
  EXPECT_EQ(report.inverted, 0);
  EXPECT_NEAR(report.volume, std::numbers::pi / 6 * (1728 - 1000), 1e-2);
  for (const int n : mesh.node_sets.at("inner"))
    EXPECT_NEAR(mesh.nodes[static_cast<std::size_t>(n)].norm(), 10, 1e-12);
  for (const int n : mesh.node_sets.at("side_y")) EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(n)].y(), 0);
  const CellBlock inner = faces_at(mesh, "inner"); // their normals point away from the centre
  for (int c = 0; c < inner.size(); ++c) {
    const auto x = [&](std::size_t k) { return mesh.nodes[static_cast<std::size_t>(inner.cell(c)[k])]; };
    EXPECT_GT((x(1) - x(0)).cross(x(2) - x(0)).dot(x(0)), 0);
  }
}

TEST(Tetrahedra, ComeBackFromGmsh) {
  const Mesh mesh = block_mesh({{4, 0.6, 0, {1, 3}, 0.1}, 3, 2}, 2, 6);
  const test::ScratchFolder folder;
  const std::filesystem::path file = folder / "tetrahedra.msh";
  std::ofstream(file) << gmsh_text(mesh);
  const Mesh back = read_gmsh(file);
  EXPECT_EQ(back.film()->type, CellType::tetrahedron10);
  EXPECT_EQ(back.film()->size(), mesh.film()->size());
  EXPECT_EQ(quality(back).inverted, 0);
  EXPECT_NEAR(quality(back).volume, quality(mesh).volume, 1e-5);
  EXPECT_EQ(back.node_sets.at("top").size(), mesh.node_sets.at("top").size());
  EXPECT_EQ(back.cell_sets.at("electrode").cells.size(), mesh.cell_sets.at("electrode").cells.size());
}

/// A tetrahedron of four nodes, drawn inside out, with a named face: it gets middle nodes, and so does the
/// face, which stays whole when all is refined.
TEST(Tetrahedra, OfFourNodesGetMiddleNodesWithTheirFaces) {
  const test::ScratchFolder folder;
  const std::filesystem::path file = folder / "one_tetrahedron.msh";
  std::ofstream(file) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"base\"\n3 2 "
                         "\"film\"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 "
                         "1\n$EndNodes\n$Elements\n2\n1 2 2 1 1 1 2 3\n2 4 2 2 1 1 3 2 4\n$EndElements\n";
  const Mesh mesh = read_gmsh(file);
  EXPECT_EQ(mesh.node_count(), 10);
  EXPECT_EQ(mesh.node_sets.at("base").size(), 6U);
  EXPECT_NEAR(quality(mesh).volume, 1.0 / 6, 1e-12);
  const Mesh finer = refined(mesh);
  EXPECT_EQ(finer.cell_sets.at("film").cells.size(), 8U);
  EXPECT_EQ(finer.node_sets.at("base").size(), 15U);
  EXPECT_NEAR(quality(finer).volume, 1.0 / 6, 1e-12);
  EXPECT_EQ(quality(finer).inverted, 0);
}

/// Curved ones keep their curve when they are refined.
TEST(Tetrahedra, KeepTheirCurveWhenRefined) {
  const Mesh mesh = sphere_eighth_mesh(10, 12, 1);
  // Up to what the rule of degree 2 leaves of curved ones; with straight sides it would be 3 % off.
  EXPECT_NEAR(quality(refined(mesh)).volume, quality(mesh).volume, 2e-4 * quality(mesh).volume);
}

} // namespace
} // namespace dielast::meshing::solids_test
