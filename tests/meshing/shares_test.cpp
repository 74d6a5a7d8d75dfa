// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/shares.hpp"

#include "meshing/meridian.hpp"
#include "meshing/rings.hpp"
#include "meshing/solids/slab.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

namespace dielast::meshing::shares_test {
namespace {

/// The mean of a function over a place.
double mean_over(const Mesh& mesh, bool of_revolution, const std::string& place,
                 const std::function<double(const Eigen::Vector3d&)>& value) {
  const Shares share = shares(mesh, of_revolution).at(place);
  EXPECT_FALSE(share.mixed) << place;
  double mean = 0;
  const auto& nodes = mesh.node_sets.at(place);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    mean += share.of_nodes[n] * value(mesh.nodes[static_cast<std::size_t>(nodes[n])]);
  return mean;
}

TEST(Shares, SumToOneInEveryPlace) {
  const auto expect = [](const Mesh& mesh, bool of_revolution) {
    for (const auto& [place, share] : shares(mesh, of_revolution)) {
      EXPECT_EQ(share.of_nodes.size(), mesh.node_sets.at(place).size()) << place;
      EXPECT_NEAR(std::accumulate(share.of_nodes.begin(), share.of_nodes.end(), 0.0), 1, 1e-13) << place;
      EXPECT_FALSE(share.mixed) << place;
    }
  };
  for (const int order : {1, 2}) {
    expect(disc_meridian(30, 20, 12, order), true);
    expect(balloon_meridian(30, 12, order), true);
    expect(disc_mesh(30, 20, 4, order, false), false);
    expect(disc_mesh(30, 20, 4, order, true), false);
  }
  for (const bool of_revolution : {false, true})
    expect(slab_mesh({24, 2, 0, {4, 20}, 0.1}, 3, 3, of_revolution), of_revolution);
  expect(block_mesh({{4, 0.6, 0, {1, 3}, 0.1}, 3, 2}, 3, 4), false);
  expect(hollow_sphere_mesh(10, 12, 2), true);
}

// Of a paraboloid over a disc the mean is half of its height.
TEST(Shares, OfADiscAreThoseOfItsAreaInTheMeridianAndInThePlane) {
  const auto square = [](const Eigen::Vector3d& x) { return x.squaredNorm(); };
  EXPECT_NEAR(mean_over(disc_meridian(30, 20, 10, 2), true, "film", square), 450, 1e-10);
  EXPECT_NEAR(mean_over(disc_meridian(30, 20, 10, 2), true, "electrode", square), 200, 1e-10);
  EXPECT_NEAR(mean_over(disc_meridian(30, 20, 40, 1), true, "film", square), 450, 450 * 1e-3);
  EXPECT_NEAR(mean_over(disc_mesh(30, 20, 6, 2, true), false, "film", square), 450, 450 * 1e-4);
  EXPECT_NEAR(mean_over(disc_mesh(30, 20, 6, 2, true), false, "electrode", square), 200, 200 * 5e-4);
}

// A line within film that turns by two sides of one triangle: the third is none of it, wherever the line
// ends.
TEST(Shares, OfALineThatTurnsAreThoseOfItsSides) {
  constexpr int n = 4;
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.nodes.emplace_back(0.25 * i, 0.25 * j, 0);
  mesh.blocks = {{CellType::triangle3, {}}};
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      for (const int node : {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1})
        mesh.blocks[0].nodes.push_back(node);
    }
  const auto at = [](int i, int j) { return j * (n + 1) + i; };
  mesh.node_sets["long"] = {at(1, 1), at(2, 1), at(3, 1), at(3, 2), at(3, 3)};
  mesh.node_sets["short"] = {at(2, 1), at(3, 1), at(3, 2)};
  const auto x = [](const Eigen::Vector3d& place) { return place.x(); };
  EXPECT_NEAR(mean_over(mesh, false, "long", x), (0.5 * 0.5 + 0.5 * 0.75), 1e-12);
  EXPECT_NEAR(mean_over(mesh, false, "short", x), (0.625 + 0.75) / 2, 1e-12);
}

// Places without cells of their own: sides of a slab, faces of a block; graded, so that counting nodes errs.
TEST(Shares, OfSidesAndFacesAreThoseOfTheirLengthAndArea) {
  const auto square = [](const Eigen::Vector3d& x) { return x.x() * x.x(); };
  const Mesh slab = slab_mesh({24, 2, 0, {4, 20}, 0.1}, 3, 3, true);
  EXPECT_NEAR(mean_over(slab, false, "top", square), 24 * 24 / 3.0, 1e-10);
  EXPECT_NEAR(mean_over(slab, true, "top", square), 24 * 24 / 2.0, 1e-10);
  EXPECT_NEAR(mean_over(slab, true, "film", square), 24 * 24 / 2.0, 1e-10);
  // on the axis: a line
  EXPECT_NEAR(mean_over(slab, true, "left", [](const auto& x) { return x.z() * x.z(); }), 4 / 3.0, 1e-12);
  const Mesh block = block_mesh({{4, 0.6, 0, {1, 3}, 0.1}, 3, 2}, 3, 4);
  EXPECT_NEAR(mean_over(block, false, "top", square), 16 / 3.0, 1e-12);
  EXPECT_NEAR(mean_over(block, false, "film", square), 16 / 3.0, 1e-12);
}

TEST(Shares, OfASideAreOneFourAndOne) {
  Mesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
            {{CellType::triangle6, {0, 1, 2, 3, 4, 5}}},
            {{"all", {0, 1, 2, 3, 4, 5}}, {"side", {0, 1, 3}}, {"ends", {0, 1}}, {"more", {0, 1, 2, 3}}},
            {{"all", {0, {0}}}}};
  const auto found = shares(mesh, false);
  const auto expect = [&found](const std::string& place, std::vector<double> expected) {
    for (std::size_t n = 0; n < expected.size(); ++n)
      EXPECT_NEAR(found.at(place).of_nodes[n], expected[n], 1e-14) << place;
  };
  expect("all", {0, 0, 0, 1 / 3.0, 1 / 3.0, 1 / 3.0});
  expect("side", {1 / 6.0, 1 / 6.0, 4 / 6.0});
  expect("ends", {0.5, 0.5});
  expect("more", {0.25, 0.25, 0.25, 0.25});
  EXPECT_EQ(found.at("all").of_nodes[0], 0); // without round-off: no mass
  EXPECT_TRUE(found.at("more").mixed);
  EXPECT_FALSE(found.at("ends").mixed);
}

