// SPDX-License-Identifier: GPL-3.0-or-later
// Film under a honeycomb's walls and beside them.
#include "meshing/honeycomb_mesh.hpp"
#include "meshing/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::meshing::wall_surroundings_test {
namespace {

constexpr double degree = std::numbers::pi / 180;

double area_of(const Mesh& mesh, const std::string& place) {
  const Mesh part{mesh.nodes, {subset(mesh.blocks[0], mesh.cell_sets.at(place).cells)}, {}, {}};
  return quality(part).area;
}

double cell_area(const HoneycombShape& shape, double inwards) {
  const auto corners = cell_corners(shape, inwards);
  double area = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto &a = corners.at(k), &b = corners.at((k + 1) % 6);
    area += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return area;
}

TEST(WallSurroundings, PartACellAtTheirDistances) {
  for (const double angle : {75, 90, 150})
    for (const WallSurroundings around : {WallSurroundings{0.8e-3, 0}, {0, 1e-3}, {0.8e-3, 0.6e-3}}) {
      const HoneycombShape shape{angle * degree, {2, 1, 2}, 8e-3};
      const Mesh mesh = honeycomb_mesh(shape, {2, 8, 3}, around);
      const double reach = around.width / 2 + around.gap, whole = cell_area(shape, 0);
      EXPECT_NEAR(area_of(mesh, "electrode"), 5 * cell_area(shape, reach), 1e-12) << angle;
      EXPECT_NEAR(area_of(mesh, "film"), 5 * whole, 1e-12) << angle;
      if (around.width > 0) {
        EXPECT_NEAR(area_of(mesh, "under_walls"), 5 * (whole - cell_area(shape, around.width / 2)), 1e-12);
      }
      EXPECT_EQ(mesh.cell_sets.contains("under_walls"), around.width > 0);
      EXPECT_EQ(quality(mesh).inverted, 0);
      EXPECT_GT(quality(mesh).smallest_angle, 8) << angle << " " << around.width << " " << around.gap;
    }
}

// A corner is as far from both of its sides.
TEST(WallSurroundings, CornersMoveInwardsWithTheirSides) {
  for (const double angle : {75, 90, 130, 150}) {
    const HoneycombShape shape{angle * degree, {1}, 8e-3};
    const auto drawn = cell_corners(shape, 0), moved = cell_corners(shape, 0.7e-3);
    const Honeycomb lattice = honeycomb(shape);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_LT(
          (lattice.joints[static_cast<std::size_t>(lattice.cells[0].joints.at(k))] - drawn.at(k)).norm(),
          1e-12);
      for (const std::size_t side : {k, (k + 5) % 6}) {
        const Eigen::Vector2d along = (drawn.at((side + 1) % 6) - drawn.at(side)).normalized();
        const Eigen::Vector2d from_side = moved.at(k) - drawn.at(side);
        EXPECT_NEAR(along.x() * from_side.y() - along.y() * from_side.x(), 0.7e-3, 1e-12)
            << angle << " " << k;
      }
    }
  }
}

TEST(WallSurroundings, AreNothingByDefault) {
  const HoneycombShape shape{150 * degree, {2, 1, 2}, 8e-3};
  const Mesh mesh = honeycomb_mesh(shape, {2, 4, 3});
  EXPECT_EQ(mesh.cell_sets.at("electrode").cells, mesh.cell_sets.at("film").cells);
}

// But near joints each node beside a wall has one of the wall's opposite to it.
TEST(WallSurroundings, NodesBesideAWallAreOppositeToItsOwn) {
  const HoneycombShape shape{150 * degree, {1}, 8e-3};
  const Mesh mesh = honeycomb_mesh(shape, {2, 8, 3}, {0.8e-3, 0});
  const auto& walls = mesh.node_sets.at("walls");
  int opposite = 0, others = 0;
  for (const int node : mesh.node_sets.at("under_walls")) {
    if (std::ranges::binary_search(walls, node)) continue;
    const auto& x = mesh.nodes[static_cast<std::size_t>(node)];
    const auto distance_to = [&](int wall) {
      return (mesh.nodes[static_cast<std::size_t>(wall)] - x).norm();
    };
    const double distance = distance_to(std::ranges::min(walls, {}, distance_to));
    (distance < 0.4e-3 * (1 + 1e-9) ? opposite : others)++;
  }
  EXPECT_GT(opposite, 6 * 14);
  EXPECT_LE(others, 6 * 4);
}

TEST(WallSurroundings, ThatFillACellAreRefused) {
  const HoneycombShape shape{150 * degree, {1}, 8e-3};
  EXPECT_THROW(honeycomb_mesh(shape, {2, 8, 3}, {0.8e-3, 4e-3}), std::invalid_argument);
  EXPECT_THROW(cell_corners(shape, 5e-3), std::invalid_argument);
}

} // namespace
} // namespace dielast::meshing::wall_surroundings_test
