// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/revolution.hpp"

#include "meshing/meridian.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace dielast::post::revolution_test {
namespace {

using Eigen::Vector3d;

TEST(Revolution, OfABalloonIsAClosedSurfaceThatLooksOutwards) {
  const meshing::Mesh mesh = meshing::balloon_meridian(20e-3, 40, 2);
  const Revolution film(mesh, *mesh.film());
  EXPECT_EQ(film.points.size(), 79u * Revolution::sectors + 2); // 81 nodes, two on the axis
  EXPECT_EQ(film.facets.size(), 80u * Revolution::sectors);

  std::set<std::pair<int, int>> edges;
  double area = 0;
  for (const auto& facet : film.facets) {
    const auto at = [&](int k) { return film.points[static_cast<std::size_t>(facet.points[k])](mesh.nodes); };
    for (int k = 0; k < facet.corners; ++k)
      EXPECT_TRUE(edges.emplace(facet.points[k], facet.points[(k + 1) % facet.corners]).second);
    const Vector3d normal =
        facet.corners == 4 ? (at(2) - at(0)).cross(at(3) - at(1)) : (at(1) - at(0)).cross(at(2) - at(0));
    EXPECT_GT(normal.dot(at(0)), 0);
    area += normal.norm() / 2;
  }
  for (const auto& [from, to] : edges) EXPECT_TRUE(edges.contains({to, from}));
  const double sphere = 4 * std::numbers::pi * 20e-3 * 20e-3;
  EXPECT_NEAR(area, sphere, 2e-3 * sphere);
  EXPECT_LT(area, sphere);
}

TEST(Revolution, KnowsTheCellsOfItsFacets) {
  const meshing::Mesh mesh = meshing::disc_meridian(3, 1, 2, 1);
  const Revolution film(mesh, *mesh.film());
  ASSERT_EQ(film.facets.size(), 2u * Revolution::sectors);
  for (std::size_t i = 0; i < film.facets.size(); ++i) {
    const bool outside = i < Revolution::sectors;
    EXPECT_EQ(film.facets[i].cell, outside ? 0 : 1);
    EXPECT_EQ(film.facets[i].corners, outside ? 4 : 3);
  }
}

} // namespace
} // namespace dielast::post::revolution_test
