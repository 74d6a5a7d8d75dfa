// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/parts/assembly.hpp"

#include "meshing/mesh_error.hpp"
#include "meshing/middle_nodes.hpp"
#include "meshing/solids/sides.hpp"

#include <Eigen/QR>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>

namespace dielast::meshing {

namespace {

/// The block of `whole` that takes the cells of another.
int block_for(Mesh& whole, CellType type, const std::string& name) {
  const bool lines = is_line(type);
  const auto found =
      std::ranges::find_if(whole.blocks, [&](const CellBlock& b) { return is_line(b.type) == lines; });
  if (found == whole.blocks.end()) {
    whole.blocks.push_back({type, {}});
    return static_cast<int>(whole.blocks.size()) - 1;
  }
  if ((found->type == CellType::rod2) != (type == CellType::rod2))
    throw MeshError(fmt::format("part \"{}\": rods and other film cannot be in one case", name));
  if (found->type != type)
    throw MeshError(fmt::format(
        "the elements of part \"{}\" have {} nodes, those of the parts before it {}; give all parts "
        "one mesh.order",
        name, nodes_per_cell(type), nodes_per_cell(found->type)));
  return static_cast<int>(found - whole.blocks.begin());
}

std::vector<int> shifted(std::vector<int> numbers, int by) {
  for (int& number : numbers) number += by;
  return numbers;
}

/// Puts new numbers in the place of nodes' old ones.
void renumber(Mesh& mesh, const std::vector<int>& number) {
  const auto now = [&](int node) { return number[static_cast<std::size_t>(node)]; };
  for (CellBlock& block : mesh.blocks) std::ranges::transform(block.nodes, block.nodes.begin(), now);
  for (auto& [place, nodes] : mesh.node_sets) {
    std::ranges::transform(nodes, nodes.begin(), now);
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
}

bool is_in(std::span<const int> nodes, const std::vector<int>& place) {
  return std::ranges::all_of(nodes, [&](int node) { return std::ranges::binary_search(place, node); });
}

/// Cells of a block whose nodes are all in a place, as sides of their own: lines or triangles.
void add_cells_in(const CellBlock& block, const std::vector<int>& place, std::vector<OuterSide>& sides) {
  for (int i = 0; i < block.size(); ++i) {
    const auto nodes = block.cell(i);
    if (!is_in(nodes, place)) continue;
    OuterSide& side =
        sides.emplace_back(OuterSide{.cell = i,
                                     .corner_count = static_cast<std::size_t>(corners_per_cell(block.type)),
                                     .node_count = nodes.size()});
    std::ranges::copy(nodes, side.own.begin());
  }
}

/// Edges of all cells whose nodes are all in a place, by their (smaller, larger) corners.
std::map<std::pair<int, int>, OuterSide> edges_in(const Mesh& mesh, const std::vector<int>& place) {
  std::map<std::pair<int, int>, OuterSide> edges;
  for (const CellBlock& block : mesh.blocks) {
    const auto corners = static_cast<std::size_t>(corners_per_cell(block.type));
    const std::size_t count = corners == 4 ? 6 : corners == 3 ? 3 : 1;
    for (int i = 0; i < block.size(); ++i) {
      const auto nodes = block.cell(i);
      for (std::size_t k = 0; k < count; ++k) {
        OuterSide edge{.cell = i, .corner_count = 2, .node_count = 2};
        edge.own[0] = nodes[side_ends[k][0]], edge.own[1] = nodes[side_ends[k][1]];
        if (nodes.size() > corners) edge.own[edge.node_count++] = nodes[corners + k];
        if (is_in(edge.nodes(), place)) edges.emplace(std::minmax(edge.own[0], edge.own[1]), edge);
      }
    }
  }
  return edges;
}

/// What lies in a place with all of its nodes.
struct Pieces {
  /// Outer sides of the film, walls, and edges inside that no surface in the place has: the place is a line
  /// there, or the outside, as drawn along a curve.
  std::vector<OuterSide> sides;
  std::vector<OuterSide> inside; ///< the film's cells, and edges of any cells
};
Pieces pieces_in(const Mesh& mesh, const std::vector<int>& place) {
  Pieces all;
  const CellBlock *film = mesh.film(), *walls = mesh.walls();
  if (film && film->type != CellType::rod2)
    std::ranges::copy_if(outer_sides(*film), std::back_inserter(all.sides),
                         [&](const OuterSide& side) { return is_in(side.nodes(), place); });
  if (film && !is_tetrahedron(film->type)) add_cells_in(*film, place, all.inside);
  std::set<std::pair<int, int>> of_surfaces;
  for (const auto* surfaces : {&all.sides, &all.inside})
    for (const OuterSide& surface : *surfaces) {
      const auto corners = surface.corners();
      for (std::size_t k = 0; k < corners.size() && corners.size() > 1; ++k)
        of_surfaces.insert(std::minmax(corners[k], corners[(k + 1) % corners.size()]));
    }
  if (walls) add_cells_in(*walls, place, all.sides);
  for (const auto& [ends, edge] : edges_in(mesh, place)) {
    all.inside.push_back(edge);
    if (!of_surfaces.contains(ends)) all.sides.push_back(edge);
  }
  return all;
}

/// Whether a point is on the inside of an edge or a triangle, or off it by less than a part of its size.
bool is_inside(const Mesh& mesh, const OuterSide& side, const Eigen::Vector3d& point, double off) {
  constexpr double least_part = 0.01; // of the side
  const auto corners = side.corners();
  const auto at = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(corners[i])]; };
  if (corners.size() < 2) return false;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 2> along(3, static_cast<int>(corners.size()) - 1);
  for (int i = 0; i < along.cols(); ++i) along.col(i) = at(static_cast<std::size_t>(i) + 1) - at(0);
  const Eigen::Vector3d way = point - at(0);
  if (way.squaredNorm() > 2 * along.colwise().squaredNorm().maxCoeff()) return false;
  const Eigen::VectorXd parts = along.colPivHouseholderQr().solve(way);
  return parts.minCoeff() > least_part && parts.sum() < 1 - least_part &&
         (way - along * parts).norm() < off * along.col(0).norm();
}

/// A node of a place that is none of the `joined` ones, but inside an edge or a surface of another place; -1:
/// there is none.
int hanging_node(const Mesh& mesh, const std::vector<int>& place, const std::vector<int>& other,
                 const std::set<int>& joined) {
  constexpr double of_chord = 0.15;    // sides may be the chords of one curve, of six a circle
  constexpr double of_straight = 1e-3; // where surfaces are, nodes may be beside an edge
  const Pieces others = pieces_in(mesh, other);
  const auto hangs = [&](int node, const std::vector<OuterSide>& beside, double off) {
    return !joined.contains(node) && std::ranges::any_of(beside, [&](const OuterSide& side) {
      return is_inside(mesh, side, mesh.nodes[static_cast<std::size_t>(node)], off);
    });
  };
  for (const OuterSide& side : pieces_in(mesh, place).sides)
    for (const int node : side.nodes())
      if (hangs(node, others.sides, of_chord)) return node;
  for (const int node : place)
    if (hangs(node, others.inside, of_straight)) return node;
  return -1;
}

} // namespace

