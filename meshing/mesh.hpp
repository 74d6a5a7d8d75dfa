// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <map>
#include <span>
#include <string>
#include <vector>

namespace dielast::meshing {

/// Cell types; the node order is VTK's: corners first, then the middles of the sides
/// (triangle6: v0 v1 v2 m01 m12 m20; line3, meridian3: v0 v1 middle; tetrahedron10: v0 v1 v2 v3 m01 m12 m20
/// m03 m13 m23). Triangles turn counter-clockwise about +z. Lines are walls. Meridians are pieces of a film
/// of revolution: curves in the plane y = 0, x >= 0, revolved about the z axis. Rods are straight pieces of
/// film that is rolled or folded to a bar. Of tetrahedra (v1 - v0) x (v2 - v0) points towards v3.
enum class CellType {
  line2,
  line3,
  triangle3,
  triangle6,
  meridian2,
  meridian3,
  rod2,
  tetrahedron4,
  tetrahedron10
};

constexpr int nodes_per_cell(CellType type) {
  switch (type) {
  case CellType::line2:
    return 2;
  case CellType::line3:
    return 3;
  case CellType::triangle3:
    return 3;
  case CellType::triangle6:
    return 6;
  case CellType::meridian2:
    return 2;
  case CellType::meridian3:
    return 3;
  case CellType::rod2:
    return 2;
  case CellType::tetrahedron4:
    return 4;
  case CellType::tetrahedron10:
    return 10;
  }
  return 0;
}

constexpr bool is_line(CellType type) { return type == CellType::line2 || type == CellType::line3; }
constexpr bool is_meridian(CellType type) {
  return type == CellType::meridian2 || type == CellType::meridian3;
}
constexpr bool is_triangle(CellType type) {
  return type == CellType::triangle3 || type == CellType::triangle6;
}
constexpr bool is_tetrahedron(CellType type) {
  return type == CellType::tetrahedron4 || type == CellType::tetrahedron10;
}
/// Corners, or ends: the nodes that are no middles.
constexpr int corners_per_cell(CellType type) { return is_tetrahedron(type) ? 4 : is_triangle(type) ? 3 : 2; }

/// All cells of one type, node numbers one after another.
struct CellBlock {
  CellType type{};
  std::vector<int> nodes;

  int size() const { return static_cast<int>(nodes.size()) / nodes_per_cell(type); }
  std::span<const int> cell(int index) const {
    const int n = nodes_per_cell(type);
    return {nodes.data() + static_cast<std::ptrdiff_t>(index) * n, static_cast<std::size_t>(n)};
  }
};

/// Cells of a block as a block of their own, in the order of `cells`.
inline CellBlock subset(const CellBlock& block, std::span<const int> cells) {
  CellBlock part{block.type, {}};
  for (const int cell : cells)
    part.nodes.insert(part.nodes.end(), block.cell(cell).begin(), block.cell(cell).end());
  return part;
}

/// A named part of one block.
struct CellSet {
  int block = 0;          ///< index into Mesh::blocks
  std::vector<int> cells; ///< cell numbers in that block, ascending
};

/// Nodes (coordinates in m, in the configuration the mesh was drawn in), cell blocks, at most one per type,
/// and named places. Every place has an entry in `node_sets` (ascending, middle nodes included); places that
/// are lines or surfaces also have one in `cell_sets`.
struct Mesh {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<CellBlock> blocks;
  std::map<std::string, std::vector<int>> node_sets;
  std::map<std::string, CellSet> cell_sets;

  /// Cells of a place that are in that block of this mesh (null: none is); null where the place has none
  /// there.
  const std::vector<int>* cells_of(const std::string& place, const CellBlock* block) const {
    const auto found = cell_sets.find(place);
    const bool there =
        found != cell_sets.end() && &blocks[static_cast<std::size_t>(found->second.block)] == block;
    return there ? &found->second.cells : nullptr;
  }
  /// The smallest box along the axes that holds all nodes.
  Eigen::AlignedBox3d bounds() const {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& x : nodes) box.extend(x);
    return box;
  }
  int node_count() const { return static_cast<int>(nodes.size()); }
  /// The block of triangles, tetrahedra, meridians or rods, of lines; null when there is none.
  const CellBlock* film() const { return find_block(false); }
  const CellBlock* walls() const { return find_block(true); }

 private:
  const CellBlock* find_block(bool of_lines) const {
    for (const CellBlock& block : blocks)
      if (is_line(block.type) == of_lines && block.size() > 0) return &block;
    return nullptr;
  }
};

} // namespace dielast::meshing
