// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/refine.hpp"

#include "meshing/honeycomb_mesh.hpp"
#include "meshing/quality.hpp"
#include "meshing/rings.hpp"
#include "meshing/solids/slab.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace dielast::meshing::refine_test {
namespace {

double area_of(const Mesh& mesh) {
  double area = 0;
  const CellBlock& film = *mesh.film();
  const auto x = [&](int node) { return mesh.nodes[static_cast<std::size_t>(node)]; };
  for (int c = 0; c < film.size(); ++c) {
    const auto cell = film.cell(c);
    area += (x(cell[1]) - x(cell[0])).cross(x(cell[2]) - x(cell[0])).z() / 2;
  }
  return area;
}

TEST(Refined, SplitsTrianglesIntoFourAndLinesIntoTwo) {
  for (const int order : {1, 2}) {
    const Mesh mesh = honeycomb_mesh({2.0, {2, 1, 2}, 1}, {order, 2, 1});
    const Mesh finer = refined(mesh);
    EXPECT_EQ(finer.film()->type, mesh.film()->type);
    EXPECT_EQ(finer.film()->size(), 4 * mesh.film()->size());
    EXPECT_EQ(finer.walls()->size(), 2 * mesh.walls()->size());
    EXPECT_NEAR(area_of(finer), area_of(mesh), 1e-12);
    EXPECT_NEAR(quality(finer).smallest_angle, quality(mesh).smallest_angle, 1e-9);
    for (int n = 0; n < mesh.node_count(); ++n)
      EXPECT_EQ(finer.nodes[static_cast<std::size_t>(n)], mesh.nodes[static_cast<std::size_t>(n)]);
  }
}

// A side between two nodes of a place need not lie in the place: what is new belongs to places by its cells.
TEST(Refined, PlacesKeepTheirShape) {
  for (const int order : {1, 2}) {
    const Mesh mesh = honeycomb_mesh({2.0, {2, 1, 2}, 1}, {order, 2, 1});
    const Mesh finer = refined(mesh);
    EXPECT_EQ(finer.cell_sets.at("boundary").cells.size(), 2 * mesh.cell_sets.at("boundary").cells.size());
    // n nodes on a closed line: as many as sides; twice as many on the finer one.
    EXPECT_EQ(finer.node_sets.at("boundary").size(), 2 * mesh.node_sets.at("boundary").size());
    EXPECT_EQ(finer.node_sets.at("left_apex"), mesh.node_sets.at("left_apex"));
    EXPECT_EQ(finer.cell_sets.at("cell[0,1]").cells.size(), 4 * mesh.cell_sets.at("cell[0,1]").cells.size());
  }
}

// Given by their nodes alone, places have what they would have as cells; single nodes stay alone.
TEST(Refined, PlacesOfNodesHaveWhatIsNewInThem) {
  for (const int order : {1, 2}) {
    const Mesh mesh = honeycomb_mesh({2.0, {2, 1, 2}, 1}, {order, 2, 1});
    Mesh of_nodes = mesh;
    of_nodes.cell_sets.clear();
    EXPECT_EQ(refined(refined(of_nodes)).node_sets, refined(refined(mesh)).node_sets) << order;
  }
}

TEST(Refined, SidesOfSolidsHaveWhatIsNewOnThem) {
  Mesh mesh = block_mesh({{3, 1, 0, {0, 3}, 0}, 2, 2}, 2, 1);
  const auto on_side = [](const Mesh& of, int axis, double at) {
    std::vector<int> nodes;
    for (int n = 0; n < of.node_count(); ++n)
      if (std::abs(of.nodes[static_cast<std::size_t>(n)][axis] - at) < 1e-12) nodes.push_back(n);
    return nodes;
  };
  const auto surface = [&](const Mesh& of) {
    std::set<int> nodes;
    for (int axis = 0; axis < 3; ++axis)
      for (const double at : {of.bounds().min()[axis], of.bounds().max()[axis]})
        for (const int node : on_side(of, axis, at)) nodes.insert(node);
    return std::vector<int>(nodes.begin(), nodes.end());
  };
  mesh.node_sets["surface"] = surface(mesh);
  const Mesh finer = refined(refined(mesh));
  EXPECT_EQ(finer.node_sets.at("left"), on_side(finer, 0, 0));
  EXPECT_EQ(finer.node_sets.at("right"), on_side(finer, 0, 3));
  EXPECT_EQ(finer.node_sets.at("bottom"), on_side(finer, 1, 0));
  EXPECT_EQ(finer.node_sets.at("top"), on_side(finer, 1, 1));
  EXPECT_EQ(finer.node_sets.at("back"), on_side(finer, 2, -1));
  EXPECT_EQ(finer.node_sets.at("front"), on_side(finer, 2, 1));
  EXPECT_EQ(finer.node_sets.at("surface"), surface(finer));
}

TEST(Refined, CurvedLinesKeepTheirCurve) {
  Mesh arc;
  const int cells = 3, nodes = 2 * cells + 1;
  for (int n = 0; n < nodes; ++n) {
    const double angle = std::numbers::pi / 2 * n / (nodes - 1);
    arc.nodes.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  arc.blocks.push_back({CellType::line3, {}});
  for (int c = 0; c < cells; ++c)
    arc.blocks[0].nodes.insert(arc.blocks[0].nodes.end(), {2 * c, 2 * c + 2, 2 * c + 1});
  // Points of a parabola through three points of the circle; chords would be 8e-3 off.
  for (const Eigen::Vector3d& x : refined(arc).nodes) EXPECT_NEAR(x.norm(), 1, 2e-4);
}

TEST(Refined, CurvedSidesKeepTheirCurve) {
  const Mesh disc = disc_mesh(1, 0.5, 4, 2, true);
  const Mesh finer = refined(disc);
  // Points of a parabola through three points of the circle: within 1e-4 of it, chords would be 2e-3 off.
  const CellBlock& film = *finer.film();
  int outer = 0;
  for (int c = 0; c < film.size(); ++c)
    for (const int node : film.cell(c)) {
      const double radius = finer.nodes[static_cast<std::size_t>(node)].norm();
      if (radius > 0.999) {
        EXPECT_NEAR(radius, 1, 1e-4);
        ++outer;
      }
    }
  EXPECT_GT(outer, 2 * 24 * 2);
}

} // namespace
} // namespace dielast::meshing::refine_test
