// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/normals.hpp"

#include "meshing/mesh_error.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace dielast::meshing {

namespace {

using Eigen::Vector3d;

class Surfaces {
 public:
  Surfaces(const std::vector<Vector3d>& nodes, CellBlock& triangles)
      : nodes_(nodes), triangles_(triangles), turned_(static_cast<std::size_t>(triangles.size()), unknown) {
    Eigen::AlignedBox3d box;
    for (const int node : triangles.nodes) box.extend(at(node));
    level_ = 1e-9 * box.diagonal().norm();
    find_neighbours();
  }

  void turn_alike() {
    for (int first = 0; first < triangles_.size(); ++first) {
      if (turned_[static_cast<std::size_t>(first)] != unknown) continue;
      const std::vector<int> surface = surface_of(first);
      if (is_level(surface)) {
        for (const int cell : surface)
          if (across(cell).z() < 0) turn(cell);
        continue;
      }
      if (one_sided_)
        throw MeshError(fmt::format("the surface about ({:.6g}, {:.6g}, {:.6g}) has one side only, as a "
                                    "Moebius strip: film needs an upper and a lower face",
                                    one_sided_->x(), one_sided_->y(), one_sided_->z()));
      for (const int cell : surface)
        if (turned_[static_cast<std::size_t>(cell)] == yes) turn(cell);
      if (faces_down_or_inwards(surface))
        for (const int cell : surface) turn(cell);
    }
  }

 private:
  enum Turned : char { unknown, no, yes };
  struct Side {
    std::array<int, 2> corners; ///< ascending
    int cell;
    bool forward; ///< the cell leads along it from the first to the second
  };
  struct Neighbour {
    int cell;
    bool leads_alike; ///< along the common side: they turn differently
  };

  const Vector3d& at(int node) const { return nodes_[static_cast<std::size_t>(node)]; }
  /// Twice the area along the normal.
  Vector3d across(int cell) const {
    const auto n = triangles_.cell(cell);
    return (at(n[1]) - at(n[0])).cross(at(n[2]) - at(n[0]));
  }
  Vector3d middle(int cell) const {
    const auto n = triangles_.cell(cell);
    return (at(n[0]) + at(n[1]) + at(n[2])) / 3;
  }

  void find_neighbours() {
    std::vector<Side> sides;
    for (int cell = 0; cell < triangles_.size(); ++cell)
      for (std::size_t k = 0; k < 3; ++k) {
        const int from = triangles_.cell(cell)[k], to = triangles_.cell(cell)[(k + 1) % 3];
        sides.push_back({{std::min(from, to), std::max(from, to)}, cell, from < to});
      }
    std::ranges::stable_sort(sides, {}, &Side::corners);
    neighbours_.resize(static_cast<std::size_t>(triangles_.size()));
    for (auto side = sides.begin(); side != sides.end();) {
      const auto next =
          std::find_if(side, sides.end(), [&](const Side& s) { return s.corners != side->corners; });
      if (next - side == 2) {
        const bool alike = side[0].forward == side[1].forward;
        neighbours_[static_cast<std::size_t>(side[0].cell)].push_back({side[1].cell, alike});
        neighbours_[static_cast<std::size_t>(side[1].cell)].push_back({side[0].cell, alike});
      }
      side = next;
    }
  }

  /// All that is joined to a triangle; notes which must be turned to be like the first.
  std::vector<int> surface_of(int first) {
    one_sided_.reset();
    std::vector<int> surface{first};
    turned_[static_cast<std::size_t>(first)] = no;
    for (std::size_t i = 0; i < surface.size(); ++i) {
      const Turned own = turned_[static_cast<std::size_t>(surface[i])];
      for (const Neighbour& beside : neighbours_[static_cast<std::size_t>(surface[i])]) {
        const Turned needed = (own == yes) != beside.leads_alike ? yes : no;
        Turned& other = turned_[static_cast<std::size_t>(beside.cell)];
        if (other == unknown)
          surface.push_back(beside.cell), other = needed;
        else if (other != needed)
          one_sided_ = middle(beside.cell);
      }
    }
    return surface;
  }

  bool is_level(const std::vector<int>& surface) const {
    const double z = at(triangles_.cell(surface[0])[0]).z();
    return std::ranges::all_of(surface, [&](int cell) {
      return std::ranges::all_of(triangles_.cell(cell),
                                 [&](int node) { return std::abs(at(node).z() - z) <= level_; });
    });
  }

  bool faces_down_or_inwards(const std::vector<int>& surface) const {
    constexpr double round_off = 1e-6, steep = 0.5;
    Vector3d sum = Vector3d::Zero(), centre = Vector3d::Zero();
    double area = 0;
    for (const int cell : surface) {
      sum += across(cell);
      area += across(cell).norm();
      centre += across(cell).norm() * middle(cell);
    }
    centre /= area;
    if (std::abs(sum.z()) > std::max(steep * sum.norm(), round_off * area)) return sum.z() < 0;
    double volume = 0;
    for (const int cell : surface) volume += across(cell).dot(middle(cell) - centre);
    return volume < -round_off * area * std::sqrt(area);
  }

  void turn(int cell) {
    const int n = nodes_per_cell(triangles_.type);
    int* const own = triangles_.nodes.data() + static_cast<std::ptrdiff_t>(cell) * n;
    std::swap(own[1], own[2]);
    if (n == 6) std::swap(own[3], own[5]);
  }

  const std::vector<Vector3d>& nodes_;
  CellBlock& triangles_;
  double level_ = 0; ///< within it a surface is in one plane, m
  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<Turned> turned_;
  std::optional<Vector3d> one_sided_; ///< where the surface that was looked at last turns out to be so
};

} // namespace

void turn_alike(const std::vector<Eigen::Vector3d>& nodes, CellBlock& triangles) {
  Surfaces(nodes, triangles).turn_alike();
}

std::vector<Eigen::Vector3d> normals(const std::vector<Eigen::Vector3d>& nodes,
                                     std::span<const int> triangle) {
  const auto x = [&](std::size_t a) -> const Vector3d& {
    return nodes[static_cast<std::size_t>(triangle[a])];
  };
  std::vector<Vector3d> all;
  if (triangle.size() == 3) {
    all.assign(3, (x(1) - x(0)).cross(x(2) - x(0)).normalized());
    return all;
  }
  for (std::size_t i = 0; i < 3; ++i) { // at a corner, along both of its sides
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    all.push_back((4 * x(3 + i) - x(j) - 3 * x(i)).cross(4 * x(3 + k) - x(k) - 3 * x(i)).normalized());
  }
  for (std::size_t i = 0; i < 3; ++i) { // in the middle of a side, along it and across
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    all.push_back((x(j) - x(i)).cross(2 * (x(3 + j) + x(3 + k) - x(3 + i)) - x(i) - x(k)).normalized());
  }
  return all;
}

std::vector<Eigen::Vector3d> node_normals(const Mesh& mesh, const CellBlock& triangles) {
  std::vector<Vector3d> sum(mesh.nodes.size(), Vector3d::Zero());
  for (int cell = 0; cell < triangles.size(); ++cell) {
    const auto own = triangles.cell(cell);
    const std::vector<Vector3d> here = normals(mesh.nodes, own);
    for (std::size_t a = 0; a < own.size(); ++a) sum[static_cast<std::size_t>(own[a])] += here[a];
  }
  for (Vector3d& normal : sum)
    if (!normal.isZero(0)) normal.normalize();
  return sum;
}

} // namespace dielast::meshing