// The consistent mass matrix of a side with three nodes, and with linear shape functions over a disc: x^2 of
// what is spread over it is that of its nodes' own parts and of those that they have in common.
TEST(Shares, WhatNodesHaveInCommonIsTheProductOfTheirShapeFunctions) {
  const Mesh side{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                  {{CellType::triangle6, {0, 1, 2, 3, 4, 5}}},
                  {{"side", {0, 1, 3}}, {"ends", {0, 1}}, {"one", {1}}},
                  {}};
  const auto common = common_shares(side, false, "side");
  ASSERT_EQ(common.size(), 3U);
  const auto expect = [&](std::size_t i, std::array<int, 2> nodes, double share) {
    EXPECT_EQ(common[i].nodes, nodes);
    EXPECT_NEAR(common[i].share, share, 1e-14);
  };
  expect(0, {0, 1}, -1 / 30.0);
  expect(1, {0, 3}, 2 / 30.0);
  expect(2, {1, 3}, 2 / 30.0);
  EXPECT_TRUE(common_shares(side, false, "ends").empty()); // nothing of the film is between them alone
  EXPECT_TRUE(common_shares(side, false, "one").empty());

  for (const auto& [mesh, of_revolution] :
       {std::pair{disc_meridian(30, 20, 10, 2), true}, {disc_mesh(30, 20, 6, 2, true), false}}) {
    const std::vector<double> share = shares(mesh, of_revolution).at("electrode").of_nodes;
    const auto x = [&mesh = mesh](int node) { return mesh.nodes[static_cast<std::size_t>(node)].x(); };
    double square = 0;
    for (std::size_t n = 0; n < share.size(); ++n)
      square += share[n] * std::pow(x(mesh.node_sets.at("electrode")[n]), 2);
    for (const auto& [nodes, part] : common_shares(mesh, of_revolution, "electrode"))
      square -= part * std::pow(x(nodes[0]) - x(nodes[1]), 2);
    // of the radius, and of one of two axes
    EXPECT_NEAR(square, of_revolution ? 200 : 100, 0.05);
  }
}

} // namespace
} // namespace dielast::meshing::shares_test
