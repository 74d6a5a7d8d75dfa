// SPDX-License-Identifier: GPL-3.0-or-later
// Closed surfaces from files, and the tetrahedra that fill them.
#include "meshing/mesh_error.hpp"
#include "meshing/quality.hpp"
#include "meshing/solids/fill.hpp"
#include "meshing/solids/surface.hpp"
#include "tests/scratch_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <tuple>

namespace dielast::meshing::surface_test {
namespace {

using Triangle = std::array<int, 3>;

const std::vector<Eigen::Vector3d> corners{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0},
                                           {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1}};
const std::vector<Triangle> sides{{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                  {2, 3, 7}, {2, 7, 6}, {1, 2, 6}, {1, 6, 5}, {0, 4, 7}, {0, 7, 3}};

std::filesystem::path write(const std::string& name, const std::string& text) {
  static const test::ScratchFolder folder;
  const std::filesystem::path path = folder / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string off(const std::vector<Eigen::Vector3d>& points, const std::vector<Triangle>& triangles) {
  std::string text = fmt::format("OFF\n{} {} 0\n", points.size(), triangles.size());
  for (const Eigen::Vector3d& x : points) text += fmt::format("{} {} {}\n", x.x(), x.y(), x.z());
  for (const auto& [a, b, c] : triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

std::string stl(const std::vector<Eigen::Vector3d>& points, const std::vector<Triangle>& triangles) {
  std::string text = "solid block\n";
  for (const Triangle& triangle : triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int n : triangle) {
      const Eigen::Vector3d& x = points[static_cast<std::size_t>(n)];
      text += fmt::format("vertex {} {} {}\n", x.x(), x.y(), x.z());
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid block\n";
}

std::string ply(const std::vector<Eigen::Vector3d>& points, const std::vector<Triangle>& triangles) {
  std::string text =
      fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double "
                  "y\nproperty double z\nelement face {}\nproperty list uchar int "
                  "vertex_indices\nend_header\n",
                  points.size(), triangles.size());
  for (const Eigen::Vector3d& x : points) text += fmt::format("{} {} {}\n", x.x(), x.y(), x.z());
  for (const auto& [a, b, c] : triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

TEST(Surface, IsReadFromEveryKindOfFileAndFilled) {
  for (const auto& path : {write("block.off", off(corners, sides)), write("block.stl", stl(corners, sides)),
                           write("block.PLY", ply(corners, sides))}) {
    const Surface surface = read_surface(path);
    EXPECT_EQ(surface.points.size(), 8U) << path;
    EXPECT_EQ(surface.triangles.size(), 12U);
    const Mesh mesh = filled(surface, 0.4);
    const QualityReport report = quality(mesh);
    EXPECT_EQ(report.inverted, 0);
    EXPECT_NEAR(report.volume, 2, 1e-12);
    EXPECT_GT(report.tetrahedra, 100);
    EXPECT_GT(report.smallest_angle, 3);
    for (const char* place : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
      EXPECT_GE(mesh.node_sets.at(place).size(), 6U) << place;
    for (const int n : mesh.node_sets.at("x_max")) EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(n)].x(), 2);
    EXPECT_TRUE(mesh.node_sets.contains("face_6"));
    EXPECT_FALSE(mesh.node_sets.contains("face_7"));
  }
}

/// The block with a smaller one in it, drawn in by `size`.
std::pair<std::vector<Eigen::Vector3d>, std::vector<Triangle>> with_inner_block(double size) {
  std::vector<Eigen::Vector3d> points = corners;
  std::vector<Triangle> triangles = sides;
  const Eigen::Vector3d centre(1, 0.5, 0.5);
  for (const Eigen::Vector3d& x : corners) points.emplace_back(centre + size * (x - centre));
  for (const auto& [a, b, c] : sides) triangles.push_back({a + 8, b + 8, c + 8});
  return {points, triangles};
}

TEST(Surface, LeavesACavityEmpty) {
  auto [points, triangles] = with_inner_block(0.5);
  for (std::size_t t = sides.size(); t < triangles.size(); ++t) std::swap(triangles[t][0], triangles[t][1]);
  const QualityReport report =
      quality(filled(read_surface(write("hollow.off", off(points, triangles))), 0.4));
  EXPECT_NEAR(report.volume, 2 - 2 / 8.0, 1e-12);
  EXPECT_EQ(report.inverted, 0);
}

void expect_error(const std::filesystem::path& path, const std::string& message) {
  try {
    filled(read_surface(path), 1);
    ADD_FAILURE() << path << " is accepted";
  } catch (const MeshError& error) {
    EXPECT_EQ(error.what(), path.string() + ": " + message);
  }
}

TEST(Surface, ThatBoundsNoVolumeIsRefused) {
  expect_error("no_such.stl", "there is no such surface file");
  expect_error(write("nothing.stl", ""), "it is empty");
  expect_error(write("empty.stl", stl({}, {})), "it has no triangles");
  std::vector<Triangle> triangles = sides;
  triangles.pop_back();
  expect_error(write("open.stl", stl(corners, triangles)),
               "it is open: 3 edges belong to one triangle only; close its holes");
  triangles = sides;
  for (Triangle& triangle : triangles) std::swap(triangle[0], triangle[1]);
  expect_error(write("inside_out.off", off(corners, triangles)),
               "it is inside out: its triangles turn clockwise seen from outside; turn them round");
  triangles = sides;
  std::swap(triangles[4][0], triangles[4][1]);
  expect_error(write("turned.off", off(corners, triangles)),
               "an edge belongs to more than two triangles, or neighbours turn against each other; a surface "
               "that bounds a volume has neither");
  std::vector<Eigen::Vector3d> points = corners;
  points.emplace_back(1, 0, 0);
  triangles = sides;
  triangles.push_back({0, 8, 1});
  expect_error(write("degenerate.off", off(points, triangles)),
               "triangle 13 is degenerate: its corners lie on a line; remove it and close the gap");
  points = corners;
  triangles = sides;
  for (const Eigen::Vector3d& x : corners) points.emplace_back(x + Eigen::Vector3d(1, 0.5, 0.5));
  for (const auto& [a, b, c] : sides) triangles.push_back({a + 8, b + 8, c + 8});
  expect_error(write("two_blocks.off", off(points, triangles)),
               "it intersects itself; separate what crosses");
  std::tie(points, triangles) = with_inner_block(0.5);
  const std::string turned = "one of its surfaces is turned the wrong way round: triangles turn "
                             "counter-clockwise seen from outside, "
                             "those of a cavity seen from within it";
  expect_error(write("nested.off", off(points, triangles)), turned);
  for (std::size_t n = corners.size(); n < points.size(); ++n)
    points[n].x() += 4; // beside the block, inside out
  for (std::size_t t = sides.size(); t < triangles.size(); ++t) std::swap(triangles[t][0], triangles[t][1]);
  expect_error(write("beside.off", off(points, triangles)), turned);
  expect_error(write("square.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"),
               "face 1 has 4 corners; split the faces into triangles");
  expect_error(write("damaged.ply", "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\n"),
               "it cannot be read as a surface of triangles; it is damaged, write it again");
}

/// Told by the head of the file, before 500 MB are read.
TEST(Surface, ThatWouldTakeMillionsOfTetrahedraIsRefusedAtOnce) {
  const Surface box = read_surface(write("millions.off", off(corners, sides)));
  try {
    filled(box, 1e-3);
    FAIL();
  } catch (const MeshError& error) { // 2 x 1 x 1 over 1e-9/(6 sqrt 2), and half as large on the mean
    EXPECT_NE(std::string(error.what()).find("would take about 3.4e+10 tetrahedra"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("mesh.unit"), std::string::npos) << error.what();
  }
}

TEST(Surface, OfTenMillionTrianglesIsRefusedAtOnce) {
  constexpr std::uint32_t count = 10'000'000;
  std::string head(80, ' ');
  head.append(reinterpret_cast<const char*>(&count), sizeof count);
  const std::filesystem::path path = write("huge.stl", head);
  std::filesystem::resize_file(path, 84 + 50 * std::uintmax_t{count}); // without a block on the disk
  expect_error(path, "it has 10000000 triangles, at most 500000 are meshed; coarsen it");
  std::filesystem::remove(path);
}

} // namespace
} // namespace dielast::meshing::surface_test
