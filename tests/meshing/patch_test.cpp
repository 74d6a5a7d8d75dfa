// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/patch.hpp"

#include "meshing/quality.hpp"

#include <gtest/gtest.h>

#include <set>

#include <algorithm>

namespace dielast::meshing::patch_test {
namespace {

TEST(Patch, IsARectangleWithNamedSides) {
  const Mesh mesh = patch_mesh(0.02, 0.01);
  EXPECT_EQ(mesh.film()->size(), 2);
  EXPECT_EQ(quality(mesh).inverted, 0);
  const auto side = [&](const char* place, int axis, double at) {
    ASSERT_EQ(mesh.node_sets.at(place).size(), 2u) << place;
    for (const int n : mesh.node_sets.at(place))
      EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(n)][axis], at) << place;
  };
  side("left", 0, 0);
  side("right", 0, 0.02);
  side("bottom", 1, 0);
  side("top", 1, 0.01);
  EXPECT_EQ(mesh.cell_sets.at("film").cells, (std::vector{0, 1}));
  EXPECT_THROW(patch_mesh(0, 1), std::invalid_argument);
}

// Refined with its width alone, a short strip would keep its rows, and error estimates would see no error.
TEST(Strip, IsRefinedInEachOfItsPartsHoweverShort) {
  const auto rows = [](int across) {
    const Mesh mesh = strip_mesh(
        {.length = 0.005, .width = 0.06, .electrode_length = 0.003, .electrode_width = 0.05}, across, 1);
    std::set<double> heights;
    for (const Eigen::Vector3d& x : mesh.nodes) heights.insert(x.y());
    return static_cast<int>(heights.size()) - 1;
  };
  EXPECT_EQ(rows(4), 3);
  EXPECT_EQ(rows(8), 6);
  EXPECT_EQ(rows(16), 12);
}

TEST(Strip, HasNodesAlongItsElectrodeAndIsItsOwnMirrorImage) {
  const Mesh mesh =
      strip_mesh({.length = 0.012, .width = 0.013, .electrode_length = 0.008, .electrode_width = 0.01}, 6, 2);
  EXPECT_EQ(quality(mesh).inverted, 0);
  const auto box = [&](const char* place) {
    Eigen::AlignedBox3d found;
    for (const int n : mesh.node_sets.at(place)) found.extend(mesh.nodes[static_cast<std::size_t>(n)]);
    return found;
  };
  EXPECT_NEAR((box("electrode").min() - Eigen::Vector3d(-0.005, -0.010, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((box("electrode").max() - Eigen::Vector3d(0.005, -0.002, 0)).norm(), 0, 1e-15);
  EXPECT_EQ(box("upper_end").min().y(), 0);
  EXPECT_EQ(box("lower_end").max().y(), -0.012);
  EXPECT_EQ(box("left").max().x(), -0.0065);
  EXPECT_EQ(box("right").min().x(), 0.0065);
  EXPECT_EQ(mesh.cell_sets.at("film").cells.size(),
            mesh.cell_sets.at("electrode").cells.size() + mesh.cell_sets.at("passive").cells.size());
  for (const Eigen::Vector3d& x : mesh.nodes) {
    const Eigen::Vector3d mirror(-x.x(), x.y(), 0);
    EXPECT_TRUE(std::ranges::any_of(
        mesh.nodes, [&](const Eigen::Vector3d& other) { return (other - mirror).norm() < 1e-12; }));
  }
  EXPECT_FALSE(strip_mesh({0.012, 0.013, 0.012, 0.013}, 6, 1).cell_sets.contains("passive"));
  EXPECT_THROW(strip_mesh({0.012, 0.013, 0.012, 0.014}, 6, 1), std::invalid_argument);
  EXPECT_THROW(strip_mesh({0.012, 0.013, 0.012, 0.013}, 0, 1), std::invalid_argument);
}

} // namespace
} // namespace dielast::meshing::patch_test
