// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/sides.hpp"

#include "meshing/mesh_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace dielast::meshing {

namespace {

struct LocalSide {
  std::array<std::size_t, 6> nodes;
  std::size_t corners, count;
};

std::vector<LocalSide> sides_of(CellType type) {
  switch (type) {
  case CellType::meridian2:
  case CellType::meridian3:
    return {{{0}, 1, 1}, {{1}, 1, 1}};
  case CellType::triangle3:
    return {{{0, 1}, 2, 2}, {{1, 2}, 2, 2}, {{2, 0}, 2, 2}};
  case CellType::triangle6:
    return {{{0, 1, 3}, 2, 3}, {{1, 2, 4}, 2, 3}, {{2, 0, 5}, 2, 3}};
  case CellType::tetrahedron4:
    return {{{0, 2, 1}, 3, 3}, {{0, 1, 3}, 3, 3}, {{1, 2, 3}, 3, 3}, {{2, 0, 3}, 3, 3}};
  case CellType::tetrahedron10:
    return {{{0, 2, 1, 6, 5, 4}, 3, 6},
            {{0, 1, 3, 4, 8, 7}, 3, 6},
            {{1, 2, 3, 5, 9, 8}, 3, 6},
            {{2, 0, 3, 6, 7, 9}, 3, 6}};
  default:
    throw std::logic_error("lines have no sides");
  }
}

} // namespace

std::vector<OuterSide> outer_sides(const CellBlock& block) {
  struct Keyed {
    std::array<int, 3> corners; // ascending
    OuterSide side;
  };
  const std::vector<LocalSide> sides = sides_of(block.type);
  std::vector<Keyed> all;
  all.reserve(sides.size() * static_cast<std::size_t>(block.size()));
  for (int cell = 0; cell < block.size(); ++cell)
    for (const LocalSide& local : sides) {
      Keyed keyed{{-1, -1, -1}, {cell, {}, local.corners, local.count}};
      for (std::size_t k = 0; k < local.count; ++k) keyed.side.own[k] = block.cell(cell)[local.nodes[k]];
      std::ranges::copy(keyed.side.corners(), keyed.corners.begin());
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

namespace {

/// Those whose nodes are all in the place.
std::vector<OuterSide> outer_sides_at(const Mesh& mesh, const std::string& place, CellType type) {
  const std::vector<int>& nodes = mesh.node_sets.at(place);
  std::vector<OuterSide> found;
  for (const CellBlock& block : mesh.blocks)
    if (block.type == type)
      std::ranges::copy_if(outer_sides(block), std::back_inserter(found), [&](const OuterSide& side) {
        return std::ranges::all_of(side.nodes(),
                                   [&](int node) { return std::ranges::binary_search(nodes, node); });
      });
  if (found.empty()) throw MeshError(fmt::format("the place \"{}\" is no surface of a solid", place));
  return found;
}

} // namespace

CellBlock faces_at(const Mesh& mesh, const std::string& place) {
  CellBlock faces{CellType::triangle6, {}};
  for (const auto& [cell, own, corners, count] : outer_sides_at(mesh, place, CellType::tetrahedron10))
    faces.nodes.insert(faces.nodes.end(), {own[0], own[2], own[1], own[5], own[4], own[3]});
  return faces;
}

bool is_closed(const CellBlock& triangles) { return outer_sides(triangles).empty(); }

CellBlock sides_at(const Mesh& mesh, const std::string& place, CellType type) {
  CellBlock sides{type, {}};
  for (const auto& [cell, own, corners, count] : outer_sides_at(mesh, place, CellType::triangle6))
    sides.nodes.insert(sides.nodes.end(), {own[1], own[0], own[2]});
  return sides;
}

} // namespace dielast::meshing
