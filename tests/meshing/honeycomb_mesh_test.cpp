// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/honeycomb_mesh.hpp"
#include "meshing/quality.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>

namespace dielast::meshing::honeycomb_mesh_test {
namespace {

constexpr double degree = std::numbers::pi / 180;

HoneycombShape printed(double angle = 150) { return {angle * degree, {7, 6, 7, 6, 7}, 8e-3}; }

double cell_area(double angle) {
  const double L = 8e-3;
  return 2 * L * std::sin(angle * degree) * (L - L * std::cos(angle * degree));
}

Eigen::Vector3d centroid(const Mesh& mesh, const std::string& place) {
  const std::vector<int>& nodes = mesh.node_sets.at(place);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int node : nodes) sum += mesh.nodes[node];
  return sum / static_cast<double>(nodes.size());
}

/// Sides of the film's triangles (sorted corners, middle node or -1) and how many triangles have them.
std::map<std::array<int, 3>, int> film_sides(const Mesh& mesh) {
  std::map<std::array<int, 3>, int> sides;
  for (int c = 0; c < mesh.blocks[0].size(); ++c) {
    const auto nodes = mesh.blocks[0].cell(c);
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(nodes[k], nodes[(k + 1) % 3]);
      ++sides[{a, b, nodes.size() == 6 ? nodes[3 + k] : -1}];
    }
  }
  return sides;
}

TEST(HoneycombMesh, EveryLineIsASideOfTheFilm) {
  for (const int order : {1, 2})
    for (const int elements : {1, 3, 8}) {
      const Mesh mesh = honeycomb_mesh(printed(), {order, elements, 2});
      auto sides = film_sides(mesh);
      const CellSet& boundary = mesh.cell_sets.at("boundary");
      const std::set<int> outer(boundary.cells.begin(), boundary.cells.end());
      const CellBlock& lines = mesh.blocks[1];
      EXPECT_EQ(lines.size(), static_cast<int>(honeycomb(printed()).walls.size()) * elements);
      for (int c = 0; c < lines.size(); ++c) {
        const auto line = lines.cell(c);
        const auto [a, b] = std::minmax(line[0], line[1]);
        const auto side = sides.find({a, b, order == 2 ? line[2] : -1});
        ASSERT_NE(side, sides.end());
        EXPECT_EQ(side->second, outer.contains(c) ? 1 : 2);
        sides.erase(side);
      }
      // Inside the cells the film is conforming too.
      EXPECT_TRUE(std::ranges::all_of(sides, [](const auto& side) { return side.second == 2; }));
    }
}

TEST(HoneycombMesh, CoversTheCellsAndUsesEveryNode) {
  for (const int order : {1, 2})
    for (const double angle : {70.0, 90.0, 150.0}) {
      const Mesh mesh = honeycomb_mesh(printed(angle), {order, 4, 1});
      const QualityReport report = quality(mesh);
      EXPECT_NEAR(report.area, 33 * cell_area(angle), 1e-12 * report.area);
      EXPECT_EQ(report.inverted, 0);
      EXPECT_EQ(mesh.node_sets.at("film").size(), mesh.nodes.size());
      EXPECT_EQ(mesh.cell_sets.at("film").cells.size(), static_cast<std::size_t>(mesh.blocks[0].size()));
    }
}

TEST(HoneycombMesh, NamesCellsAndWalls) {
  const Mesh mesh = honeycomb_mesh(printed(), {2, 4, 1});
  const Honeycomb lattice = honeycomb(printed());
  std::size_t triangles = 0;
  for (const auto& cell : lattice.cells) {
    const auto name = "cell[" + std::to_string(cell.column) + "," + std::to_string(cell.row) + "]";
    const CellSet& set = mesh.cell_sets.at(name);
    EXPECT_EQ(set.block, 0);
    triangles += set.cells.size();
    for (const int joint : cell.joints)
      EXPECT_TRUE(std::ranges::binary_search(mesh.node_sets.at(name), joint));
  }
  EXPECT_EQ(triangles, static_cast<std::size_t>(mesh.blocks[0].size()));
  for (std::size_t k = 0; k < lattice.walls.size(); ++k) {
    const std::string name = "wall[" + std::to_string(k) + "]";
    EXPECT_EQ(mesh.cell_sets.at(name).block, 1);
    EXPECT_EQ(mesh.cell_sets.at(name).cells.size(), 4u);
    EXPECT_EQ(mesh.node_sets.at(name).size(), 9u);
    for (const int joint : lattice.walls[k].joints)
      EXPECT_TRUE(std::ranges::binary_search(mesh.node_sets.at(name), joint));
  }
  EXPECT_FALSE(mesh.cell_sets.contains("wall[" + std::to_string(lattice.walls.size()) + "]"));
}

