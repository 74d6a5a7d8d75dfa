// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/middle_nodes.hpp"
#include "meshing/quality.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <utility>

namespace dielast::meshing::quality_test {
namespace {

/// A right-angled triangle with legs 3 mm and 4 mm, and one with 1 mm and 1 mm beside it.
Mesh two_triangles() {
  Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {3e-3, 0, 0}, {0, 4e-3, 0}, {5e-3, 0, 0}, {6e-3, 0, 0}, {5e-3, 1e-3, 0}};
  mesh.blocks = {{CellType::triangle3, {0, 1, 2, 3, 4, 5}}, {CellType::line2, {0, 1}}};
  return mesh;
}

void expect_known(const QualityReport& report) {
  EXPECT_EQ(report.triangles, 2);
  EXPECT_EQ(report.lines, 1);
  EXPECT_NEAR(report.smallest_angle, std::atan2(3, 4) * 180 / std::numbers::pi, 1e-12);
  EXPECT_EQ(report.worst_cell, 0);
  EXPECT_LT((report.worst_place - Eigen::Vector3d(1e-3, 4e-3 / 3, 0)).norm(), 1e-15);
  EXPECT_NEAR(report.largest_aspect, 5 / (2 * std::numbers::sqrt3 * 1), 1e-12);
  EXPECT_NEAR(report.smallest_area, 0.5e-6, 1e-18);
  EXPECT_NEAR(report.largest_area, 6e-6, 1e-18);
  EXPECT_NEAR(report.area, 6.5e-6, 1e-18);
  EXPECT_EQ(report.inverted, 0);
  EXPECT_EQ(report.angles, (std::array<int, 6>{0, 0, 0, 1, 1, 0}));
}

TEST(Quality, OfAKnownMesh) {
  Mesh mesh = two_triangles();
  expect_known(quality(mesh));
  add_middle_nodes(mesh);
  expect_known(quality(mesh));
  EXPECT_EQ(quality(mesh).nodes, 12);
}

TEST(Quality, FindsInvertedTriangles) {
  Mesh clockwise = two_triangles();
  std::swap(clockwise.blocks[0].nodes[0], clockwise.blocks[0].nodes[1]);
  EXPECT_EQ(quality(clockwise).inverted, 1);
  EXPECT_NEAR(quality(clockwise).smallest_area, -6e-6, 1e-18);

  Mesh folded = two_triangles();
  add_middle_nodes(folded);
  folded.nodes[folded.blocks[0].cell(1)[4]] -= Eigen::Vector3d(0.6e-3, 0.6e-3, 0); // past the opposite corner
  EXPECT_EQ(quality(folded).inverted, 1);
}

// Neither x, y nor the way round matter on a surface in space.
TEST(Quality, IsThatOfTrianglesInAnyPlane) {
  for (const auto& [u, v] : {std::pair<Eigen::Vector3d, Eigen::Vector3d>({1, 0, 0}, {0, 0, 1}),
                             {{0, 0, 1}, {1, 0, 0}},
                             {{0, 0.6, 0.8}, {0, -0.8, 0.6}},
                             {{0.6, 0, 0.8}, {0, 1, 0}}}) {
    Mesh mesh = two_triangles();
    for (Eigen::Vector3d& x : mesh.nodes) x = x.x() * u + x.y() * v;
    for (const bool middles : {false, true}) {
      if (middles) add_middle_nodes(mesh);
      const QualityReport report = quality(mesh);
      EXPECT_EQ(report.inverted, 0);
      EXPECT_NEAR(report.area, 6.5e-6, 1e-18);
      EXPECT_NEAR(report.smallest_angle, std::atan2(3, 4) * 180 / std::numbers::pi, 1e-12);
    }
  }
}

// The determinant is a quadratic form of the barycentric coordinates; a grid finds where it is negative.
TEST(Quality, FindsWhatFoldsBetweenItsIntegrationPoints) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> shift(-0.45, 0.45);
  int folded = 0;
  for (int i = 0; i < 2000; ++i) {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0}, {0.5, 0, 0.25}, {0.5, 0.5, 0.25}, {0, 0.5, 0}}, {}, {}, {}};
    for (std::size_t a = 3; a < 6; ++a)
      mesh.nodes[a] += Eigen::Vector3d(shift(generator), shift(generator), 0);
    for (std::size_t a = 3; a < 6; ++a)
      mesh.nodes[a].z() = mesh.nodes[a].x() / 2; // in a plane that is inclined
    const auto& x = mesh.nodes;
    double least = 1;
    constexpr int n = 40;
    for (int a = 0; a <= n; ++a)
      for (int b = 0; a + b <= n; ++b) {
        const double l1 = double(a) / n, l2 = double(b) / n, l0 = 1 - l1 - l2;
        const Eigen::Vector3d from = (4 * l0 - 1) * x[0] + 4 * l1 * x[3] + 4 * l2 * x[5];
        const Eigen::Vector3d along_1 = (4 * l1 - 1) * x[1] + 4 * l0 * x[3] + 4 * l2 * x[4] - from;
        const Eigen::Vector3d along_2 = (4 * l2 - 1) * x[2] + 4 * l1 * x[4] + 4 * l0 * x[5] - from;
        least = std::min(least, along_1.cross(along_2).z());
      }
    const std::vector<int> nodes{0, 1, 2, 3, 4, 5};
    const bool folds_there = folds(mesh, CellType::triangle6, nodes);
    folded += folds_there;
    if (std::abs(least) > 5e-3) { // what the grid is sure of
      EXPECT_EQ(folds_there, least < 0) << i << ' ' << least;
    }
  }
  EXPECT_GT(folded, 200);
  EXPECT_LT(folded, 1990);
  // Beside a quarter of a side there is a corner at which it folds, far from every integration point.
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.24, 0, 0}, {0.5, 0.5, 0}, {0, 0.5, 0}}, {}, {}, {}};
  const std::vector<int> nodes{0, 1, 2, 3, 4, 5};
  EXPECT_TRUE(folds(mesh, CellType::triangle6, nodes));
  mesh.nodes[3].x() = 0.26;
  EXPECT_FALSE(folds(mesh, CellType::triangle6, nodes));
}

