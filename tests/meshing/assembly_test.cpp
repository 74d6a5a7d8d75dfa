// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/bars/bars.hpp"
#include "meshing/gmsh/gmsh_reader.hpp"
#include "meshing/gmsh/gmsh_text.hpp"
#include "meshing/honeycomb_mesh.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/parts/assembly.hpp"
#include "meshing/patch.hpp"
#include "meshing/rings.hpp"
#include "meshing/shares.hpp"
#include "tests/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

namespace dielast::meshing::assembly_test {
namespace {

Mesh pair_of_patches(double gap) {
  Mesh whole = patch_mesh(2, 1), other = patch_mesh(1, 1);
  for (auto& x : other.nodes) x.x() += 2 + gap;
  append(whole, other, "b");
  return whole;
}

/// A load on a beam that is a part was spread evenly over its nodes, ends and middles alike.
TEST(Assembly, WhatIsSpreadOverABeamIsSpreadOverItsLength) {
  Mesh whole = patch_mesh(2, 1);
  append(whole, line_mesh({0, 3, 0}, {1, 3, 0}, 2, 2), "bar");
  const auto share = shares(whole, false);
  const std::vector<int>& nodes = whole.node_sets.at("bar");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double x = whole.nodes[static_cast<std::size_t>(nodes[i])].x(), quarters = 4 * x;
    EXPECT_NEAR(share.at("bar").of_nodes[i],
                x == 0 || x == 1                 ? 1.0 / 12
                : std::lround(quarters) % 2 == 1 ? 1.0 / 3
                                                 : 1.0 / 6,
                1e-15);
  }
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

/// What joining two places says; nothing where they are joined.
std::string refusal(Mesh mesh, const std::string& place, const std::string& other) {
  try {
    join(mesh, place, other);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "";
}

/// Four patches with a bar where they meet: along a line inside the film.
TEST(Assembly, ANodeThatABarInsideTheFilmHasBetweenItsEndsIsSaid) {
  for (const int order : {1, 2}) {
    Mesh film = patch_mesh(1, 0.5, order);
    for (const auto& [name, x, y] : {std::tuple("b", 1.0, 0.0), {"c", 0.0, 0.5}, {"d", 1.0, 0.5}}) {
      Mesh other = patch_mesh(1, 0.5, order);
      for (auto& node : other.nodes) node += Eigen::Vector3d(x, y, 0);
      append(film, other, name);
    }
    join(film, "right", "b.left"), join(film, "c.right", "d.left");
    join(film, "top", "c.bottom"), join(film, "b.top", "d.bottom");
    std::vector<int>& all = film.node_sets["all"];
    std::vector<int>& line = film.node_sets["along"];
    for (int node = 0; node < film.node_count(); ++node) {
      all.push_back(node);
      if (film.nodes[static_cast<std::size_t>(node)].x() == 1) line.push_back(node);
    }
    for (const int elements : {1, 2, 4})
      for (const char* place : {"all", "along"}) {
        Mesh whole = film;
        append(whole, line_mesh({1, 0, 0}, {1, 1, 0}, elements, order), "bar");
        const std::string text = refusal(whole, "bar.line", place);
        SCOPED_TRACE(text);
        if (elements == 2)
          EXPECT_EQ(text, "");
        else if (elements == 1)
          EXPECT_NE(text.find("of the one is between nodes of the other"), std::string::npos);
        else // the bar has more nodes there
          EXPECT_NE(text.find("cannot be tied"), std::string::npos);
      }
  }
}

/// A flat triangle's corner near the edge that a bar is tied to, with nothing between its ends.
TEST(Assembly, ANodeBesideAnEdgeInsideTheFilmIsFree) {
  Mesh whole;
  whole.nodes = {{0, 0, 0}, {2, 0, 0}, {1, 0.1, 0}, {1, 3, 0}, {1, -1, 0}};
  whole.blocks = {{CellType::triangle3, {0, 1, 2, 1, 3, 2, 3, 0, 2, 0, 4, 1}}};
  whole.node_sets["film"] = {0, 1, 2, 3, 4};
  append(whole, line_mesh({0, 0, 0}, {2, 0, 0}, 1, 1), "bar");
  EXPECT_EQ(refusal(whole, "bar.line", "film"), "");
}

/// Two layers that are tied along a circle within the one, whose chords are longer in the other.
TEST(Assembly, NodesBetweenTiedOnesOfACircleInsideTheFilmAreSaid) {
  Mesh whole = disc_mesh(0.02, 0.01, 4, 1, true);
  const std::vector<int> circle = whole.node_sets.at("electrode_edge");
  for (const std::size_t every : {1u, 2u}) {
    Mesh both = whole, ring;
    std::vector<int> around = circle;
    const auto at = [&](int node) { return whole.nodes[static_cast<std::size_t>(node)]; };
    std::ranges::sort(around, {}, [&](int node) { return std::atan2(at(node).y(), at(node).x()); });
    CellBlock walls{CellType::line2, {}};
    for (std::size_t i = 0; i < around.size(); i += every) ring.nodes.push_back(at(around[i]));
    for (int i = 0; i < ring.node_count(); ++i)
      walls.nodes.insert(walls.nodes.end(), {i, (i + 1) % ring.node_count()});
    ring.blocks = {walls};
    append(both, ring, "ring");
    const std::string text = refusal(both, "ring", "electrode_edge");
    EXPECT_EQ(text.find("is between nodes of the other") != std::string::npos, every == 2) << text;
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
} // namespace dielast::meshing::assembly_test
