// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/meridian.hpp"

#include "meshing/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace dielast::meshing::meridian_test {
namespace {

using Eigen::Vector3d;

const Vector3d& only_node(const Mesh& mesh, const std::string& place) {
  EXPECT_EQ(mesh.node_sets.at(place).size(), 1u) << place;
  return mesh.nodes[static_cast<std::size_t>(mesh.node_sets.at(place).front())];
}

/// A chain of as many cells, each starting where the one before it ended, that uses every node.
void expect_chain(const Mesh& mesh, int cells, int order) {
  ASSERT_EQ(mesh.blocks.size(), 1u);
  const CellBlock& film = *mesh.film();
  EXPECT_EQ(film.type, order == 2 ? CellType::meridian3 : CellType::meridian2);
  ASSERT_EQ(film.size(), cells);
  EXPECT_EQ(mesh.node_count(), order * cells + 1);
  for (int c = 1; c < cells; ++c) EXPECT_EQ(film.cell(c)[0], film.cell(c - 1)[1]);
  EXPECT_EQ(mesh.cell_sets.at("film").cells.size(), static_cast<std::size_t>(cells));
  EXPECT_EQ(mesh.node_sets.at("film").size(), mesh.nodes.size());
}

double length(const Mesh& mesh, int cell) {
  const auto nodes = mesh.film()->cell(cell);
  return (mesh.nodes[static_cast<std::size_t>(nodes[1])] - mesh.nodes[static_cast<std::size_t>(nodes[0])])
      .norm();
}

TEST(Meridian, DiscRunsFromRimToCentreWithANodeOnTheElectrodesEdge) {
  for (const int order : {1, 2}) {
    const Mesh mesh = disc_meridian(30e-3, 11e-3, 12, order);
    const int inside = 4; // 12 x 11 / 30 = 4.4
    expect_chain(mesh, 12, order);
    EXPECT_EQ(only_node(mesh, "rim"), Vector3d(30e-3, 0, 0));
    EXPECT_EQ(only_node(mesh, "electrode_edge"), Vector3d(11e-3, 0, 0));
    EXPECT_EQ(only_node(mesh, "centre"), Vector3d(0, 0, 0));
    EXPECT_EQ(mesh.cell_sets.at("passive").cells.size(), 12u - inside);
    EXPECT_EQ(mesh.cell_sets.at("electrode").cells, (std::vector<int>{8, 9, 10, 11}));
    EXPECT_EQ(mesh.node_sets.at("electrode").size(), static_cast<std::size_t>(order * inside + 1));
    for (const int c : mesh.cell_sets.at("passive").cells)
      EXPECT_NEAR(length(mesh, c), 19e-3 / 8, 1e-16) << c;
    for (const int c : mesh.cell_sets.at("electrode").cells)
      EXPECT_NEAR(length(mesh, c), 11e-3 / 4, 1e-16) << c;
    for (int c = 0; c < 12; ++c) {
      const auto nodes = mesh.film()->cell(c);
      const auto x = [&](int k) { return mesh.nodes[static_cast<std::size_t>(nodes[k])].x(); };
      EXPECT_GT(x(0), x(1));
      if (order == 2) {
        EXPECT_NEAR(x(2), (x(0) + x(1)) / 2, 1e-17);
      }
    }
  }
}

TEST(Meridian, AnnulusIsFinerInside) {
  const Mesh mesh = annulus_meridian(6.35e-3, 34.29e-3, 20, 2, 5);
  expect_chain(mesh, 20, 2);
  EXPECT_EQ(only_node(mesh, "outer"), Vector3d(34.29e-3, 0, 0));
  EXPECT_EQ(only_node(mesh, "inner"), Vector3d(6.35e-3, 0, 0));
  EXPECT_NEAR(length(mesh, 0) / length(mesh, 19), 5, 1e-11);
  for (int c = 1; c < 20; ++c)
    EXPECT_NEAR(length(mesh, c - 1) / length(mesh, c), std::pow(5, 1.0 / 19), 1e-11) << c;
  const Mesh uniform = annulus_meridian(1, 2, 4, 1, 1);
  EXPECT_EQ(uniform.nodes,
            (std::vector<Vector3d>{{2, 0, 0}, {1.75, 0, 0}, {1.5, 0, 0}, {1.25, 0, 0}, {1, 0, 0}}));
  expect_chain(annulus_meridian(1, 2, 1, 2, 3), 1, 2);
}

TEST(Meridian, BalloonIsAHalfCircleOfEqualElements) {
  const Mesh mesh = balloon_meridian(20e-3, 7, 2);
  expect_chain(mesh, 8, 2);
  EXPECT_EQ(only_node(mesh, "south"), Vector3d(0, 0, -20e-3));
  EXPECT_EQ(only_node(mesh, "equator"), Vector3d(20e-3, 0, 0));
  EXPECT_EQ(only_node(mesh, "north"), Vector3d(0, 0, 20e-3));
  const double side = 40e-3 * std::sin(std::numbers::pi / 16);
  for (int c = 0; c < 8; ++c) {
    EXPECT_NEAR(length(mesh, c), side, 1e-16) << c;
    const auto nodes = mesh.film()->cell(c);
    const auto x = [&](int k) { return mesh.nodes[static_cast<std::size_t>(nodes[k])]; };
    EXPECT_NEAR((x(2) - x(0)).norm(), (x(2) - x(1)).norm(), 1e-16);
    EXPECT_NEAR(x(2).norm(), 20e-3, 1e-17); // on the circle
    const Vector3d t = x(1) - x(0);
    EXPECT_GT(Vector3d(t.z(), 0, -t.x()).dot(x(2)), 0); // the normal points out
  }
}

TEST(Meridian, QualityCountsThem) {
  const QualityReport report = quality(balloon_meridian(1, 8, 2));
  EXPECT_EQ(report.meridians, 8);
  EXPECT_EQ(report.triangles + report.lines + report.inverted, 0);
  EXPECT_EQ(report.smallest_angle, 0);
  EXPECT_EQ(format(report), "nodes      17\nmeridians  8\nlines      0\nsize       1000 x 0 x 2000 mm\n");
}

TEST(Meridian, ADiscMayBeAllElectrode) {
  const Mesh mesh = disc_meridian(1, 1, 10, 2);
  EXPECT_EQ(mesh.cell_sets.at("electrode").cells, mesh.cell_sets.at("film").cells);
  EXPECT_EQ(mesh.node_sets.at("electrode_edge"), mesh.node_sets.at("rim"));
  EXPECT_FALSE(mesh.node_sets.contains("passive"));
}

TEST(Meridian, RejectsWhatCannotBeDrawn) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(disc_meridian(1, 1.1, 10, 2), std::invalid_argument);
  EXPECT_THROW(disc_meridian(1, 0, 10, 2), std::invalid_argument);
  EXPECT_THROW(disc_meridian(infinity, 1, 10, 2), std::invalid_argument);
  EXPECT_THROW(disc_meridian(1, 0.5, 1, 2), std::invalid_argument);
  EXPECT_THROW(disc_meridian(1, 0.5, 10, 3), std::invalid_argument);
  EXPECT_THROW(annulus_meridian(2, 1, 10, 2, 1), std::invalid_argument);
  EXPECT_THROW(annulus_meridian(1, 2, 0, 2, 1), std::invalid_argument);
  EXPECT_THROW(annulus_meridian(1, 2, 10, 2, 0.5), std::invalid_argument);
  EXPECT_THROW(annulus_meridian(1, 2, 10, 2, infinity), std::invalid_argument);
  EXPECT_THROW(balloon_meridian(0, 10, 2), std::invalid_argument);
  EXPECT_THROW(balloon_meridian(infinity, 10, 2), std::invalid_argument);
  EXPECT_THROW(balloon_meridian(1, 0, 2), std::invalid_argument);
  EXPECT_THROW(balloon_meridian(1, 10, 0), std::invalid_argument);
}

