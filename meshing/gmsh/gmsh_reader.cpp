// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/gmsh_reader.hpp"

#include "meshing/gmsh/file_checks.hpp"
#include "meshing/gmsh/gmsh_contents.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/middle_nodes.hpp"
#include "meshing/normals.hpp"
#include "meshing/quality.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>

namespace dielast::meshing {

namespace {

constexpr double flat = 1e-9; ///< of a mesh's diagonal: a film within it is in one plane

GmshContents contents_of(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw MeshError("there is no such mesh file");
  if (!std::filesystem::is_regular_file(path)) throw MeshError("this is not a file");
  if (path.extension() == ".geo")
    throw MeshError(
        fmt::format("this is a geometry script; mesh it first, with: gmsh -2 {}", path.filename().string()));
  check_gmsh_file(path);
  GmshContents contents = read_gmsh_contents(path);
  if (!contents.error.empty()) throw MeshError(contents.error);
  return contents;
}

std::optional<CellType> cell_type(const GmshContents::Elements& elements) {
  if (elements.dimension == 1 && elements.nodes_each == 2) return CellType::line2;
  if (elements.dimension == 1 && elements.nodes_each == 3) return CellType::line3;
  if (elements.dimension == 2 && elements.type == "Triangle 3") return CellType::triangle3;
  if (elements.dimension == 2 && elements.type == "Triangle 6") return CellType::triangle6;
  if (elements.dimension == 3 && elements.type == "Tetrahedron 4") return CellType::tetrahedron4;
  if (elements.dimension == 3 && elements.type == "Tetrahedron 10") return CellType::tetrahedron10;
  return std::nullopt;
}

int dimension_of(CellType type) { return is_tetrahedron(type) ? 3 : is_triangle(type) ? 2 : 1; }

void require(bool holds) {
  if (!holds) throw MeshError("what gmsh finds in it does not fit together; it is damaged, write it again");
}

void check(const GmshContents& contents) {
  std::set<std::size_t> tags;
  for (const std::size_t tag : contents.node_tags) {
    if (tag > std::numeric_limits<int>::max())
      throw MeshError(fmt::format("node {} has too large a number; let gmsh renumber the mesh", tag));
    if (!tags.insert(tag).second) throw MeshError(fmt::format("two nodes have the number {}", tag));
  }
  for (const GmshContents::Elements& elements : contents.elements) {
    require(elements.dimension >= 0 && elements.dimension <= 3 && elements.nodes_each > 0 &&
            elements.nodes.size() % static_cast<std::size_t>(elements.nodes_each) == 0);
    for (const std::size_t tag : elements.nodes)
      if (elements.dimension > 0 && !tags.contains(tag))
        throw MeshError(fmt::format("an element names node {}, which the file does not have", tag));
  }
  for (const GmshContents::PhysicalGroup& group : contents.groups)
    require(group.dimension >= 0 && group.dimension <= 3);
}

class Converter {
 public:
  explicit Converter(GmshContents contents) : contents_(std::move(contents)) {
    if (contents_.coordinates.size() != 3 * contents_.node_tags.size())
      throw MeshError("its nodes do not have three coordinates each");
    check(contents_);
    add_cells();
    number_nodes();
    for (CellBlock& block : mesh_.blocks) {
      if (is_triangle(block.type)) turn_alike(mesh_.nodes, block);
      turn_outwards(block);
      require_unfolded(block);
      require_spread_out(block);
    }
    for (const GmshContents::PhysicalGroup& group : contents_.groups) add_place(group);
    if (block_of(3) != mesh_.blocks.end() && block_of(3)->type == CellType::tetrahedron4)
      add_middle_nodes(mesh_); // solids need them
    add_node_sets(mesh_);
    if (!mesh_.node_sets.contains("film")) add_film();
  }

  Mesh take() { return std::move(mesh_); }

