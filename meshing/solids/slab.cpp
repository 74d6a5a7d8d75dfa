// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/slab.hpp"

#include "meshing/solids/grid.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

namespace dielast::meshing {

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
  const double size = height / across;
  std::vector<double> along{0}, fine, layers{0};
  for (const double end : electrode)
    if (end > 0 && end < length) {
      along.push_back(end);
      fine.push_back(end);
    }
  along.push_back(length);
  if (cover > 0) layers.insert(layers.end(), {cover, height - cover});
  layers.push_back(height);
  TriangleGrid grid(graded_line(along, fine, size, grading * size), graded_line(layers, {}, size, size),
                    [&](double x, double y) {
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
  return grid.take();
}

Mesh hollow_sphere_mesh(double inner_radius, double outer_radius, int across) {
  if (!(inner_radius > 0 && outer_radius > inner_radius))
    throw std::invalid_argument("a hollow sphere needs an inner radius above 0 and a larger outer one");
  if (across < 1) throw std::invalid_argument("a hollow sphere needs an element across its wall");
  constexpr double slenderness = 2, pole = std::numbers::pi / 2;
  const double size = (outer_radius - inner_radius) / across, middle = (outer_radius + inner_radius) / 2;
  const std::vector<double> wall = graded_line({inner_radius, outer_radius}, {}, size, size),
                            turn = graded_line({-pole, 0, pole}, {}, 1, slenderness * size / middle);
  TriangleGrid grid(wall, turn, [&](double radius, double latitude) {
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
