// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/mesh_error.hpp"
#include "meshing/quality.hpp"
#include "meshing/rings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace dielast::meshing::rings_test {
namespace {

constexpr double pi = std::numbers::pi;

double polygon_area(int sides, double radius) {
  return sides / 2.0 * radius * radius * std::sin(2 * pi / sides);
}

void expect_on_circle(const Mesh& mesh, const std::string& place, double radius, std::size_t count) {
  const auto& nodes = mesh.node_sets.at(place);
  EXPECT_EQ(nodes.size(), count) << place;
  for (const int node : nodes) EXPECT_NEAR(mesh.nodes[node].norm(), radius, 1e-15) << place;
}

TEST(Rings, HaveTheCountsOfTheHexagonalPattern) {
  for (const int n : {3, 21, 66}) {
    const Mesh linear = disc_mesh(30e-3, 10e-3, n, 1, false);
    EXPECT_EQ(linear.node_count(), 1 + 3 * n * (n + 1));
    EXPECT_EQ(linear.blocks[0].size(), 6 * n * n);
    EXPECT_NEAR(quality(linear).area, polygon_area(6 * n, 30e-3), 1e-15);
    EXPECT_EQ(disc_mesh(30e-3, 10e-3, n, 2, false).node_count(), 1 + 3 * 2 * n * (2 * n + 1));
  }
}

TEST(Rings, NumberNodesRingByRingAndMiddleNodesByTheirSides) {
  const Mesh mesh = disc_mesh(30, 10, 3, 2, false);
  const std::vector<Eigen::Vector3d>& x = mesh.nodes;
  for (int i = 1; i <= 3; ++i)
    for (int j = 0; j < 6 * i; ++j) {
      const double angle = 2 * pi * j / (6 * i);
      EXPECT_LT(
          (x[1 + 3 * i * (i - 1) + j] - 10 * i * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)).norm(),
          1e-13);
    }
  // Sides (0,1) (0,2) ... (0,6) (1,2) (1,6) (1,7) come first after the 37 corners.
  const std::vector<std::pair<int, int>> sides{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5},
                                               {0, 6}, {1, 2}, {1, 6}, {1, 7}};
  for (std::size_t k = 0; k < sides.size(); ++k)
    EXPECT_EQ(x[37 + k], (x[sides[k].first] + x[sides[k].second]) / 2);
  const auto first = mesh.blocks[0].cell(0);
  EXPECT_EQ(std::vector<int>(first.begin(), first.end()), (std::vector<int>{0, 1, 2, 37, 43, 38}));
}

TEST(Rings, PutARingOnTheElectrodesEdge) {
  const Mesh mesh = disc_mesh(30e-3, 11e-3, 12, 2, true);
  const int inside = 4; // 12 x 11 / 30 = 4.4
  expect_on_circle(mesh, "electrode_edge", 11e-3, 12 * inside);
  expect_on_circle(mesh, "rim", 30e-3, 12 * 12);
  expect_on_circle(mesh, "centre", 0, 1);
  EXPECT_EQ(mesh.cell_sets.at("electrode").cells.size(), 6u * inside * inside);
  EXPECT_EQ(mesh.cell_sets.at("passive").cells.size(), 6u * (144 - inside * inside));
  EXPECT_EQ(mesh.cell_sets.at("film").cells.size(), 6u * 144);
  for (const int node : mesh.node_sets.at("electrode")) EXPECT_LE(mesh.nodes[node].norm(), 11e-3 + 1e-15);
  for (const int node : mesh.node_sets.at("passive")) EXPECT_GE(mesh.nodes[node].norm(), 11e-3 * (1 - 1e-12));
  EXPECT_EQ(mesh.node_sets.at("film").size(), mesh.nodes.size());
}

TEST(Rings, CurvedSidesApproachTheCircle) {
  const double exact = pi * 0.03 * 0.03;
  EXPECT_NEAR(quality(disc_mesh(0.03, 0.01, 12, 2, true)).area, exact, 1e-6 * exact);
  EXPECT_GT(exact - quality(disc_mesh(0.03, 0.01, 12, 2, false)).area, 1e-3 * exact);
  EXPECT_EQ(disc_mesh(0.03, 0.01, 12, 1, true).nodes, disc_mesh(0.03, 0.01, 12, 1, false).nodes);
}

TEST(Rings, AnnulusOfTheDiaphragmStartsAtRingFive) {
  const Mesh mesh = annulus_mesh(6.35e-3, 34.29e-3, 22, 2, false);
  EXPECT_EQ(mesh.blocks[0].size(), 6 * (27 * 27 - 5 * 5));
  EXPECT_EQ(mesh.node_sets.at("inner").size(), 60u);
  EXPECT_EQ(mesh.node_sets.at("outer").size(), 12u * 27);
  EXPECT_GT(quality(mesh).smallest_angle, 40);
  const double area = polygon_area(6 * 27, 34.29e-3) - polygon_area(30, 6.35e-3);
  EXPECT_NEAR(quality(mesh).area, area, 1e-12 * area);
  expect_on_circle(annulus_mesh(6.35e-3, 34.29e-3, 22, 2, true), "inner", 6.35e-3, 60);
}

TEST(Rings, KeepTheirShapeForAnyProportion) {
  for (const bool curved : {false, true}) {
    for (const double ratio : {0.01, 0.05, 0.3, 0.8})
      for (const int rings : {2, 5, 20}) {
        EXPECT_EQ(quality(disc_mesh(1, ratio, rings, 2, curved)).inverted, 0) << ratio << ' ' << rings;
        const QualityReport annulus = quality(annulus_mesh(ratio, 1, rings, 2, curved));
        EXPECT_EQ(annulus.inverted, 0);
        if (ratio * rings > 1) {
          EXPECT_GT(annulus.smallest_angle, 30) << ratio << ' ' << rings;
        }
      }
    EXPECT_EQ(quality(annulus_mesh(0.999, 1, 1, 2, curved)).inverted, 0);
  }
}

TEST(Rings, ADiscMayBeAllElectrode) {
  const Mesh mesh = disc_mesh(1, 1, 6, 2, true);
  EXPECT_EQ(mesh.cell_sets.at("electrode").cells, mesh.cell_sets.at("film").cells);
  EXPECT_EQ(mesh.node_sets.at("electrode_edge"), mesh.node_sets.at("rim"));
  EXPECT_FALSE(mesh.node_sets.contains("passive"));
}

TEST(Rings, RejectWhatCannotBeDrawn) {
  EXPECT_THROW(disc_mesh(1, 1.1, 10, 2, true), std::invalid_argument);
  EXPECT_THROW(disc_mesh(1, 0, 10, 2, true), std::invalid_argument);
  EXPECT_THROW(disc_mesh(1, 0.5, 1, 2, true), std::invalid_argument);
  EXPECT_THROW(disc_mesh(1, 0.5, 10, 3, true), std::invalid_argument);
  EXPECT_THROW(annulus_mesh(2, 1, 10, 2, true), std::invalid_argument);
  EXPECT_THROW(annulus_mesh(1, 2, 0, 2, true), std::invalid_argument);
  EXPECT_THROW(annulus_mesh(1, 1 + 1e-9, 2, 2, true), std::invalid_argument);
  EXPECT_THROW(disc_mesh(1, 0.95, 2, 2, true), MeshError);
  EXPECT_NO_THROW(disc_mesh(1, 0.95, 3, 2, true));
}

} // namespace
} // namespace dielast::meshing::rings_test
