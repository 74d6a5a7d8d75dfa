// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/gmsh_reader.hpp"
#include "meshing/gmsh/gmsh_text.hpp"
#include "meshing/honeycomb_mesh.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/parts/assembly.hpp"
#include "meshing/patch.hpp"
#include "meshing/rings.hpp"
#include "tests/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numbers>

namespace dielast::meshing {
namespace {

Mesh pair_of_patches(double gap) {
  Mesh whole = patch_mesh(2, 1), other = patch_mesh(1, 1);
  for (auto& x : other.nodes) x.x() += 2 + gap;
  append(whole, other, "b");
  return whole;
}

TEST(Assembly, PlacesOfAPartCarryItsName) {
  const Mesh whole = pair_of_patches(0);
  EXPECT_EQ(whole.node_count(), 8);
  ASSERT_EQ(whole.blocks.size(), 1u);
  EXPECT_EQ(whole.blocks[0].size(), 4);
  EXPECT_EQ(whole.cell_sets.at("b.film").cells, (std::vector{2, 3}));
  EXPECT_EQ(whole.node_sets.at("b"), (std::vector{4, 5, 6, 7}));
  EXPECT_EQ(whole.node_sets.at("b.left"), (std::vector{4, 7}));
  EXPECT_EQ(whole.node_sets.at("left"), (std::vector{0, 3}));
}

TEST(Assembly, WhatMeetsIsJoinedInBothPlacesAndCells) {
  Mesh whole = pair_of_patches(0);
  join(whole, "right", "b.left");
  EXPECT_EQ(whole.node_count(), 6);
  EXPECT_EQ(whole.node_sets.at("right"), whole.node_sets.at("b.left"));
  EXPECT_EQ(whole.blocks[0].cell(2)[0], 1);
  for (const int node : whole.blocks[0].nodes) EXPECT_LT(node, 6);
  for (const int node : whole.node_sets.at("b.right"))
    EXPECT_EQ(whole.nodes[static_cast<std::size_t>(node)].x(), 3);
}

TEST(Assembly, WhatDoesNotMeetIsSaid) {
  Mesh whole = pair_of_patches(1e-3);
  try {
    join(whole, "right", "b.left");
    FAIL();
  } catch (const MeshError& error) {
    EXPECT_NE(std::string(error.what()).find("is 0.001 m from the nearest of the other"), std::string::npos)
        << error.what();
  }
}

/// Two patches of half the height beside one: the node between them would hang free. The lower one alone is
/// as good as tied: its other node is beyond the end.
TEST(Assembly, ANodeBetweenTiedOnesIsSaid) {
  for (const double height : {1.0, 0.5}) {
    Mesh whole = patch_mesh(1, height);
    for (const char* name : {"b", "c"}) {
      Mesh other = patch_mesh(1, 0.5);
      for (auto& x : other.nodes) x += Eigen::Vector3d(1, name[0] == 'b' ? 0 : 0.5, 0);
      append(whole, other, name);
    }
    join(whole, "b.top", "c.bottom");
    std::vector<int>& both = whole.node_sets["both"];
    std::ranges::set_union(whole.node_sets.at("b.left"), whole.node_sets.at("c.left"),
                           std::back_inserter(both));
    ASSERT_EQ(both.size(), 3u);
    if (height == 1) {
      try {
        join(whole, "right", "both");
        FAIL();
      } catch (const MeshError& error) {
        EXPECT_NE(std::string(error.what())
                      .find("the node at (1, 0.5, 0) m of the one is between nodes of the other"),
                  std::string::npos)
            << error.what();
      }
    } else {
      join(whole, "right", "both");
      EXPECT_EQ(whole.node_count(), 4 + 6 - 2);
    }
  }
}

TEST(Assembly, ATieThatJoinsNothingIsSaid) {
  Mesh whole = pair_of_patches(0);
  join(whole, "right", "b.left");
  EXPECT_THROW(join(whole, "right", "b.left"), MeshError);
  EXPECT_THROW(join(whole, "right", "right"), MeshError);
}

TEST(Assembly, OneNameOneOrder) {
  Mesh whole = pair_of_patches(0);
  EXPECT_THROW(append(whole, patch_mesh(1, 1), "b"), MeshError);
  EXPECT_THROW(append(whole, patch_mesh(1, 1, 2), "c"), MeshError);
}

/// Places as sets of points, whatever the numbers.
std::map<std::string, std::vector<std::array<double, 3>>> points_of_places(const Mesh& mesh) {
  std::map<std::string, std::vector<std::array<double, 3>>> all;
  for (const auto& [place, nodes] : mesh.node_sets) {
    for (const int node : nodes) {
      const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(node)];
      all[place].push_back({x.x(), x.y(), x.z()});
    }
    std::ranges::sort(all[place]);
  }
  return all;
}

TEST(GmshText, IsTheMeshAgain) {
  const test::ScratchFolder folder;
  const double degree = std::numbers::pi / 180;
  for (const Mesh& mesh :
       {honeycomb_mesh({140 * degree, {2, 1, 2}, 8e-3}, {2, 3, 3}),
        honeycomb_mesh({90 * degree, {1}, 8e-3}, {1, 2, 1}), disc_mesh(0.02, 0.01, 4, 2, true)}) {
    std::ofstream(folder / "mesh.msh") << gmsh_text(mesh);
    const Mesh again = read_gmsh(folder / "mesh.msh");
    EXPECT_EQ(again.node_count(), mesh.node_count());
    EXPECT_EQ(points_of_places(again), points_of_places(mesh));
    EXPECT_EQ(again.film()->size(), mesh.film()->size());
    EXPECT_EQ(again.film()->type, mesh.film()->type);
    for (const auto& [place, set] : mesh.cell_sets)
      EXPECT_EQ(again.cell_sets.at(place).cells.size(), set.cells.size()) << place;
  }
}

} // namespace
} // namespace dielast::meshing
