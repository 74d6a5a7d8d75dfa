// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <array>
#include <span>
#include <vector>

namespace dielast::meshing {

/// A side that no other cell of a block has: a triangle of tetrahedra, counter-clockwise seen from outside;
/// an edge of triangles, which lie on its left; an end of meridians.
struct OuterSide {
  int cell;
  std::array<int, 6> own{}; ///< corners, then the nodes between them
  std::size_t corner_count = 0, node_count = 0;

  std::span<const int> nodes() const { return std::span(own).first(node_count); }
  std::span<const int> corners() const { return nodes().first(corner_count); }
  std::span<const int> middles() const { return nodes().subspan(corner_count); }
};
/// In the order of the cells: triangles, tetrahedra or meridians of any number of nodes.
std::vector<OuterSide> outer_sides(const CellBlock& block);

/// Outer sides of the mesh's 10-node tetrahedra whose nodes are in a place, clockwise seen from outside, such
/// that their normals point into the solid. Throws MeshError where the place has none.
CellBlock faces_at(const Mesh& mesh, const std::string& place);

/// Whether each side of these 6-node triangles is that of another one, too.
bool is_closed(const CellBlock& triangles);

/// Outer sides of the mesh's 6-node triangles whose three nodes are in a place, as cells of a 3-node type,
/// directed such that the triangle lies on their right: seen from what is beyond the side they turn
/// counter-clockwise. Throws MeshError where the place has none.
CellBlock sides_at(const Mesh& mesh, const std::string& place, CellType type);

} // namespace dielast::meshing
