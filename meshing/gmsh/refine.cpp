// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/refine.hpp"

#include "meshing/middle_nodes.hpp"
#include "meshing/solids/sides.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <set>
#include <utility>

namespace dielast::meshing {

namespace {

/// Nodes of a triangle6 that are the corners of its four parts, of a line3 those of its halves.
constexpr std::array<std::array<int, 3>, 4> quarters{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
constexpr std::array<std::array<int, 2>, 2> halves{{{0, 2}, {2, 1}}};
/// Of a tetrahedron10: its four corners, and the octahedron between them, split along a diagonal.
constexpr std::array<std::array<int, 4>, 8> eighths{{{0, 4, 6, 7},
                                                     {4, 1, 5, 8},
                                                     {6, 5, 2, 9},
                                                     {7, 8, 9, 3},
                                                     {6, 8, 4, 5},
                                                     {6, 8, 5, 9},
                                                     {6, 8, 9, 7},
                                                     {6, 8, 7, 4}}};

int parts_of(CellType type) { return is_line(type) ? 2 : is_triangle(type) ? 4 : 8; }

CellBlock split(const CellBlock& block) {
  CellBlock parts{block.type == CellType::line3       ? CellType::line2
                  : block.type == CellType::triangle6 ? CellType::triangle3
                                                      : CellType::tetrahedron4,
                  {}};
  for (int c = 0; c < block.size(); ++c) {
    const auto add = [&, cell = block.cell(c)](const auto& table) {
      for (const auto& part : table)
        for (const int node : part) parts.nodes.push_back(cell[static_cast<std::size_t>(node)]);
    };
    if (block.type == CellType::line3)
      add(halves);
    else if (block.type == CellType::triangle6)
      add(quarters);
    else
      add(eighths);
  }
  return parts;
}

/// Barycentric coordinates of a node of a triangle6 or a tetrahedron10.
Eigen::Vector4d barycentric(std::size_t corners, int node) {
  Eigen::Vector4d l = Eigen::Vector4d::Zero();
  const auto n = static_cast<std::size_t>(node);
  if (n < corners) return Eigen::Vector4d::Unit(node);
  for (const std::size_t end : side_ends[n - corners]) l[static_cast<int>(end)] = 0.5;
  return l;
}

/// The point half way between two nodes of a cell, in its own coordinates.
Eigen::Vector3d between(const Mesh& mesh, std::span<const int> cell, int a, int b) {
  const std::size_t corners = cell.size() == 6 ? 3 : 4;
  const Eigen::Vector4d l = (barycentric(corners, a) + barycentric(corners, b)) / 2;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners; ++i) {
    const double li = l[static_cast<int>(i)];
    x += li * (2 * li - 1) * mesh.nodes[static_cast<std::size_t>(cell[i])];
  }
  for (std::size_t k = corners; k < cell.size(); ++k) {
    const auto [from, to] = side_ends[k - corners];
    x += 4 * l[static_cast<int>(from)] * l[static_cast<int>(to)] *
         mesh.nodes[static_cast<std::size_t>(cell[k])];
  }
  return x;
}

/// Puts the middle nodes of the halves of lines onto the curves of these.
void bend_lines(const Mesh& whole, const CellBlock& lines, const CellBlock& parts, Mesh& mesh) {
  for (int c = 0; c < lines.size(); ++c)
    for (std::size_t half = 0; half < halves.size(); ++half) {
      const auto at = [&, cell = lines.cell(c)](std::size_t node) {
        return whole.nodes[static_cast<std::size_t>(cell[node])];
      };
      const int middle = parts.cell(2 * c + static_cast<int>(half))[2];
      mesh.nodes[static_cast<std::size_t>(middle)] = 0.375 * at(half) + 0.75 * at(2) - 0.125 * at(1 - half);
    }
}

/// Puts the middle nodes of the parts onto the curves of the cells that they come from.
void bend(const Mesh& whole, const CellBlock& block, const CellBlock& parts, Mesh& mesh) {
  const auto corners = static_cast<std::size_t>(corners_per_cell(block.type));
  const auto bend_part = [&](int c, int part_number, const auto& own) {
    const auto part = parts.cell(part_number);
    for (std::size_t side = 0; side + corners < part.size(); ++side)
      mesh.nodes[static_cast<std::size_t>(part[corners + side])] =
          between(whole, block.cell(c), own[side_ends[side][0]], own[side_ends[side][1]]);
  };
  for (int c = 0; c < block.size(); ++c)
    for (int q = 0; q < parts_of(block.type); ++q)
      if (const auto k = static_cast<std::size_t>(q); corners == 3)
        bend_part(c, 4 * c + q, quarters[k]);
      else
        bend_part(c, 8 * c + q, eighths[k]);
}

using Sides = std::set<std::array<int, 3>>; ///< of cells: two ends, ascending, and the middle

Sides sides_of(const Mesh& mesh) {
  Sides sides;
  for (const CellBlock& block : mesh.blocks)
    for (int c = 0; c < block.size(); ++c) {
      const auto cell = block.cell(c);
      const auto corners = static_cast<std::size_t>(corners_per_cell(block.type));
      for (std::size_t k = 0; k + corners < cell.size(); ++k) {
        const auto [a, b] = std::minmax(cell[side_ends[k][0]], cell[side_ends[k][1]]);
        sides.insert({a, b, cell[corners + k]});
      }
    }
  return sides;
}

/// What is new in places that are given by their nodes alone: what lies on sides, on triangles and on the
/// boundary of tetrahedra all of whose nodes the place has.
class NodePlaces {
 public:
  /// `whole` has all its middle nodes.
  explicit NodePlaces(const Mesh& whole) : sides_(sides_of(whole)) {
    for (const CellBlock& block : whole.blocks) {
      if (is_triangle(block.type)) {
        for (int c = 0; c < block.size(); ++c)
          std::ranges::copy(block.cell(c), triangles_.emplace_back().begin());
        for (const OuterSide& side : outer_sides(block)) {
          edge_.insert(side.nodes().begin(), side.nodes().end());
          edge_middles_.insert(side.middles().begin(), side.middles().end());
        }
      } else if (is_tetrahedron(block.type)) {
        for (const OuterSide& side : outer_sides(block)) triangles_.push_back(side.own);
      }
    }
    for (const auto& triangle : triangles_) middles_.insert(triangle.begin() + 3, triangle.end());
  }