 private:
  void add_cells() {
    std::set<int> orders;
    for (const GmshContents::Elements& elements : contents_.elements) {
      if (elements.dimension == 0) continue;
      const auto type = cell_type(elements);
      if (!type)
        throw MeshError(
            fmt::format("it has elements of the type \"{}\", but only tetrahedra (4 or 10 nodes), triangles "
                        "(3 or 6 nodes) "
                        "and lines (2 or 3 nodes) are known; mesh without recombination, of order 1 or 2",
                        elements.type));
      require(elements.nodes_each == nodes_per_cell(*type));
      orders.insert(nodes_per_cell(*type) == corners_per_cell(*type) ? 1 : 2);
      auto block = std::ranges::find(mesh_.blocks, *type, &CellBlock::type);
      if (block == mesh_.blocks.end()) block = mesh_.blocks.insert(block, {*type, {}});
      // Tags for now; number_nodes() replaces them.
      std::vector<int>& cells = entity_cells_[{elements.dimension, elements.entity}];
      const auto each = static_cast<std::size_t>(elements.nodes_each);
      for (std::size_t first = 0; first + each <= elements.nodes.size(); first += each)
        cells.push_back(add_cell(*block, std::span(elements.nodes).subspan(first, each)));
    }
    if (std::ranges::all_of(mesh_.blocks, [](const CellBlock& b) { return is_line(b.type); }))
      throw MeshError(
          "it has no triangles; mesh the surfaces, and put them into a physical group or save all elements");
    if (orders.size() > 1)
      throw MeshError("it mixes elements of order 1 and 2; save the whole mesh with one order (gmsh -order 1 "
                      "or -order 2)");
  }

  /// Number of the cell in its block. Files of version 2.2 repeat a cell for each of its physical groups: it
  /// is one cell of several places.
  int add_cell(CellBlock& block, std::span<const std::size_t> tags) {
    std::vector<std::size_t> key(tags.begin(), tags.end());
    std::ranges::sort(key);
    const auto [known, fresh] = cell_of_tags_.try_emplace(std::move(key), block.size());
    if (fresh) block.nodes.insert(block.nodes.end(), tags.begin(), tags.end());
    return known->second;
  }

  void number_nodes() {
    std::unordered_map<std::size_t, std::size_t> position;
    for (std::size_t i = 0; i < contents_.node_tags.size(); ++i) position[contents_.node_tags[i]] = i;
    std::set<std::size_t> used; // ascending positions: the file's order is kept
    for (const CellBlock& block : mesh_.blocks)
      for (const int tag : block.nodes) used.insert(position.at(static_cast<std::size_t>(tag)));
    for (const std::size_t i : used) {
      node_number_[contents_.node_tags[i]] = mesh_.node_count();
      mesh_.nodes.emplace_back(contents_.coordinates[3 * i], contents_.coordinates[3 * i + 1],
                               contents_.coordinates[3 * i + 2]);
      if (!mesh_.nodes.back().allFinite())
        throw MeshError(fmt::format("node {} has a coordinate that is not a number", contents_.node_tags[i]));
    }
    for (CellBlock& block : mesh_.blocks)
      for (int& node : block.nodes) node = node_number_.at(static_cast<std::size_t>(node));
  }

  std::vector<CellBlock>::iterator block_of(int dimension) {
    return std::ranges::find(mesh_.blocks, dimension,
                             [](const CellBlock& block) { return dimension_of(block.type); });
  }

  /// Of tetrahedra; gmsh numbers the last two middle nodes the other way round.
  void turn_outwards(CellBlock& block) const {
    if (!is_tetrahedron(block.type)) return;
    const int n = nodes_per_cell(block.type);
    for (int c = 0; c < block.size(); ++c) {
      int* const cell = block.nodes.data() + c * n;
      if (n == 10) std::swap(cell[8], cell[9]);
      const auto x = [&](int k) -> const Eigen::Vector3d& { return mesh_.nodes[cell[k]]; };
      if ((x(1) - x(0)).cross(x(2) - x(0)).dot(x(3) - x(0)) >= 0) continue;
      std::swap(cell[0], cell[1]);
      if (n == 4) continue;
      std::swap(cell[5], cell[6]);
      std::swap(cell[7], cell[8]);
    }
  }

  void require_unfolded(const CellBlock& block) const {
    for (int c = 0; c < block.size(); ++c) {
      const auto nodes = block.cell(c);
      if (!folds(mesh_, block.type, nodes)) continue;
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      const int corners = corners_per_cell(block.type);
      for (int a = 0; a < corners; ++a) middle += mesh_.nodes[static_cast<std::size_t>(nodes[a])] / corners;
      throw MeshError(fmt::format(
          "the {} about ({:.6g}, {:.6g}, {:.6g}) is folded: a node of its sides lies too far from their "
          "middle, "
          "or its corners on a line; let gmsh mend it (Mesh.HighOrderOptimize = 2), or save with order 1",
          is_triangle(block.type) ? "triangle" : "tetrahedron", middle.x(), middle.y(), middle.z()));
    }
  }

