// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/mesh_error.hpp"
#include "meshing/middle_nodes.hpp"
#include "meshing/normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace dielast::meshing::normals_test {
namespace {

using Eigen::Vector3d;

/// Triangles of a band of n by 4 pieces, closed after one turn: as it comes, or with its ends exchanged.
template<class Map>
Mesh band(int n, bool crossed, const Map& map) {
  constexpr int across = 4;
  Mesh mesh;
  const auto number = [&](int i, int j) {
    if (i == n && crossed) return across - j;
    return (i % n) * (across + 1) + j;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= across; ++j)
      mesh.nodes.push_back(map(static_cast<double>(i) / n, static_cast<double>(j) / across));
  CellBlock& film = mesh.blocks.emplace_back(CellBlock{CellType::triangle3, {}});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < across; ++j) {
      const int a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1), d = number(i, j + 1);
      film.nodes.insert(film.nodes.end(), {a, b, c, a, c, d});
    }
  return mesh;
}

Vector3d tube(double u, double v) {
  const double angle = 2 * std::numbers::pi * u;
  return {2 * std::cos(angle), 2 * std::sin(angle), 3 * v};
}

void turn_some(CellBlock& film, unsigned seed) {
  std::mt19937 random(seed);
  const int n = nodes_per_cell(film.type);
  for (int cell = 0; cell < film.size(); ++cell) {
    if (random() % 2 == 0) continue;
    int* const own = film.nodes.data() + cell * n;
    std::swap(own[1], own[2]);
    if (n == 6) std::swap(own[3], own[5]);
  }
}

TEST(TurnAlike, has_a_closed_band_face_outwards) {
  for (const bool middles : {false, true})
    for (const unsigned seed : {1U, 2U, 3U}) {
      Mesh mesh = band(12, false, tube);
      if (middles) add_middle_nodes(mesh);
      turn_some(mesh.blocks[0], seed);
      turn_alike(mesh.nodes, mesh.blocks[0]);
      const std::vector<Vector3d> normals = node_normals(mesh, mesh.blocks[0]);
      for (std::size_t n = 0; n < normals.size(); ++n)
        EXPECT_GT(normals[n].dot(Vector3d(mesh.nodes[n].x(), mesh.nodes[n].y(), 0).normalized()), 0.95);
    }
}

TEST(TurnAlike, has_what_faces_up_or_down_face_up) {
  const auto cone = [](double u, double v) {
    const double angle = -2 * std::numbers::pi * u;
    return Vector3d((2 + v) * std::cos(angle), (2 + v) * std::sin(angle), 1 - 3 * v);
  };
  const auto level = [&](double u, double v) {
    Vector3d x = cone(u, v);
    x.z() = 0.7;
    return x;
  };
  for (const unsigned seed : {1U, 2U}) {
    for (Mesh mesh : {band(12, false, cone), band(12, false, level)}) {
      turn_some(mesh.blocks[0], seed);
      turn_alike(mesh.nodes, mesh.blocks[0]);
      for (const Vector3d& normal : node_normals(mesh, mesh.blocks[0])) EXPECT_GT(normal.z(), 0.2);
    }
  }
}

// Arcs about y, from one angle above the x axis to another; nearly as much of each looks up as down.
TEST(TurnAlike, has_what_stands_face_outwards) {
  for (const auto& [from, to] : {std::pair(-40.0, 40.0), {-40.5, 39.5}, {-39.5, 40.5}, {-60.0, 20.0}}) {
    Mesh mesh;
    CellBlock& film = mesh.blocks.emplace_back(CellBlock{CellType::triangle3, {}});
    for (int i = 0; i <= 10; ++i) {
      const double angle = (from + i * (to - from) / 10) * std::numbers::pi / 180;
      for (const int side : {0, 1}) mesh.nodes.emplace_back(std::cos(angle), side, std::sin(angle));
      if (i == 0) continue;
      const int n = 2 * i;
      film.nodes.insert(film.nodes.end(), {n - 2, n - 1, n, n - 1, n + 1, n});
    }
    turn_some(film, 4);
    turn_alike(mesh.nodes, film);
    const std::vector<Vector3d> normals = node_normals(mesh, film);
    for (std::size_t n = 0; n < normals.size(); ++n)
      EXPECT_GT(normals[n].dot(Vector3d(mesh.nodes[n].x(), 0, mesh.nodes[n].z())), 0.9) << from;
  }
}

TEST(TurnAlike, refuses_a_surface_with_one_side) {
  const auto moebius = [](double u, double v) {
    const double angle = 2 * std::numbers::pi * u, twist = std::numbers::pi * u;
    const double r = 4 + (v - 0.5) * std::cos(twist);
    return Vector3d(r * std::cos(angle), r * std::sin(angle), (v - 0.5) * std::sin(twist));
  };
  Mesh mesh = band(16, true, moebius);
  EXPECT_THROW(turn_alike(mesh.nodes, mesh.blocks[0]), MeshError);
}

// Where three meet at a side none of them is the other's neighbour.
TEST(TurnAlike, lets_surfaces_end_where_three_meet) {
  Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0.5, 0, 1}};
  mesh.blocks = {{CellType::triangle3, {0, 1, 2, 0, 1, 3, 0, 1, 4}}};
  turn_alike(mesh.nodes, mesh.blocks[0]);
  EXPECT_EQ(mesh.blocks[0].nodes, (std::vector<int>{0, 1, 2, 0, 3, 1, 0, 1, 4}));
}

// Of x -> (x, y, a x^2 + b x y + c y^2) on a triangle with straight sides in the plane of x and y.
TEST(Normals, are_those_of_the_curved_triangle) {
  constexpr double a = 0.3, b = -0.2, c = 0.15;
  Mesh mesh;
  mesh.nodes = {{0.1, 0.2, 0}, {1.3, 0.1, 0}, {0.4, 1.2, 0}};
  mesh.blocks = {{CellType::triangle3, {0, 1, 2}}};
  add_middle_nodes(mesh);
  for (Vector3d& x : mesh.nodes) x.z() = a * x.x() * x.x() + b * x.x() * x.y() + c * x.y() * x.y();
  const std::vector<Vector3d> own = normals(mesh.nodes, mesh.blocks[0].cell(0));
  ASSERT_EQ(own.size(), 6);
  for (std::size_t k = 0; k < 6; ++k) {
    const Vector3d& x = mesh.nodes[static_cast<std::size_t>(mesh.blocks[0].cell(0)[k])];
    const Vector3d exact(-2 * a * x.x() - b * x.y(), -b * x.x() - 2 * c * x.y(), 1);
    EXPECT_LT((own[k] - exact.normalized()).norm(), 1e-14) << k;
  }
}

} // namespace
} // namespace dielast::meshing::normals_test