  /// Of places without middle nodes: the middles of sides between two of their nodes. A side that cuts a
  /// corner off the boundary has both ends there, and does not lie there.
  void add_middles(std::vector<int>& place) const {
    const std::set<int> given(place.begin(), place.end());
    for (const auto& [a, b, middle] : sides_)
      if (middles_.contains(middle) && given.contains(a) && given.contains(b) &&
          (edge_middles_.contains(middle) || !edge_.contains(a) || !edge_.contains(b)))
        place.push_back(middle);
  }

  /// Of places with middle nodes; `new_nodes` lie between two others.
  void add_parts(const std::map<std::pair<int, int>, int>& new_nodes, std::vector<int>& place) const {
    const std::set<int> given(place.begin(), place.end());
    const auto add = [&](int a, int b) { place.push_back(new_nodes.at(std::minmax(a, b))); };
    for (const auto& [a, b, middle] : sides_)
      if (given.contains(a) && given.contains(b) && given.contains(middle)) add(a, middle), add(middle, b);
    for (const auto& triangle : triangles_)
      if (std::ranges::all_of(triangle, [&](int node) { return given.contains(node); }))
        for (std::size_t k = 0; k < 3; ++k) add(triangle[3 + k], triangle[3 + (k + 1) % 3]);
  }

 private:
  Sides sides_;
  std::vector<std::array<int, 6>> triangles_; ///< cells, and the boundary of tetrahedra
  std::set<int> middles_;                     ///< of their sides
  std::set<int> edge_, edge_middles_;         ///< of the cells among them
};

} // namespace

Mesh refined(Mesh mesh) {
  bool middles = true;
  for (const CellBlock& block : mesh.blocks) {
    assert(!is_meridian(block.type));
    middles = middles && nodes_per_cell(block.type) > corners_per_cell(block.type);
  }
  if (!middles) add_middle_nodes(mesh);
  Mesh finer = mesh;
  for (CellBlock& block : finer.blocks) block = split(block);
  for (auto& [place, set] : finer.cell_sets) {
    const int each = parts_of(finer.blocks[static_cast<std::size_t>(set.block)].type);
    std::vector<int> parts;
    for (const int cell : set.cells)
      for (int k = 0; k < each; ++k) parts.push_back(each * cell + k);
    set.cells = std::move(parts);
  }
  if (middles) {
    add_middle_nodes(finer);
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
      if (is_line(mesh.blocks[b].type))
        bend_lines(mesh, mesh.blocks[b], finer.blocks[b], finer);
      else
        bend(mesh, mesh.blocks[b], finer.blocks[b], finer);
  }
  const bool loose = std::ranges::any_of(
      finer.node_sets, [&](const auto& place) { return !finer.cell_sets.contains(place.first); });
  if (loose) {
    const NodePlaces places(mesh);
    std::map<std::pair<int, int>, int> new_nodes;
    if (middles)
      for (const auto& [from, to, middle] : sides_of(finer)) new_nodes[{from, to}] = middle;
    for (auto& [place, nodes] : finer.node_sets) {
      if (finer.cell_sets.contains(place)) continue;
      if (middles)
        places.add_parts(new_nodes, nodes);
      else
        places.add_middles(nodes);
      std::ranges::sort(nodes); // a triangle may be one of the boundary of tetrahedra, too
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    }
  }
  add_node_sets(finer);
  return finer;
}

} // namespace dielast::meshing