  /// Of a film in one plane, whose triangles all turn alike: a side that two of them lead along the same way
  /// has both on one side.
  void require_spread_out(const CellBlock& block) const {
    if (!is_triangle(block.type) || mesh_.bounds().sizes().z() > flat * mesh_.bounds().diagonal().norm())
      return;
    std::set<std::array<int, 2>> sides;
    for (int c = 0; c < block.size(); ++c)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto nodes = block.cell(c);
        const std::array<int, 2> side{nodes[k], nodes[(k + 1) % 3]};
        if (sides.insert(side).second) continue;
        const Eigen::Vector3d middle = (mesh_.nodes[static_cast<std::size_t>(side[0])] +
                                        mesh_.nodes[static_cast<std::size_t>(side[1])]) /
                                       2;
        throw MeshError(
            fmt::format("the film lies on itself: two triangles are on the same side of their common "
                        "side about ({:.6g}, {:.6g}, {:.6g}); a node was moved past others, or "
                        "triangles overlap",
                        middle.x(), middle.y(), middle.z()));
      }
  }

  void add_place(const GmshContents::PhysicalGroup& group) {
    const std::string name =
        group.name.empty() ? fmt::format("{} {}", dimension_names[group.dimension], group.tag) : group.name;
    if (mesh_.node_sets.contains(name) || mesh_.cell_sets.contains(name))
      throw MeshError(
          fmt::format("two physical groups have the name \"{}\"; every place needs its own name", name));
    if (group.dimension == 0) {
      add_points(name, group);
      return;
    }
    CellSet set;
    for (const int entity : group.entities)
      if (const auto cells = entity_cells_.find({group.dimension, entity}); cells != entity_cells_.end())
        set.cells.insert(set.cells.end(), cells->second.begin(), cells->second.end());
    if (set.cells.empty())
      throw MeshError(fmt::format("the {} \"{}\" has no elements; remove the physical group or mesh it",
                                  dimension_names[group.dimension], name));
    std::ranges::sort(set.cells);
    set.cells.erase(std::unique(set.cells.begin(), set.cells.end()), set.cells.end());
    set.block = static_cast<int>(block_of(group.dimension) - mesh_.blocks.begin());
    mesh_.cell_sets[name] = std::move(set);
  }

  void add_points(const std::string& name, const GmshContents::PhysicalGroup& group) {
    std::set<int> nodes;
    for (const GmshContents::Elements& elements : contents_.elements)
      if (elements.dimension == 0 &&
          std::ranges::find(group.entities, elements.entity) != group.entities.end())
        for (const std::size_t tag : elements.nodes)
          if (const auto node = node_number_.find(tag); node != node_number_.end())
            nodes.insert(node->second);
    if (nodes.empty())
      throw MeshError(fmt::format(
          "the point \"{}\" is not a node of any triangle or line; embed it in the surface", name));
    mesh_.node_sets[name].assign(nodes.begin(), nodes.end());
  }

  void add_film() {
    auto block = block_of(3);
    if (block == mesh_.blocks.end()) block = block_of(2);
    CellSet film{static_cast<int>(block - mesh_.blocks.begin()),
                 std::vector<int>(static_cast<std::size_t>(block->size()))};
    std::iota(film.cells.begin(), film.cells.end(), 0);
    mesh_.node_sets["film"] = nodes_of(mesh_, film);
    mesh_.cell_sets["film"] = std::move(film);
  }

  GmshContents contents_;
  Mesh mesh_;
  std::map<std::vector<std::size_t>, int> cell_of_tags_;         ///< by a cell's node tags, ascending
  std::map<std::pair<int, int>, std::vector<int>> entity_cells_; ///< by (dimension, entity)
  std::unordered_map<std::size_t, int> node_number_;             ///< by tag
};

} // namespace

Mesh mesh_of(GmshContents contents) { return Converter(std::move(contents)).take(); }

Mesh read_gmsh(const std::filesystem::path& path) {
  try {
    return mesh_of(contents_of(path));
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

} // namespace dielast::meshing
