// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/mesh_error.hpp"
#include "meshing/planar.hpp"

#include <gtest/gtest.h>

#include <set>

namespace dielast::meshing::planar_test {
namespace {

using Eigen::Vector2d;

std::vector<Vector2d> outline(const std::vector<Vector2d>& corners, int elements) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (int k = 0; k < elements; ++k)
      points.push_back(corners[i] + (corners[(i + 1) % corners.size()] - corners[i]) * k / elements);
  return points;
}

double area(const Triangulation& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector2d u = mesh.points[b] - mesh.points[a], v = mesh.points[c] - mesh.points[a];
    EXPECT_GT(u.x() * v.y() - u.y() * v.x(), 0);
    sum += (u.x() * v.y() - u.y() * v.x()) / 2;
  }
  return sum;
}

void expect_keeps_outline(const Triangulation& mesh, const std::vector<Vector2d>& points) {
  std::set<std::pair<int, int>> sides;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(sides.emplace(t[k], t[(k + 1) % 3]).second);
  const int n = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR((mesh.points[i] - points[i]).norm(), 0, 1e-14);
    EXPECT_TRUE(sides.contains({i, (i + 1) % n}));
    EXPECT_FALSE(sides.contains({(i + 1) % n, i}));
  }
}

TEST(Planar, ConvexAndReentrantOutlinesAreKept) {
  const std::vector<std::vector<Vector2d>> shapes{
      {{0, 0}, {3, 0}, {3, 2}, {0, 2}},
      {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}, // L
      {{0, 0}, {2, 1.9}, {4, 0}, {2, 2.1}},             // arrow head
      {{0.3, 0}, {5, 1}, {-2, 4}},
  };
  const std::vector<double> areas{6, 7, 0.4, 10.55};
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (const int elements : {1, 2, 7}) {
      const std::vector<Vector2d> points = outline(shapes[i], elements);
      const Triangulation mesh = triangulate(points, 1.5);
      expect_keeps_outline(mesh, points);
      EXPECT_NEAR(area(mesh), areas[i], 1e-12) << i << ' ' << elements;
    }
}

TEST(Planar, ASingleTriangleStaysOne) {
  const Triangulation mesh = triangulate(std::vector<Vector2d>{{0, 0}, {1, 0}, {0, 1}}, 1);
  EXPECT_EQ(mesh.points.size(), 3u);
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(Planar, RejectsAnOutlineThatCrossesItself) {
  EXPECT_THROW(triangulate(std::vector<Vector2d>{{0, 0}, {2, 2}, {2, 0}, {0, 2}}, 1), MeshError);
}

} // namespace
} // namespace dielast::meshing::planar_test
