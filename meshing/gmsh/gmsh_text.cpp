// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/gmsh_text.hpp"

#include <fmt/format.h>

#include <iterator>
#include <vector>

namespace dielast::meshing {

namespace {

/// gmsh's number of a cell type, and its dimension. Both number middle nodes in the same order, but for the
/// last two of a tetrahedron.
struct ElementType {
  int number, dimension;
};

ElementType element_type(CellType type) {
  switch (type) {
  case CellType::line2:
  case CellType::rod2:
    return {1, 1};
  case CellType::line3:
    return {8, 1};
  case CellType::triangle3:
    return {2, 2};
  case CellType::tetrahedron4:
    return {4, 3};
  case CellType::tetrahedron10:
    return {11, 3};
  default:
    return {9, 2};
  }
}

constexpr ElementType point{15, 0};

} // namespace

std::string gmsh_text(const Mesh& mesh) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n";
  const auto out = std::back_inserter(text);
  std::vector<std::string> elements;
  const auto add = [&](ElementType type, std::size_t group, std::span<const int> nodes) {
    std::string line = fmt::format("{} {} 2 {} {}", elements.size() + 1, type.number, group, group);
    std::vector<int> own(nodes.begin(), nodes.end());
    if (own.size() == 10) std::swap(own[8], own[9]);
    for (const int node : own) line += fmt::format(" {}", node + 1);
    elements.push_back(std::move(line));
  };
  fmt::format_to(out, "{}\n", mesh.node_sets.size());
  std::size_t group = 0;
  for (const auto& [place, nodes] : mesh.node_sets) {
    ++group;
    ElementType type = point;
    if (const auto cells = mesh.cell_sets.find(place); cells == mesh.cell_sets.end()) {
      for (const int node : nodes) add(type, group, {&node, 1});
    } else {
      const CellBlock& block = mesh.blocks[static_cast<std::size_t>(cells->second.block)];
      type = element_type(block.type);
      for (const int cell : cells->second.cells) add(type, group, block.cell(cell));
    }
    fmt::format_to(out, "{} {} \"{}\"\n", type.dimension, group, place);
  }
  fmt::format_to(out, "$EndPhysicalNames\n$Nodes\n{}\n", mesh.node_count());
  for (int n = 0; n < mesh.node_count(); ++n) {
    const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(n)];
    fmt::format_to(out, "{} {} {} {}\n", n + 1, x.x(), x.y(), x.z());
  }
  fmt::format_to(out, "$EndNodes\n$Elements\n{}\n", elements.size());
  for (const std::string& line : elements) fmt::format_to(out, "{}\n", line);
  text += "$EndElements\n";
  return text;
}

} // namespace dielast::meshing