TEST(Quality, FindsTetrahedraThatFoldAtACorner) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{CellType::tetrahedron4, {0, 1, 2, 3}}}, {}, {}};
  add_middle_nodes(mesh);
  const CellBlock& block = mesh.blocks.front();
  EXPECT_FALSE(folds(mesh, block.type, block.cell(0)));
  for (Eigen::Vector3d& x : mesh.nodes)
    if (x == Eigen::Vector3d(0.5, 0, 0)) x.x() = 0.24;
  EXPECT_TRUE(folds(mesh, block.type, block.cell(0)));
}

TEST(Quality, IntegratesCurvedSides) {
  Mesh mesh = two_triangles();
  add_middle_nodes(mesh);
  mesh.nodes[mesh.blocks[0].cell(1)[3]].y() -= 0.1e-3; // parabolic segment: 2/3 x chord x height
  EXPECT_NEAR(quality(mesh).smallest_area, 0.5e-6 + 2.0 / 3 * 1e-3 * 0.1e-3, 1e-18);
}

// Two squares side by side: joined, and with nodes of their own along the edge between them.
TEST(Quality, FindsWhereAFilmIsCut) {
  Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  mesh.blocks = {{CellType::triangle3, {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2}}};
  EXPECT_EQ(nodes_on_others(mesh, *mesh.film()), 0);
  mesh.nodes.insert(mesh.nodes.end(), {{1, 0, 0}, {1, 1, 1e-12}});
  mesh.blocks = {{CellType::triangle3, {0, 1, 2, 0, 2, 3, 6, 4, 5, 6, 5, 7}}};
  EXPECT_EQ(nodes_on_others(mesh, *mesh.film()), 2);
}

TEST(Quality, IsReadable) {
  EXPECT_EQ(format(quality(two_triangles())), "nodes      6\n"
                                              "triangles  2\n"
                                              "lines      1\n"
                                              "size       6 x 4 x 0 mm\n"
                                              "area       6.5 mm2 (triangles 0.5 .. 6 mm2)\n"
                                              "angle      36.87 deg at least, triangle 0 at (1, 1.333) mm\n"
                                              "aspect     1.44 at most (1 is equilateral)\n"
                                              "inverted   0\n"
                                              "smallest angles of the triangles:\n"
                                              "   0-10 deg       0\n"
                                              "  10-20 deg       0\n"
                                              "  20-30 deg       0\n"
                                              "  30-40 deg       1 #########################\n"
                                              "  40-50 deg       1 #########################\n"
                                              "  50-60 deg       0\n");
  EXPECT_EQ(format(quality(Mesh{})), "nodes      0\ntriangles  0\nlines      0\nsize       0 x 0 x 0 mm\n");
}

} // namespace
} // namespace dielast::meshing::quality_test
