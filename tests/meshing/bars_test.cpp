// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/bars/bars.hpp"

#include <gtest/gtest.h>

namespace dielast::meshing::bars_test {
namespace {

TEST(Line, HasEqualElementsFromStartToEnd) {
  const Mesh mesh = line_mesh({1, 0, 0}, {1, 2, 0}, 4, 2);
  EXPECT_EQ(mesh.blocks[0].type, CellType::line3);
  EXPECT_EQ(mesh.cell_sets.at("line").cells, (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(mesh.node_sets.at("end")[0])], Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(mesh.blocks[0].cell(1)[2])], Eigen::Vector3d(1, 0.75, 0));
  EXPECT_EQ(rod_mesh({0, 0, 0}, {0, 0, 3}).blocks[0].type, CellType::rod2);
  EXPECT_THROW(line_mesh({1, 0, 0}, {1, 0, 0}, 4, 2), std::invalid_argument);
  EXPECT_THROW(line_mesh({1, 0, 0}, {2, 0, 0}, 0, 2), std::invalid_argument);
}

TEST(Rolls, HingeRibbonsAndRollsMeetWhereTheyShould) {
  const RollsShape shape{
      .roll_length = 20, .hinge_length = 1, .hinge_thickness = 0.2, .ribbon_length = 0.5, .arm = 0.3};
  const Mesh mesh = rolls_mesh(shape, 3, 2);
  const auto at = [&](const char* place, std::size_t k) {
    return mesh.nodes[static_cast<std::size_t>(mesh.node_sets.at(place).at(k))];
  };
  ASSERT_EQ(mesh.node_sets.at("joints").size(), 2u);
  EXPECT_NEAR((at("joints", 0) - Eigen::Vector3d(-0.6, 0.7, 0)).norm(), 0,
              1e-12); // 0.4 from the tip: 3, 4, 5
  EXPECT_NEAR((at("joints", 1) - Eigen::Vector3d(-0.6, -0.7, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((at("roots", 0) - Eigen::Vector3d(19.4, 0.7, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(mesh.node_sets.at("tip_ends").size(), 3u);
  EXPECT_EQ(mesh.cells_of("lower", mesh.film())->front(), 1);
  EXPECT_EQ(mesh.cells_of("upper_ribbon", mesh.walls())->size(), 3u);
  EXPECT_THROW(rolls_mesh({.ribbon_length = 1, .arm = 1}, 3, 2), std::invalid_argument);
}

} // namespace
} // namespace dielast::meshing::bars_test
