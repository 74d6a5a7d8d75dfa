// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/extruded.hpp"

#include "meshing/middle_nodes.hpp"
#include "meshing/solids/grid.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

namespace dielast::meshing {

namespace {

/// A corner of a prism: which of its triangle's corners, on its lower (0) or upper (1) level.
struct Corner {
  std::size_t at;
  int up;
};

/// Three tetrahedra of a prism whose triangle's corners are `order`ed: along the path from the first corner
/// below to the last above, rising at each of them in turn. Where it `falls` the prism stands on its head.
std::array<std::array<Corner, 4>, 3> tetrahedra(const std::array<std::size_t, 3>& order, bool falls) {
  const int below = falls ? 1 : 0, above = 1 - below;
  const auto [a, b, c] = order;
  return {{{{{a, below}, {b, below}, {c, below}, {c, above}}},
           {{{a, below}, {b, below}, {b, above}, {c, above}}},
           {{{a, below}, {a, above}, {b, above}, {c, above}}}}};
}

/// Number of a triangle's node on or half way between its corners.
std::size_t between(std::size_t a, std::size_t b) {
  if (a == b) return a;
  return (a + 1) % 3 == b ? 3 + a : 3 + b;
}

} // namespace

Mesh extruded(const Mesh& drawing, const std::vector<double>& levels,
              const std::function<Eigen::Vector3d(const Eigen::Vector3d& drawn, double level)>& place,
              const std::string& lowest, const std::string& highest) {
  if (drawing.blocks.size() != 1 || drawing.blocks[0].type != CellType::triangle6 || levels.size() < 2)
    throw std::invalid_argument("6-node triangles alone are drawn out, along two levels at least");
  const CellBlock& triangles = drawing.blocks[0];
  const std::vector<double> all_levels = with_middles(levels);
  const int each = drawing.node_count(), count = triangles.size();
  Mesh mesh;
  for (const double level : all_levels)
    for (const Eigen::Vector3d& x : drawing.nodes) mesh.nodes.push_back(place(x, level));
  mesh.blocks = {{CellType::tetrahedron10, {}}};
  const auto node = [&](std::size_t l, int cell, std::size_t own, int twice_up) {
    return (2 * static_cast<int>(l) + twice_up) * each + triangles.cell(cell)[own];
  };
  std::vector<int>& nodes = mesh.blocks[0].nodes;
  for (std::size_t l = 0; l + 1 < levels.size(); ++l)
    for (int cell = 0; cell < count; ++cell) {
      std::array<std::size_t, 3> order{0, 1, 2};
      std::ranges::sort(order, {}, [&](std::size_t corner) { return triangles.cell(cell)[corner]; });
      for (auto tetrahedron : tetrahedra(order, l % 2 == 1)) {
        const auto at = [&](std::size_t k) -> const Eigen::Vector3d& {
          return mesh
              .nodes[static_cast<std::size_t>(node(l, cell, tetrahedron[k].at, 2 * tetrahedron[k].up))];
        };
        if ((at(1) - at(0)).cross(at(2) - at(0)).dot(at(3) - at(0)) < 0)
          std::swap(tetrahedron[0], tetrahedron[1]);
        for (const Corner& corner : tetrahedron) nodes.push_back(node(l, cell, corner.at, 2 * corner.up));
        for (const auto& [a, b] : side_ends) {
          const Corner &from = tetrahedron[a], &to = tetrahedron[b];
          nodes.push_back(node(l, cell, between(from.at, to.at), from.up + to.up));
        }
      }
    }
  for (const auto& [name, set] : drawing.cell_sets) {
    std::vector<int>& cells = mesh.cell_sets[name].cells;
    for (std::size_t l = 0; l + 1 < levels.size(); ++l)
      for (const int cell : set.cells)
        for (int k = 0; k < 3; ++k) cells.push_back(3 * (static_cast<int>(l) * count + cell) + k);
  }
  for (const auto& [name, set] : drawing.node_sets)
    for (int k = 0; k < std::ssize(all_levels); ++k)
      for (const int n : set) mesh.node_sets[name].push_back(k * each + n);
  std::vector<int> level(static_cast<std::size_t>(each));
  std::iota(level.begin(), level.end(), 0);
  mesh.node_sets[lowest] = level;
  for (int& n : level) n += (static_cast<int>(all_levels.size()) - 1) * each;
  mesh.node_sets[highest] = std::move(level);
  return mesh;
}

} // namespace dielast::meshing
