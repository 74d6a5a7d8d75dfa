// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/patch.hpp"

#include "meshing/quality.hpp"

#include <gtest/gtest.h>

namespace dielast::meshing {
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

} // namespace
} // namespace dielast::meshing