void append(Mesh& whole, const Mesh& part, const std::string& name) {
  const int first = whole.node_count();
  whole.nodes.insert(whole.nodes.end(), part.nodes.begin(), part.nodes.end());
  std::vector<int> block_of, first_cell;
  for (const CellBlock& block : part.blocks) {
    CellBlock& into =
        whole.blocks[static_cast<std::size_t>(block_of.emplace_back(block_for(whole, block.type, name)))];
    first_cell.push_back(into.size());
    const std::vector<int> nodes = shifted(block.nodes, first);
    into.nodes.insert(into.nodes.end(), nodes.begin(), nodes.end());
  }
  const auto add_nodes = [&](const std::string& place, std::vector<int> nodes) {
    if (!whole.node_sets.emplace(place, std::move(nodes)).second)
      throw MeshError(
          fmt::format("part \"{}\": there is a place \"{}\" already; call the part otherwise", name, place));
  };
  for (const auto& [place, nodes] : part.node_sets) add_nodes(name + "." + place, shifted(nodes, first));
  std::vector<int> all(part.nodes.size());
  std::iota(all.begin(), all.end(), first);
  add_nodes(name, std::move(all));
  if (part.blocks.size() == 1 && !part.film()) { // what is spread over a film finds its cells itself
    std::vector<int> cells(static_cast<std::size_t>(part.blocks[0].size()));
    std::iota(cells.begin(), cells.end(), first_cell[0]);
    whole.cell_sets[name] = {block_of[0], std::move(cells)};
  }
  for (const auto& [place, set] : part.cell_sets) {
    const auto b = static_cast<std::size_t>(set.block);
    whole.cell_sets[name + "." + place] = {block_of[b], shifted(set.cells, first_cell[b])};
  }
}

void join(Mesh& mesh, const std::string& place, const std::string& other) {
  const auto* fewer = &mesh.node_sets.at(place);
  const auto* more = &mesh.node_sets.at(other);
  if (fewer->size() > more->size()) std::swap(fewer, more);
  const double same_point = 1e-6 * mesh.bounds().diagonal().norm();
  const auto at = [&](int node) -> const Eigen::Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(node)];
  };
  std::vector<int> kept(mesh.nodes.size());
  std::iota(kept.begin(), kept.end(), 0);
  std::set<int> joined;
  for (const int node : *fewer) {
    const int nearest =
        *std::ranges::min_element(*more, {}, [&](int n) { return (at(n) - at(node)).norm(); });
    const double distance = (at(nearest) - at(node)).norm();
    if (distance > same_point)
      throw MeshError(fmt::format(
          "\"{}\" and \"{}\" cannot be tied: the node at ({:.6g}, {:.6g}, {:.6g}) m of the one is "
          "{:.3g} m from the nearest of the other; let their nodes coincide, or let a [[body]] carry both",
          place, other, at(node).x(), at(node).y(), at(node).z(), distance));
    kept[static_cast<std::size_t>(std::max(node, nearest))] = std::min(node, nearest);
    joined.insert(nearest);
  }
  if (const int hanging = hanging_node(mesh, *more, *fewer, joined); hanging >= 0)
    throw MeshError(
        fmt::format("\"{}\" and \"{}\" cannot be tied: the node at ({:.6g}, {:.6g}, {:.6g}) m of "
                    "the one is between nodes "
                    "of the other, and would hang free; mesh both places alike (mesh.across, mesh.order)",
                    place, other, at(hanging).x(), at(hanging).y(), at(hanging).z()));
  std::vector<int> number(mesh.nodes.size());
  std::vector<Eigen::Vector3d> nodes;
  for (std::size_t n = 0; n < number.size(); ++n) {
    const auto k = static_cast<std::size_t>(kept[n]);
    if (k == n) {
      number[n] = static_cast<int>(nodes.size());
      nodes.push_back(mesh.nodes[n]);
    } else {
      number[n] = number[k];
    }
  }
  if (nodes.size() == mesh.nodes.size())
    throw MeshError(
        fmt::format("\"{}\" and \"{}\" share all of their nodes already: leave out their tie", place, other));
  mesh.nodes = std::move(nodes);
  renumber(mesh, number);
}

} // namespace dielast::meshing
