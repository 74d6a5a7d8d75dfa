// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/honeycomb_mesh.hpp"

#include "meshing/middle_nodes.hpp"
#include "meshing/planar.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

namespace dielast::meshing {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

void validate(const MeshDensity& density) {
  if (density.order != 1 && density.order != 2)
    throw std::invalid_argument(fmt::format("the order of a mesh is 1 or 2, not {}", density.order));
  if (density.wall_elements < 1)
    throw std::invalid_argument(
        fmt::format("a wall needs at least 1 element, not {}", density.wall_elements));
  if (!(density.grading >= 1) || !std::isfinite(density.grading))
    throw std::invalid_argument(
        fmt::format("the grading of a mesh is at least 1, not {:.6g}", density.grading));
}

/// Builds the mesh of order 1: joints, then the nodes inside the walls, then those inside the cells.
class Builder {
 public:
  Builder(const HoneycombShape& shape, const Honeycomb& lattice, const MeshDensity& density,
          const WallSurroundings& surroundings)
      : shape_(shape), lattice_(lattice), density_(density) {
    if (surroundings.width > 0) distances_.push_back(surroundings.width / 2);
    if (surroundings.gap > 0) distances_.push_back(surroundings.width / 2 + surroundings.gap);
    bonded_ = surroundings.width > 0;
    mesh_.blocks = {{CellType::triangle3, {}}, {CellType::line2, {}}};
    for (const Vector2d& joint : lattice.joints) add_node(joint);
    for (std::size_t k = 0; k < lattice.walls.size(); ++k) add_wall(static_cast<int>(k));
    for (const Honeycomb::Cell& cell : lattice.cells) add_cell(cell);
    const auto all = [&](int block) {
      std::vector<int> cells(static_cast<std::size_t>(mesh_.blocks[block].size()));
      std::iota(cells.begin(), cells.end(), 0);
      return CellSet{block, std::move(cells)};
    };
    mesh_.cell_sets["film"] = all(0);
    mesh_.cell_sets["walls"] = all(1);
    if (distances_.empty()) mesh_.cell_sets["electrode"] = all(0);
  }

  Mesh take() { return std::move(mesh_); }

 private:
  int add_node(const Vector2d& p) {
    mesh_.nodes.emplace_back(p.x(), p.y(), 0);
    return mesh_.node_count() - 1;
  }

  void add_wall(int number) {
    const Honeycomb::Wall& wall = lattice_.walls[number];
    const Vector2d &from = lattice_.joints[wall.joints[0]], &to = lattice_.joints[wall.joints[1]];
    const int n = density_.wall_elements;
    std::vector<int> nodes{wall.joints[0]};
    for (int k = 1; k < n; ++k) nodes.push_back(add_node(((n - k) * from + k * to) / n));
    nodes.push_back(wall.joints[1]);

    CellSet lines{.block = 1, .cells = {}};
    for (int k = 0; k < n; ++k) {
      lines.cells.push_back(mesh_.blocks[1].size());
      mesh_.blocks[1].nodes.insert(mesh_.blocks[1].nodes.end(), {nodes[k], nodes[k + 1]});
    }
    if (wall.cells[1] < 0) {
      auto& boundary = mesh_.cell_sets["boundary"];
      boundary.block = 1;
      boundary.cells.insert(boundary.cells.end(), lines.cells.begin(), lines.cells.end());
    }
    mesh_.cell_sets[fmt::format("wall[{}]", number)] = std::move(lines);
    wall_nodes_.push_back(std::move(nodes));
  }

