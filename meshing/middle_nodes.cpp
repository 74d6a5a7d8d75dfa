// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/middle_nodes.hpp"

#include <algorithm>
#include <utility>

namespace dielast::meshing {

namespace {

using Side = std::pair<int, int>;

Side side_of(std::span<const int> cell, std::size_t k) {
  return std::minmax(cell[side_ends[k][0]], cell[side_ends[k][1]]);
}

std::size_t sides_per_cell(CellType type) { return type == CellType::line2 ? 1 : is_triangle(type) ? 3 : 6; }

} // namespace

void add_middle_nodes(Mesh& mesh) {
  std::vector<Side> sides;
  for (const CellBlock& block : mesh.blocks)
    for (int c = 0; c < block.size(); ++c)
      for (std::size_t k = 0; k < sides_per_cell(block.type); ++k) sides.push_back(side_of(block.cell(c), k));
  std::ranges::sort(sides);
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());

  const int corners = mesh.node_count();
  mesh.nodes.reserve(mesh.nodes.size() + sides.size());
  for (const auto& [a, b] : sides) mesh.nodes.push_back((mesh.nodes[a] + mesh.nodes[b]) / 2);

  for (CellBlock& block : mesh.blocks) {
    std::vector<int> nodes;
    nodes.reserve(2 * block.nodes.size());
    for (int c = 0; c < block.size(); ++c) {
      const auto cell = block.cell(c);
      nodes.insert(nodes.end(), cell.begin(), cell.end());
      for (std::size_t k = 0; k < sides_per_cell(block.type); ++k) {
        const auto side = std::ranges::lower_bound(sides, side_of(cell, k));
        nodes.push_back(corners + static_cast<int>(side - sides.begin()));
      }
    }
    block = {block.type == CellType::line2       ? CellType::line3
             : block.type == CellType::triangle3 ? CellType::triangle6
                                                 : CellType::tetrahedron10,
             std::move(nodes)};
  }
}

std::vector<int> nodes_of(const Mesh& mesh, const CellSet& set) {
  std::vector<int> nodes;
  for (const int c : set.cells) {
    const auto cell = mesh.blocks[set.block].cell(c);
    nodes.insert(nodes.end(), cell.begin(), cell.end());
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void add_node_sets(Mesh& mesh) {
  for (const auto& [place, set] : mesh.cell_sets) mesh.node_sets[place] = nodes_of(mesh, set);
}

} // namespace dielast::meshing
