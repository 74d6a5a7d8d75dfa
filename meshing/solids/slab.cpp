// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/slab.hpp"

#include "meshing/middle_nodes.hpp"
#include "meshing/solids/extruded.hpp"
#include "meshing/solids/grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <numbers>
#include <stdexcept>

namespace dielast::meshing {

namespace {

/// Elements along a longer side, at least: where it is hardly longer its strains change as those across do.
/// Of half as many across always less, so that comparing the two tells what they are.
int fewest(int across) { return std::max(static_cast<int>(std::bit_width(unsigned(across))), across / 3); }

} // namespace

Mesh slab_mesh(const SlabShape& shape, int across, double grading, bool upright) {
  const double length = shape.length, height = shape.height, start = shape.start, cover = shape.cover;
  const auto& electrode = shape.electrode;
  if (!(length > 0 && height > 0 && cover >= 0 && 2 * cover < height && 0 <= electrode[0] &&
        electrode[0] < electrode[1] && electrode[1] <= length))
    throw std::invalid_argument(
        fmt::format("a slab of {:.6g} m x {:.6g} m has no electrode from {:.6g} m to {:.6g} m with covers of "
                    "{:.6g} m",
                    length, height, electrode[0], electrode[1], cover));
  if (across < 1 || !(grading >= 1))
    throw std::invalid_argument("a slab needs an element across it, and a grading of at least 1");
  const double size = std::min(length, height) / across, coarsest = grading * size;
  std::vector<double> along{0}, fine, layers{0};
  for (const double end : electrode)
    if (end > 0 && end < length) {
      along.push_back(end);
      fine.push_back(end);
    }
  along.push_back(length);
  if (cover > 0) layers.insert(layers.end(), {cover, height - cover});
  layers.push_back(height);
  const bool tall = height > length;
  const double longest = std::min(coarsest, std::max(length, height) / fewest(across));
  TriangleGrid grid(tall ? graded_line(along, {}, size, size) : graded_line(along, fine, size, longest),
                    graded_line(layers, {}, size, tall ? longest : size), [&](double x, double y) {
                      return upright ? Eigen::Vector3d(start + x, 0, y) : Eigen::Vector3d(start + x, y, 0);
                    });
  const auto charged = [&](double x, double y) {
    return x > electrode[0] && x < electrode[1] && y > cover && y < height - cover;
  };
  grid.name_triangles("film", [](double, double) { return true; });
  grid.name_triangles("electrode", charged);
  grid.name_triangles("passive", [&](double x, double y) { return !charged(x, y); });
  grid.name_nodes("left", [](double x, double) { return x == 0; });
  grid.name_nodes("right", [&](double x, double) { return x == length; });
  grid.name_nodes("bottom", [](double, double y) { return y == 0; });
  grid.name_nodes("top", [&](double, double y) { return y == height; });
  const auto along_electrode = [&](double x) { return x >= electrode[0] && x <= electrode[1]; };
  grid.name_nodes("lower_electrode", [&](double x, double y) { return along_electrode(x) && y == cover; });
  grid.name_nodes("upper_electrode",
                  [&](double x, double y) { return along_electrode(x) && y == height - cover; });
  return grid.take();
}

Mesh block_mesh(const BlockShape& shape, int across, double grading) {
  const double half = shape.width / 2, charged = shape.electrode_width / 2;
  if (!(charged > 0 && charged <= half))
    throw std::invalid_argument(fmt::format("a slab {:.6g} m wide has no electrode {:.6g} m wide",
                                            shape.width, shape.electrode_width));
  const Mesh drawing = slab_mesh(shape.slab, across, grading, false);
  const double size = std::min(shape.slab.length, shape.slab.height) / across;
  std::vector<double> breaks{-half};
  if (charged < half) breaks.insert(breaks.end(), {-charged, charged});
  breaks.push_back(half);
  const std::vector<double> levels =
      graded_line(breaks, {-charged, charged}, size, std::min(grading * size, shape.width / fewest(across)));
  Mesh mesh = extruded(
      drawing, levels, [](const Eigen::Vector3d& x, double z) { return Eigen::Vector3d(x.x(), x.y(), z); },
      "back", "front");
  if (charged == half) return mesh;
  const int per_level = 3 * drawing.blocks[0].size();
  const auto beside = [&](int cell) {
    const auto level = static_cast<std::size_t>(cell / per_level);
    return std::abs(levels[level] + levels[level + 1]) / 2 > charged;
  };
  std::vector<int>& under = mesh.cell_sets.at("electrode").cells;
  std::vector<int>& passive = mesh.cell_sets["passive"].cells;
  std::ranges::copy_if(under, std::back_inserter(passive), beside);
  std::erase_if(under, beside);
  std::ranges::sort(passive);
  for (const char* name : {"electrode", "passive"})
    mesh.node_sets[name] = nodes_of(mesh, mesh.cell_sets.at(name));
  for (const char* name : {"lower_electrode", "upper_electrode"})
    std::erase_if(mesh.node_sets.at(name), [&](int node) {
      return std::abs(mesh.nodes[static_cast<std::size_t>(node)].z()) > charged;
    });
  return mesh;
}

namespace {

/// Of the elements of a sphere's wall: length over height.
constexpr double slenderness = 2;

/// Where the elements of a sphere's wall end, and the angle that they take.
struct SphereSteps {
  std::vector<double> radii; ///< m, ascending
  double angle = 0;
};

/// Equal steps; of a thick wall equal ratios, as strains and fields go with powers of the radius.
SphereSteps steps_through(double inner_radius, double outer_radius, int across) {
  if (!(inner_radius > 0 && outer_radius > inner_radius))
    throw std::invalid_argument("a hollow sphere needs an inner radius above 0 and a larger outer one");
  if (across < 1) throw std::invalid_argument("a hollow sphere needs an element across its wall");
  constexpr double thick = 2; // outer over inner radius
  const double size = (outer_radius - inner_radius) / across, ratio = outer_radius / inner_radius;
  if (ratio <= thick)
    return {graded_line({inner_radius, outer_radius}, {}, size, size),
            slenderness * size / ((outer_radius + inner_radius) / 2)};
  SphereSteps steps{{inner_radius}, std::min(slenderness * std::log(ratio) / across, std::numbers::pi / 4)};
  for (int k = 1; k < across; ++k)
    steps.radii.push_back(inner_radius * std::pow(ratio, static_cast<double>(k) / across));
  steps.radii.push_back(outer_radius);
  return steps;
}

/// The eighth of the unit sphere, each side of it divided into `parts`.
Mesh eighth_of_sphere(int parts) {
  const int lines = 2 * parts; // of nodes: corners and middles
  Mesh mesh;
  mesh.blocks = {{CellType::triangle6, {}}};
  std::vector<std::vector<int>> number(static_cast<std::size_t>(lines) + 1);
  for (int j = 0; j <= lines; ++j)
    for (int i = 0; i + j <= lines; ++i) {
      number[static_cast<std::size_t>(j)].push_back(mesh.node_count());
      mesh.nodes.push_back(Eigen::Vector3d(lines - i - j, i, j).normalized());
    }
  const auto add = [&](std::array<std::array<int, 2>, 3> corner) {
    const auto push = [&](int i, int j) {
      mesh.blocks[0].nodes.push_back(number[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)]);
    };
    for (const auto& [i, j] : corner) push(i, j);
    for (std::size_t k = 0; k < 3; ++k)
      push((corner[k][0] + corner[(k + 1) % 3][0]) / 2, (corner[k][1] + corner[(k + 1) % 3][1]) / 2);
  };
  for (int j = 0; j < lines; j += 2)
    for (int i = 0; i + j < lines; i += 2) {
      add({{{i, j}, {i + 2, j}, {i, j + 2}}});
      if (i + j + 2 < lines) add({{{i + 2, j}, {i + 2, j + 2}, {i, j + 2}}});
    }
  CellSet& film = mesh.cell_sets["film"];
  for (int cell = 0; cell < mesh.blocks[0].size(); ++cell) film.cells.push_back(cell);
  mesh.node_sets["film"] = nodes_of(mesh, film);
  const std::array<const char*, 3> planes{"side_x", "side_y", "equator"};
  for (int n = 0; n < mesh.node_count(); ++n)
    for (int c = 0; c < 3; ++c)
      if (mesh.nodes[static_cast<std::size_t>(n)][c] == 0)
        mesh.node_sets[planes[static_cast<std::size_t>(c)]].push_back(n);
  return mesh;
}

} // namespace

