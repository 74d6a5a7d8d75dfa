// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/refine.hpp"

#include "meshing/middle_nodes.hpp"

#include <array>
#include <cassert>

namespace dielast::meshing {

namespace {

/// Nodes of a triangle6 that are the corners of its four parts, of a line3 those of its halves.
constexpr std::array<std::array<int, 3>, 4> quarters{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
constexpr std::array<std::array<int, 2>, 2> halves{{{0, 2}, {2, 1}}};

/// Barycentric coordinates of a triangle6's nodes.
constexpr std::array<std::array<double, 3>, 6> barycentric{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}}};

CellBlock split(const CellBlock& block) {
  CellBlock parts{block.type == CellType::line3 ? CellType::line2 : CellType::triangle3, {}};
  for (int c = 0; c < block.size(); ++c) {
    const auto add = [&, cell = block.cell(c)](const auto& table) {
      for (const auto& part : table)
        for (const int node : part) parts.nodes.push_back(cell[static_cast<std::size_t>(node)]);
    };
    if (block.type == CellType::line3)
      add(halves);
    else
      add(quarters);
  }
  return parts;
}

/// The point half way between two nodes of a triangle6, in its own coordinates.
Eigen::Vector3d between(const Mesh& mesh, std::span<const int> cell, int a, int b) {
  std::array<double, 3> l{};
  for (std::size_t i = 0; i < 3; ++i)
    l[i] = (barycentric[static_cast<std::size_t>(a)][i] + barycentric[static_cast<std::size_t>(b)][i]) / 2;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    x += l[i] * (2 * l[i] - 1) * mesh.nodes[static_cast<std::size_t>(cell[i])];
    x += 4 * l[i] * l[(i + 1) % 3] * mesh.nodes[static_cast<std::size_t>(cell[3 + i])];
  }
  return x;
}

/// Puts the middle nodes of the parts onto the curves of the triangles that they come from.
void bend(const Mesh& whole, const CellBlock& block, const CellBlock& parts, Mesh& mesh) {
  for (int c = 0; c < block.size(); ++c)
    for (int q = 0; q < 4; ++q) {
      const auto part = parts.cell(4 * c + q);
      const auto& corners = quarters[static_cast<std::size_t>(q)];
      for (std::size_t side = 0; side < 3; ++side)
        mesh.nodes[static_cast<std::size_t>(part[3 + side])] =
            between(whole, block.cell(c), corners[side], corners[(side + 1) % 3]);
    }
}

} // namespace

Mesh refined(Mesh mesh) {
  bool middles = true;
  for (const CellBlock& block : mesh.blocks) {
    assert(!is_meridian(block.type));
    middles = middles && (block.type == CellType::line3 || block.type == CellType::triangle6);
  }
  if (!middles) add_middle_nodes(mesh);
  Mesh finer = mesh;
  for (CellBlock& block : finer.blocks) block = split(block);
  for (auto& [place, set] : finer.cell_sets) {
    const int each = is_line(finer.blocks[static_cast<std::size_t>(set.block)].type) ? 2 : 4;
    std::vector<int> parts;
    for (const int cell : set.cells)
      for (int k = 0; k < each; ++k) parts.push_back(each * cell + k);
    set.cells = std::move(parts);
  }
  if (middles) {
    add_middle_nodes(finer);
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
      if (mesh.blocks[b].type == CellType::triangle6) bend(mesh, mesh.blocks[b], finer.blocks[b], finer);
  }
  add_node_sets(finer);
  return finer;
}

} // namespace dielast::meshing