  void add_cell(const Honeycomb::Cell& cell) {
    std::vector<int> nodes = outline(cell);
    Vector2d centre = Vector2d::Zero();
    for (const int joint : cell.joints) centre += lattice_.joints[joint] / 6;
    const Triangulation& shape = triangulation(nodes, centre);
    for (std::size_t k = nodes.size(); k < shape.points.size(); ++k)
      nodes.push_back(add_node(centre + shape.points[k]));

    CellSet triangles;
    for (const auto& triangle : shape.triangles) {
      triangles.cells.push_back(mesh_.blocks[0].size());
      if (!distances_.empty()) {
        Vector2d middle = Vector2d::Zero();
        for (const int corner : triangle) middle += shape.points[corner] / 3;
        if (is_within(middle, distances_.back()))
          mesh_.cell_sets["electrode"].cells.push_back(mesh_.blocks[0].size());
        else if (bonded_ && !is_within(middle, distances_.front()))
          mesh_.cell_sets["under_walls"].cells.push_back(mesh_.blocks[0].size());
      }
      for (const int corner : triangle) mesh_.blocks[0].nodes.push_back(nodes[corner]);
    }
    mesh_.cell_sets[fmt::format("cell[{},{}]", cell.column, cell.row)] = std::move(triangles);
  }

  /// The nodes along a cell's walls, counter-clockwise.
  std::vector<int> outline(const Honeycomb::Cell& cell) const {
    std::vector<int> nodes;
    for (int side = 0; side < 6; ++side) {
      const std::vector<int>& wall = wall_nodes_[cell.walls[side]];
      if (wall.front() == cell.joints[side])
        nodes.insert(nodes.end(), wall.begin(), wall.end() - 1);
      else
        nodes.insert(nodes.end(), wall.rbegin(), wall.rend() - 1);
    }
    return nodes;
  }

  /// About the cell's centre; congruent cells are triangulated once.
  const Triangulation& triangulation(const std::vector<int>& nodes, const Vector2d& centre) {
    const double resolution = 1e-9 * (lattice_.joints[0] - lattice_.joints[1]).norm();
    std::vector<Vector2d> corners;
    std::vector<long> key;
    for (const int node : nodes) {
      corners.push_back(mesh_.nodes[node].head<2>() - centre);
      for (const double x : corners.back()) key.push_back(std::lround(x / resolution));
    }
    const auto [entry, added] = shapes_.try_emplace(std::move(key));
    if (added)
      entry->second = distances_.empty() ? triangulate(corners, density_.grading) : strips_beside(corners);
    return entry->second;
  }

  /// Whether a point, about the centre of its cell, is beyond that distance from all of the cell's walls.
  bool is_within(const Vector2d& point, double distance) const {
    const auto corners = cell_corners(shape_, distance);
    bool inside = false;
    for (std::size_t k = 0; k < 6; ++k) {
      const Vector2d &a = corners.at(k), &b = corners.at((k + 1) % 6);
      const double turn = (b - a).x() * (point - a).y() - (b - a).y() * (point - a).x();
      if ((a.y() > point.y()) != (b.y() > point.y()) && (turn > 0) == (b.y() > a.y())) inside = !inside;
    }
    return inside;
  }

  /// A cell with sides along its walls at each of the distances from them. Nodes of these sides are opposite
  /// to those of the wall, but for those next to its ends.
  Triangulation strips_beside(const std::vector<Vector2d>& outline) const {
    constexpr double nearest_to_end = 0.35; // of an element
    const int n = density_.wall_elements;
    PlanarGraph graph{outline, {}};
    const auto close = [&graph](int first, std::vector<std::array<int, 2>>& sides) {
      const int last = static_cast<int>(graph.points.size()) - 1;
      for (int i = first; i <= last; ++i) sides.push_back({i, i == last ? first : i + 1});
    };
    close(0, graph.outline);
    const double element = (outline[1] - outline[0]).norm();
    for (const double distance : distances_) {
      const auto corners = cell_corners(shape_, distance);
      const int first = static_cast<int>(graph.points.size());
      for (std::size_t side = 0; side < 6; ++side) {
        const Vector2d &from = corners.at(side), &to = corners.at((side + 1) % 6);
        const Vector2d along = (to - from).normalized();
        graph.points.push_back(from);
        for (int k = 1; k < n; ++k) {
          const double station =
              (outline[side * static_cast<std::size_t>(n) + static_cast<std::size_t>(k)] - from).dot(along);
          if (station > nearest_to_end * element && (to - from).norm() - station > nearest_to_end * element)
            graph.points.push_back(from + station * along);
        }
      }
      close(first, graph.inner);
    }
    return triangulate(graph, [size = density_.grading * element](const Vector2d&) { return size; });
  }