Mesh sphere_eighth_mesh(double inner_radius, double outer_radius, int across) {
  const SphereSteps steps = steps_through(inner_radius, outer_radius, across);
  const int parts = std::max(2, static_cast<int>(std::lround(std::numbers::pi / 2 / steps.angle)));
  return extruded(
      eighth_of_sphere(parts), steps.radii,
      [](const Eigen::Vector3d& towards, double radius) -> Eigen::Vector3d { return radius * towards; },
      "inner", "outer");
}

Mesh hollow_sphere_mesh(double inner_radius, double outer_radius, int across) {
  constexpr double pole = std::numbers::pi / 2;
  const SphereSteps steps = steps_through(inner_radius, outer_radius, across);
  const std::vector<double> turn = graded_line({-pole, 0, pole}, {}, 1, steps.angle);
  TriangleGrid grid(steps.radii, turn, [&](double radius, double latitude) {
    const double x = std::abs(latitude) == pole ? 0 : radius * std::cos(latitude);
    return Eigen::Vector3d(x, 0, radius * std::sin(latitude));
  });
  grid.name_triangles("film", [](double, double) { return true; });
  grid.name_nodes("inner", [&](double radius, double) { return radius == inner_radius; });
  grid.name_nodes("outer", [&](double radius, double) { return radius == outer_radius; });
  grid.name_nodes("equator", [](double, double latitude) { return latitude == 0; });
  grid.name_nodes("south", [](double, double latitude) { return latitude == -pole; });
  grid.name_nodes("north", [](double, double latitude) { return latitude == pole; });
  return grid.take();
}

} // namespace dielast::meshing