TEST(Meridian, ARollHasItsElectrodeInTheMiddle) {
  const Mesh mesh = roll_meridian(0.06, 0.005, 0.04, 12, 2);
  EXPECT_EQ(mesh.film()->size(), 12);
  EXPECT_EQ(mesh.cell_sets.at("electrode").cells.size(), 8u);
  EXPECT_EQ(mesh.cell_sets.at("passive").cells.size(), 4u);
  const auto height = [&](int node) { return mesh.nodes[static_cast<std::size_t>(node)].z(); };
  EXPECT_EQ(height(mesh.node_sets.at("lower_end").front()), 0);
  EXPECT_EQ(height(mesh.node_sets.at("upper_end").front()), 0.06);
  const std::vector<int>& charged = mesh.node_sets.at("electrode");
  double low = 1, high = 0;
  for (const int node : charged) low = std::min(low, height(node)), high = std::max(high, height(node));
  EXPECT_NEAR(low, 0.01, 1e-15);
  EXPECT_NEAR(high, 0.05, 1e-15);
  EXPECT_FALSE(roll_meridian(0.06, 0.005, 0.06, 12, 1).cell_sets.contains("passive"));
  EXPECT_THROW(roll_meridian(0.06, 0.005, 0.07, 12, 1), std::invalid_argument);
}

} // namespace
} // namespace dielast::meshing::meridian_test
