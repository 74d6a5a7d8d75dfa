// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/sides.hpp"

#include "meshing/mesh_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace dielast::meshing {

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
