// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/mesh_error.hpp"
#include "meshing/quality.hpp"
#include "meshing/regions/region_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace dielast::meshing::regions_test {
namespace {

using Eigen::Vector2d;
constexpr double pi = std::numbers::pi;
const RoundFilm ring_of_film{12.7e-3, 68.58e-3}, disc_of_film{0, 30e-3};

/// Of the triangles of a place, curved sides included.
double area_of(const Mesh& mesh, const std::string& place) {
  Mesh part{mesh.nodes, {subset(mesh.blocks[0], mesh.cell_sets.at(place).cells)}, {}, {}};
  return quality(part).area;
}

std::vector<Region> quarters(double gap) {
  std::vector<Region> regions;
  for (int k = 0; k < 4; ++k)
    regions.push_back(sector(std::string(1, static_cast<char>('a' + k)), ring_of_film, (2 * k - 1) * pi / 4,
                             (2 * k + 1) * pi / 4, gap / 2, 0));
  return regions;
}

/// Of a disc where x > 0 and 0 < y < g.
double half_strip(double radius, double g) {
  return (g * std::sqrt(radius * radius - g * g) + radius * radius * std::asin(g / radius)) / 2;
}

/// Part of an annulus's quarter beyond a distance g from both of its sides: what a strip of width 2 g along
/// each side leaves.
double quarter_without_strips(double inner, double outer, double g) {
  return pi / 4 * (outer * outer - inner * inner) - 2 * (half_strip(outer, g) - half_strip(inner, g));
}

TEST(Regions, SectorsWithoutAGapCoverTheFilm) {
  const Mesh mesh = region_mesh(ring_of_film, quarters(0), 16, 4, 2);
  const double quarter =
      pi / 4 * (std::pow(ring_of_film.outer_radius, 2) - std::pow(ring_of_film.inner_radius, 2));
  std::size_t cells = 0;
  for (const char* place : {"a", "b", "c", "d"}) {
    EXPECT_NEAR(area_of(mesh, place), quarter, 1e-6 * quarter);
    cells += mesh.cell_sets.at(place).cells.size();
  }
  EXPECT_EQ(cells, mesh.cell_sets.at("film").cells.size());
  EXPECT_EQ(quality(mesh).inverted, 0);
  EXPECT_GT(quality(mesh).smallest_angle, 25);
  for (const int node : mesh.node_sets.at("inner"))
    EXPECT_NEAR(mesh.nodes[static_cast<std::size_t>(node)].norm(), ring_of_film.inner_radius, 1e-15);
  for (const int node : mesh.node_sets.at("outer"))
    EXPECT_NEAR(mesh.nodes[static_cast<std::size_t>(node)].norm(), ring_of_film.outer_radius, 1e-15);
}

// The tip of three quarters lies outside the hole, and so do two arcs of its edge beside the tip.
TEST(Regions, TheSidesOfMoreThanHalfATurnGoOnBeyondTheHole) {
  const RoundFilm film{10e-3, 30e-3};
  constexpr double g = 8e-3;
  const Mesh mesh = region_mesh(film, {{sector("a", film, 0, 1.5 * pi, g, 0)}}, 16, 6, 2);
  // What is beside it, y < g and x > -g: a quarter, two half strips and a square, of the hole no whole one.
  const double bare_of_disc =
      pi / 4 * std::pow(film.outer_radius, 2) + 2 * half_strip(film.outer_radius, g) + g * g;
  const double bare_of_hole = 4 * half_strip(film.inner_radius, g);
  const double expected =
      pi * (std::pow(film.outer_radius, 2) - std::pow(film.inner_radius, 2)) - (bare_of_disc - bare_of_hole);
  EXPECT_NEAR(area_of(mesh, "a"), expected, 1e-5 * expected);
}

TEST(Regions, AGapIsAStripBetweenSectors) {
  for (const double gap : {0.2e-3, 5e-3}) {
    const Mesh mesh = region_mesh(ring_of_film, quarters(gap), 16, 4, 2);
    const double expected =
        quarter_without_strips(ring_of_film.inner_radius, ring_of_film.outer_radius, gap / 2);
    for (const char* place : {"a", "b", "c", "d"})
      EXPECT_NEAR(area_of(mesh, place), expected, 2e-6 * expected) << gap;
    EXPECT_GT(quality(mesh).smallest_angle, 12) << gap;
    // A strip along the diagonal has no node of "a" nearer to it than half the gap.
    for (const int node : mesh.node_sets.at("a")) {
      const auto& x = mesh.nodes[static_cast<std::size_t>(node)];
      EXPECT_GE((x.x() - std::abs(x.y())) / std::sqrt(2.0), gap / 2 - 1e-12);
    }
  }
}

TEST(Regions, RingsRectanglesAndPolygonsAreKept) {
  const std::vector<Region> regions{
      ring("edge", {20e-3, 30e-3}, 1e-3),
      polygon("square", {{-5e-3, -5e-3}, {5e-3, -5e-3}, {5e-3, 5e-3}, {-5e-3, 5e-3}}, 0),
      polygon("wedge", {{5e-3, 5e-3}, {5e-3, -5e-3}, {12e-3, 0}}, 0), // clockwise, on the square's side
      polygon("inset", {{-14e-3, -4e-3}, {-6e-3, -4e-3}, {-6e-3, 4e-3}, {-14e-3, 4e-3}}, 1e-3),
      sector("slice", {15e-3, 18e-3}, 0.3, 0.3 + 1.5 * pi, 0, 0)};
  for (const int order : {1, 2}) {
    const Mesh mesh = region_mesh(disc_of_film, regions, 16, 1, order);
    const double tolerance = order == 2 ? 1e-6 : 0.02; // straight sides along arcs
    EXPECT_NEAR(area_of(mesh, "square"), 1e-4, 1e-12);
    EXPECT_NEAR(area_of(mesh, "wedge"), 35e-6, 1e-12);
    EXPECT_NEAR(area_of(mesh, "inset"), 36e-6, 1e-12);
    const double edge = pi * (29e-3 * 29e-3 - 21e-3 * 21e-3),
                 slice = 0.75 * pi * (18e-3 * 18e-3 - 15e-3 * 15e-3);
    EXPECT_NEAR(area_of(mesh, "edge"), edge, tolerance * edge);
    EXPECT_NEAR(area_of(mesh, "slice"), slice, tolerance * slice);
    EXPECT_NEAR(area_of(mesh, "film"), pi * 9e-4, tolerance * pi * 9e-4);
    EXPECT_EQ(mesh.node_sets.at("centre").size(), 1U);
    EXPECT_EQ(quality(mesh).inverted, 0);
  }
}

TEST(Regions, TheMeshRepeatsTheMirrorsOfItsRegions) {
  const Mesh mesh = region_mesh(ring_of_film, quarters(5e-3), 12, 4, 2);
  for (const Eigen::Vector3d& mirror : {Eigen::Vector3d(-1, 1, 1), Eigen::Vector3d(1, -1, 1)})
    for (const Eigen::Vector3d& x : mesh.nodes)
      EXPECT_TRUE(std::ranges::any_of(mesh.nodes, [&](const Eigen::Vector3d& y) {
        return (y - x.cwiseProduct(mirror)).norm() < 1e-9;
      })) << x.transpose();
}

std::string fault_of(const RoundFilm& film, const std::vector<Region>& regions) {
  std::string reasons;
  for (const RegionFault& fault : faults(film, regions))
    reasons += std::to_string(fault.region) + ": " + fault.reason + "\n";
  return reasons;
}

Region square(const char* name, double x, double y, double half) {
  return polygon(name,
                 {{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}}, 0);
}

TEST(Regions, OverlapsAreFaults) {
  const Region a = square("a", 0, 0, 5e-3);
  const auto with = [&](Region b) { return fault_of(disc_of_film, {a, std::move(b)}); };
  const std::string overlapping = "1: it overlaps with \"a\"\n";
  EXPECT_EQ(with(square("b", 4e-3, 3e-3, 2e-3)), overlapping); // across
  EXPECT_EQ(with(square("b", 0, 0, 2e-3)), overlapping);       // within
  EXPECT_EQ(with(square("b", 0, 0, 8e-3)), overlapping);       // around
  EXPECT_EQ(with(square("b", 0, 0, 5e-3)), overlapping);       // the same
  EXPECT_EQ(with(polygon("b", {{5e-3, 0}, {0, 5e-3}, {-5e-3, 0}, {0, -5e-3}}, 0)), overlapping);
  EXPECT_EQ(with(ring("b", {4e-3, 6e-3}, 0)), overlapping);
  EXPECT_EQ(with(sector("b", {0, 20e-3}, 0, 0.1, 0, 0)), overlapping);
  EXPECT_EQ(with(square("b", 10e-3, 2e-3, 5e-3)), "");                // beside it
  EXPECT_EQ(with(ring("b", {std::sqrt(0.5) * 10e-3, 20e-3}, 0)), ""); // touches its corners
  EXPECT_EQ(fault_of(ring_of_film, quarters(0)), "");
  EXPECT_THROW(region_mesh(disc_of_film, std::vector{a, square("b", 0, 0, 2e-3)}, 8, 1, 1), MeshError);
}

TEST(Regions, WhatLeavesTheFilmIsAFault) {
  EXPECT_EQ(fault_of(disc_of_film, {square("a", 25e-3, 0, 5e-3)}),
            "0: it leaves the film: (30, -5) mm is 30.4138 mm from the middle, the film ends at 30 mm\n");
  EXPECT_EQ(fault_of(ring_of_film, {polygon("a", {{-20e-3, 5e-3}, {20e-3, 5e-3}, {0, 30e-3}}, 0)}),
            "0: it leaves the film: (0, 5) mm is 5 mm from the middle, the film begins at 12.7 mm\n");
  EXPECT_EQ(fault_of(ring_of_film, {polygon("a", {{-30e-3, -30e-3}, {30e-3, -30e-3}, {0, 40e-3}}, 0)}), "");
}

TEST(Regions, WhatAGapLeavesNothingOfIsRefused) {
  EXPECT_THROW(sector("a", ring_of_film, 0, 0.1, 5e-3, 0), std::invalid_argument);
  EXPECT_THROW(sector("a", ring_of_film, 0, pi / 2, 0, 30e-3), std::invalid_argument);
  EXPECT_THROW(sector("a", ring_of_film, 1, 1, 0, 0), std::invalid_argument);
  EXPECT_THROW(ring("a", {1e-3, 2e-3}, 0.5e-3), std::invalid_argument);
  EXPECT_THROW(polygon("a", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.5), std::invalid_argument);
  EXPECT_THROW(polygon("a", {{0, 0}, {4, 0}, {4, 1}, {0, 1}}, 0.6), std::invalid_argument);
  EXPECT_THROW(polygon("a", {{0, 0}, {1, 1}, {2, 2}}, 0), std::invalid_argument);
  const std::vector<Vector2d> dumbbell{{0, 0},  {4, 0}, {4, 1.5}, {6, 1.5}, {6, 0}, {10, 0},
                                       {10, 4}, {6, 4}, {6, 2.5}, {4, 2.5}, {4, 4}, {0, 4}};
  EXPECT_NO_THROW(polygon("a", dumbbell, 0.45));
  EXPECT_THROW(polygon("a", dumbbell, 0.55), std::invalid_argument); // its neck is gone
  EXPECT_THROW(polygon("a", {{0, 0}, {2, 2}, {2, 0}, {0, 2}}, 0), std::invalid_argument);
}

TEST(Regions, NeedNamesOfTheirOwn) {
  EXPECT_THROW(region_mesh(disc_of_film, std::vector{square("film", 0, 0, 5e-3)}, 8, 1, 1), MeshError);
  EXPECT_THROW(region_mesh(disc_of_film, std::vector{square("rim", 0, 0, 5e-3)}, 8, 1, 2), MeshError);
}

} // namespace
} // namespace dielast::meshing::regions_test
