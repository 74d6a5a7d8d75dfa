// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/sides.hpp"

#include "meshing/mesh_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace dielast::meshing {

std::vector<OuterSide> outer_sides(const CellBlock& tetrahedra) {
  // Corners of the sides as seen from outside, and the middles between them.
  constexpr std::array<std::array<std::size_t, 6>, 4> own{
      {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {2, 0, 3, 6, 7, 9}}};
  struct Keyed {
    std::array<int, 3> corners;
    OuterSide side;
  };
  std::vector<Keyed> all;
  for (int cell = 0; cell < tetrahedra.size(); ++cell)
    for (const auto& local : own) {
      Keyed keyed{{}, {cell, {}}};
      for (std::size_t k = 0; k < 6; ++k) keyed.side.nodes[k] = tetrahedra.cell(cell)[local[k]];
      std::copy_n(keyed.side.nodes.begin(), 3, keyed.corners.begin());
      std::ranges::sort(keyed.corners);
      all.push_back(keyed);
    }
  std::ranges::stable_sort(all, {}, &Keyed::corners);
  std::vector<OuterSide> outer;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t next = i + 1;
    while (next < all.size() && all[next].corners == all[i].corners) ++next;
    if (next == i + 1) outer.push_back(all[i].side);
    i = next;
  }
  std::ranges::stable_sort(outer, {}, &OuterSide::cell);
  return outer;
}

CellBlock faces_at(const Mesh& mesh, const std::string& place) {
  const std::vector<int>& nodes = mesh.node_sets.at(place);
  CellBlock faces{CellType::triangle6, {}};
  for (const CellBlock& block : mesh.blocks)
    if (block.type == CellType::tetrahedron10)
      for (const auto& [cell, own] : outer_sides(block))
        if (std::ranges::all_of(own, [&](int node) { return std::ranges::binary_search(nodes, node); }))
          faces.nodes.insert(faces.nodes.end(), {own[0], own[2], own[1], own[5], own[4], own[3]});
  if (faces.nodes.empty()) throw MeshError(fmt::format("the place \"{}\" is no surface of a solid", place));
  return faces;
}

bool is_closed(const CellBlock& triangles) {
  std::map<int, int> count; // at each middle node
  for (int cell = 0; cell < triangles.size(); ++cell)
    for (const int middle : triangles.cell(cell).last(3)) ++count[middle];
  return std::ranges::all_of(count, [](const auto& side) { return side.second == 2; });
}

CellBlock sides_at(const Mesh& mesh, const std::string& place, CellType type) {
  const std::vector<int>& nodes = mesh.node_sets.at(place);
  std::map<int, int> triangles; // at each middle node
  std::vector<std::array<int, 3>> found;
  for (const CellBlock& block : mesh.blocks) {
    if (block.type != CellType::triangle6) continue;
    for (int cell = 0; cell < block.size(); ++cell) {
      const auto own = block.cell(cell);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::array<int, 3> side{own[(k + 1) % 3], own[k], own[3 + k]};
        ++triangles[side[2]];
        if (std::ranges::all_of(side, [&](int node) { return std::ranges::binary_search(nodes, node); }))
          found.push_back(side);
      }
    }
  }
  CellBlock sides{type, {}};
  for (const auto& side : found)
    if (triangles.at(side[2]) == 1) sides.nodes.insert(sides.nodes.end(), side.begin(), side.end());
  if (sides.nodes.empty()) throw MeshError(fmt::format("the place \"{}\" is no surface of a solid", place));
  return sides;
}

} // namespace dielast::meshing