TEST(HoneycombMesh, NamesTheGauges) {
  for (const int order : {1, 2})
    for (const int elements : {4, 5}) {
      const Mesh mesh = honeycomb_mesh(printed(), {order, elements, 1});
      EXPECT_NEAR((centroid(mesh, "right_apex") - centroid(mesh, "left_apex")).x(), 81.57e-3, 5e-6);
      EXPECT_NEAR(centroid(mesh, "left_apex").y(), 24e-3, 1e-12);
      EXPECT_NEAR(centroid(mesh, "right_apex").y(), 24e-3, 1e-12);
      const double middle_column = 2 * 8e-3 * (1 - std::cos(150 * degree));
      const auto expect_at = [&](const char* place, double x, double y) {
        EXPECT_LT((centroid(mesh, place) - Eigen::Vector3d(x, y, 0)).norm(), 1e-12) << place;
        EXPECT_EQ(mesh.node_sets.at(place).size(), order == 1 && elements == 5 ? 2u : 1u) << place;
      };
      expect_at("corner_top", 0, 52e-3);
      expect_at("corner_bottom", 0, -4e-3);
      expect_at("top", middle_column, 52e-3);
      expect_at("bottom", middle_column, -4e-3);
      EXPECT_LT((centroid(mesh, "centre") - Eigen::Vector3d(middle_column, 24e-3, 0)).norm(),
                1.2e-3); // less than an element
    }
}

TEST(HoneycombMesh, TakesTheLowerApexOfAnEvenColumn) {
  const Mesh mesh = honeycomb_mesh({150 * degree, {2, 1}, 8e-3}, {1, 1, 1});
  EXPECT_NEAR(centroid(mesh, "left_apex").y(), 0, 1e-15);
  EXPECT_NEAR(centroid(mesh, "right_apex").y(), 4e-3, 1e-15);
}

TEST(HoneycombMesh, IsSoundAtEveryAngle) {
  for (const int elements : {2, 4})
    for (double angle = 60.5; angle <= 175; angle += 0.5) {
      const QualityReport report = quality(honeycomb_mesh({angle * degree, {2, 1}, 8e-3}, {1, elements, 1}));
      ASSERT_EQ(report.inverted, 0) << angle;
      ASSERT_NEAR(report.area, 3 * cell_area(angle), 1e-11 * report.area) << angle;
      // Sides are fixed: neither the gap between re-entrant apexes nor the sharp apexes of slender cells can
      // be divided further.
      const double gap = elements * (1 - 2 * std::cos(angle * degree)) / degree;
      const double apex = 180 - angle;
      EXPECT_GT(report.smallest_angle, std::min({18.0, 0.7 * gap, 0.9 * apex})) << angle << ' ' << elements;
    }
}

TEST(HoneycombMesh, HasWideAnglesWhereTheLatticeAllowsIt) {
  for (const double grading : {1.0, 2.0, 4.0})
    for (double angle = 66; angle <= 160; angle += 2)
      EXPECT_GT(quality(honeycomb_mesh(printed(angle), {1, 8, grading})).smallest_angle, 25)
          << angle << ' ' << grading;
}

TEST(HoneycombMesh, GrowsTrianglesInsideWhenGraded) {
  const QualityReport uniform = quality(honeycomb_mesh(printed(), {1, 8, 1}));
  const QualityReport graded = quality(honeycomb_mesh(printed(), {1, 8, 2}));
  EXPECT_LT(graded.triangles, 0.6 * uniform.triangles);
  EXPECT_GT(graded.largest_area, 1.5 * uniform.largest_area);
  const double equilateral = std::numbers::sqrt3 / 4 * 1e-6;
  EXPECT_NEAR(uniform.area / uniform.triangles, equilateral, 0.25 * equilateral);
}

TEST(HoneycombMesh, RepeatsTheSymmetricMeshOfOneCell) {
  const Mesh mesh = honeycomb_mesh(printed(), {1, 8, 2});
  const Honeycomb lattice = honeycomb(printed());
  using Point = std::pair<long, long>;
  const auto points = [&](const Honeycomb::Cell& cell, double sx, double sy) {
    const Eigen::Vector2d centre = (lattice.joints[cell.joints[0]] + lattice.joints[cell.joints[3]]) / 2;
    std::set<Point> result;
    for (const int node :
         mesh.node_sets.at("cell[" + std::to_string(cell.column) + "," + std::to_string(cell.row) + "]")) {
      const Eigen::Vector2d p = mesh.nodes[node].head<2>() - centre;
      result.emplace(std::lround(sx * p.x() * 1e8), std::lround(sy * p.y() * 1e8)); // to 10 nm
    }
    return result;
  };
  const std::set<Point> first = points(lattice.cells[0], 1, 1);
  EXPECT_EQ(first, points(lattice.cells[0], -1, 1));
  EXPECT_EQ(first, points(lattice.cells[0], 1, -1));
  for (const auto& cell : lattice.cells) EXPECT_EQ(first, points(cell, 1, 1));
}

TEST(HoneycombMesh, IsDeterministic) {
  const Mesh first = honeycomb_mesh(printed(), {2, 8, 1});
  const Mesh second = honeycomb_mesh(printed(), {2, 8, 1});
  EXPECT_EQ(first.nodes, second.nodes);
  EXPECT_EQ(first.blocks[0].nodes, second.blocks[0].nodes);
  EXPECT_GT(first.blocks[0].size(), 8000);
}

TEST(HoneycombMesh, RejectsDensitiesOutOfRange) {
  EXPECT_THROW(honeycomb_mesh(printed(), {3, 8, 1}), std::invalid_argument);
  EXPECT_THROW(honeycomb_mesh(printed(), {2, 0, 1}), std::invalid_argument);
  EXPECT_THROW(honeycomb_mesh(printed(), {2, 8, 0.5}), std::invalid_argument);
  EXPECT_THROW(honeycomb_mesh(printed(60), {2, 8, 1}), std::invalid_argument);
}

} // namespace
} // namespace dielast::meshing::honeycomb_mesh_test