  const HoneycombShape& shape_;
  const Honeycomb& lattice_;
  const MeshDensity& density_;
  std::vector<double> distances_; ///< from the walls, of sides that triangles follow
  bool bonded_ = false;           ///< the first is the face of a wall
  Mesh mesh_;
  std::vector<std::vector<int>> wall_nodes_;
  std::map<std::vector<long>, Triangulation> shapes_;
};

/// The node at the middle of a wall, or the two nearest to it.
std::vector<int> middle_of_wall(const Mesh& mesh, int wall) {
  const CellSet& lines = mesh.cell_sets.at(fmt::format("wall[{}]", wall));
  std::vector<int> chain;
  for (const int line : lines.cells) {
    const auto nodes = mesh.blocks[lines.block].cell(line);
    chain.push_back(nodes[0]);
    if (nodes.size() == 3) chain.push_back(nodes[2]);
  }
  chain.push_back(mesh.blocks[lines.block].cell(lines.cells.back())[1]);
  const std::size_t last = chain.size() - 1;
  std::vector<int> middle{chain[last / 2]};
  if (last % 2 == 1) middle.push_back(chain[last / 2 + 1]);
  std::ranges::sort(middle);
  return middle;
}

int node_nearest_centroid(const Mesh& mesh) {
  double area = 0;
  Vector3d moment = Vector3d::Zero();
  const CellBlock& film = mesh.blocks[0];
  for (int c = 0; c < film.size(); ++c) {
    const auto nodes = film.cell(c);
    const Vector3d &p = mesh.nodes[nodes[0]], &q = mesh.nodes[nodes[1]], &r = mesh.nodes[nodes[2]];
    const double twice_area = (q - p).cross(r - p).z();
    area += twice_area;
    moment += twice_area * (p + q + r) / 3;
  }
  const Vector3d centroid = moment / area;
  const auto nearest = std::ranges::min_element(
      mesh.nodes, {}, [&](const Vector3d& p) { return (p - centroid).squaredNorm(); });
  return static_cast<int>(nearest - mesh.nodes.begin());
}

} // namespace

Mesh honeycomb_mesh(const HoneycombShape& shape, const MeshDensity& density,
                    const WallSurroundings& surroundings) {
  validate(density);
  const Honeycomb lattice = honeycomb(shape);
  Mesh mesh = Builder(shape, lattice, density, surroundings).take();
  if (density.order == 2) add_middle_nodes(mesh);

  const int columns = static_cast<int>(shape.columns.size());
  const int centre_column = (columns - 1) / 2;
  const auto highest = [&](int column) { return shape.columns[column] - 1; };
  const auto name_wall = [&](const char* place, int column, int row, Honeycomb::Side side) {
    mesh.cell_sets[place] = mesh.cell_sets.at(fmt::format("wall[{}]", lattice.cell(column, row).walls[side]));
  };
  name_wall("corner_top_wall", 0, highest(0), Honeycomb::top);
  name_wall("corner_bottom_wall", 0, 0, Honeycomb::bottom);
  name_wall("top_wall", centre_column, highest(centre_column), Honeycomb::top);
  name_wall("bottom_wall", centre_column, 0, Honeycomb::bottom);
  add_node_sets(mesh);
  const auto middle = [&](int column, int row, Honeycomb::Side side) {
    return middle_of_wall(mesh, lattice.cell(column, row).walls[side]);
  };
  mesh.node_sets["left_apex"] = {lattice.cell(0, highest(0) / 2).left_apex()};
  mesh.node_sets["right_apex"] = {lattice.cell(columns - 1, highest(columns - 1) / 2).right_apex()};
  mesh.node_sets["corner_top"] = middle(0, highest(0), Honeycomb::top);
  mesh.node_sets["corner_bottom"] = middle(0, 0, Honeycomb::bottom);
  mesh.node_sets["top"] = middle(centre_column, highest(centre_column), Honeycomb::top);
  mesh.node_sets["bottom"] = middle(centre_column, 0, Honeycomb::bottom);
  mesh.node_sets["centre"] = {node_nearest_centroid(mesh)};
  return mesh;
}

} // namespace dielast::meshing
