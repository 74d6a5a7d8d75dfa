// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace dielast::test {

/// A mesh of 3-node triangles as gmsh writes it, version 2.2, in mm: its film, a place of the film and an
/// edge.
inline std::string gmsh_text(const meshing::Mesh& mesh, const std::string& surface, const std::string& edge) {
  const meshing::CellBlock& film = *mesh.film();
  const auto& inside = mesh.cell_sets.at(surface).cells;
  const auto& rim = mesh.node_sets.at(edge);
  std::string text = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"{}\"\n2 2 "
                                 "\"film\"\n2 3 \"{}\"\n$EndPhysicalNames\n$Nodes\n{}\n",
                                 edge, surface, mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    text += fmt::format("{} {:.17g} {:.17g} 0\n", n + 1, mesh.nodes[n].x() * 1000, mesh.nodes[n].y() * 1000);
  std::string elements;
  int count = 0;
  const auto on_rim = [&](int node) { return std::ranges::binary_search(rim, node); };
  for (int c = 0; c < film.size(); ++c) {
    const auto cell = film.cell(c);
    const bool within = std::ranges::binary_search(inside, c);
    std::string nodes;
    for (const int node : cell) nodes += fmt::format(" {}", node + 1);
    // in both groups where it is in both: such files repeat the triangle
    elements += fmt::format("{} 2 2 2 {}{}\n", ++count, within ? 2 : 1, nodes);
    if (within) elements += fmt::format("{} 2 2 3 2{}\n", ++count, nodes);
    for (std::size_t k = 0; k < 3; ++k)
      if (on_rim(cell[k]) && on_rim(cell[(k + 1) % 3]))
        elements += fmt::format("{} 1 2 1 1 {} {}\n", ++count, cell[k] + 1, cell[(k + 1) % 3] + 1);
  }
  return text + fmt::format("$EndNodes\n$Elements\n{}\n{}$EndElements\n", count, elements);
}

} // namespace dielast::test
