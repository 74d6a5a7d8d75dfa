// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace dielast::meshing::crossings_test {
namespace {

using Motion = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// A strip of 20 x 2 squares of 1 mm, each of two triangles of three nodes, in the plane of x and y.
Mesh strip() {
  Mesh mesh;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 2; ++j) mesh.nodes.emplace_back(i, j, 0);
  mesh.blocks = {{CellType::triangle3, {}}};
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 2; ++j) {
      const int n = 3 * i + j;
      for (const int node : {n, n + 3, n + 4, n, n + 4, n + 1}) mesh.blocks[0].nodes.push_back(node);
    }
  return mesh;
}

std::optional<FilmSurface::Crossing> crossing(const Mesh& mesh, const Motion& motion,
                                              const std::vector<std::string>& kept_apart = {}) {
  std::vector<Eigen::Vector3d> x;
  for (const Eigen::Vector3d& drawn : mesh.nodes) x.push_back(motion(drawn));
  return FilmSurface(mesh, std::vector<int>(static_cast<std::size_t>(mesh.film()->size()), 0), kept_apart)
      .crossing(x);
}

/// Curled to `turns` of a circle about an axis along y; its radius grows by this part, and it moves along the
/// axis by that much of its length.
Motion curl(double turns, double grows = 0, double climbs = 0) {
  return [=](const Eigen::Vector3d& x) {
    const double angle = x[0] / 20 * turns * 2 * std::numbers::pi;
    const double radius = 20 / (turns * 2 * std::numbers::pi) * (1 + grows * x[0] / 20);
    return Eigen::Vector3d(radius * std::sin(angle), x[1] + climbs * x[0], -radius * std::cos(angle));
  };
}

TEST(FilmSurface, of_a_curled_strip_passes_through_itself_where_it_comes_round) {
  const Mesh mesh = strip();
  EXPECT_FALSE(crossing(mesh, curl(0.95)));
  EXPECT_TRUE(crossing(mesh, curl(1.3)));
  EXPECT_FALSE(crossing(mesh, curl(1.8, 1, 2))); // a spiral
  EXPECT_FALSE(crossing(mesh, curl(1.8, 1, 1))); // a helix
  const auto found = crossing(mesh, curl(1.3));
  EXPECT_LT(found->cells[0], found->cells[1]);
}

// In a plane the edges cross; what is said to be kept apart is left out.
TEST(FilmSurface, in_a_plane_passes_through_itself_at_its_edges) {
  Mesh mesh = strip();
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) mesh.node_sets["all"].push_back(static_cast<int>(n));
  const auto bend = [](double turns) {
    return [=](const Eigen::Vector3d& x) {
      const double angle = x[0] / 20 * turns * 2 * std::numbers::pi;
      const double radius = 20 / (turns * 2 * std::numbers::pi) + x[1];
      return Eigen::Vector3d(radius * std::sin(angle), radius * std::cos(angle), 0);
    };
  };
  EXPECT_FALSE(crossing(mesh, bend(0.9)));
  EXPECT_TRUE(crossing(mesh, bend(1.2)));
  EXPECT_FALSE(crossing(mesh, bend(1.2), {"all"}));
}

// The side of a body that ends at a surface which is kept apart may cross the straight sides of the other
// one; the next side may not.
TEST(FilmSurface, may_end_at_what_is_kept_apart) {
  Mesh mesh;
  mesh.blocks = {{CellType::triangle3, {}}};
  const auto square = [&](double x, double y, double size) {
    const int n = mesh.node_count();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) mesh.nodes.emplace_back(x + size * j, y + size * i, 0);
    for (const int node : {n, n + 1, n + 3, n, n + 3, n + 2}) mesh.blocks[0].nodes.push_back(node);
  };
  square(0, 0, 1);
  square(0.25, 1.1, 0.5); // above it, of two squares
  for (const double x : {0.25, 0.75}) mesh.nodes.emplace_back(x, 2.1, 0);
  for (const int node : {6, 7, 9, 6, 9, 8}) mesh.blocks[0].nodes.push_back(node);
  mesh.node_sets = {{"below", {2, 3}}, {"above", {4, 5}}};
  const auto sunk = [&](double by) {
    return crossing(mesh,
                    [&](const Eigen::Vector3d& x) {
                      return Eigen::Vector3d(x - by * (x[1] > 1) * Eigen::Vector3d::UnitY());
                    },
                    {"below", "above"});
  };
  EXPECT_FALSE(sunk(0.05));
  EXPECT_FALSE(sunk(0.3));
  EXPECT_TRUE(sunk(0.8));
  // Two sides that both end there: as of solids cut by a plane of symmetry, in the plane.
  const auto slid = [&](double low) {
    return crossing(mesh,
                    [&](const Eigen::Vector3d& x) {
                      if (x[1] <= 1) return x;
                      if (x[1] < 1.5) return Eigen::Vector3d(x[0] < 0.5 ? 1.05 : 1.6, low, 0);
                      return Eigen::Vector3d(x[0] < 0.5 ? 0.5 : 1.6, low + x[1] - 1.1, 0);
                    },
                    {"below", "above"});
  };
  EXPECT_FALSE(slid(0.9));
  EXPECT_TRUE(slid(0.1));
}

// What touches as drawn, as the lips of a slit do, may do so for ever.
TEST(FilmSurface, that_touches_as_drawn_is_no_crossing) {
  Mesh mesh = strip();
  const int first = mesh.node_count();
  for (int j = 0; j <= 2; ++j) mesh.nodes.emplace_back(10, j, 0); // the lip at x = 10 of the right half
  for (int cell = 40; cell < 80; ++cell)
    for (int k = 0; k < 3; ++k) {
      int& node = mesh.blocks[0].nodes[static_cast<std::size_t>(3 * cell + k)];
      if (node >= 30 && node <= 32) node += first - 30;
    }
  EXPECT_FALSE(
      crossing(mesh, [](const Eigen::Vector3d& x) { return Eigen::Vector3d(2 * x[0], x[1], 0.1 * x[0]); }));
  EXPECT_FALSE(crossing(mesh, [](const Eigen::Vector3d& x) { return Eigen::Vector3d(2 * x[0], x[1], 0); }));
}

TEST(FilmSurface, of_parts_that_stand_apart_as_drawn_may_cross) {
  Mesh mesh = strip();
  const Mesh second = strip();
  const int first = mesh.node_count();
  for (const Eigen::Vector3d& x : second.nodes) mesh.nodes.push_back(x + Eigen::Vector3d(0, 0, 1));
  for (const int node : second.blocks[0].nodes) mesh.blocks[0].nodes.push_back(node + first);
  std::vector<int> parts(80, 0);
  parts.resize(160, 1);
  const FilmSurface surface(mesh, parts, {});
  std::vector<Eigen::Vector3d> x = mesh.nodes;
  EXPECT_FALSE(surface.crossing(x));
  for (std::size_t n = 0; n < static_cast<std::size_t>(first); ++n)
    x[n] += Eigen::Vector3d(0, 0, 0.1 * x[n][0]);
  const auto found = surface.crossing(x);
  ASSERT_TRUE(found);
  EXPECT_LT(found->cells[0], 80);
  EXPECT_GE(found->cells[1], 80);
}

} // namespace
} // namespace dielast::meshing::crossings_test
