// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/rings.hpp"

#include "meshing/graded_steps.hpp"

#include "meshing/mesh_error.hpp"
#include "meshing/middle_nodes.hpp"
#include "meshing/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace dielast::meshing {

namespace {

/// Circles first .. first + radii.size() - 1 of the hexagonal pattern; sides along those named `curved` lie
/// on them.
class Rings {
 public:
  Rings(int first, std::vector<double> radii, int order, const std::vector<int>& curved)
      : first_(first), radii_(std::move(radii)), order_(order) {
    mesh_.blocks = {{CellType::triangle3, {}}};
    for (int i = first; i <= last(); ++i) add_circle(i);
    for (int i = first + 1; i <= last(); ++i) add_triangles(i);
    if (order == 2) add_middle_nodes(mesh_);
    bend_sides(curved);
    if (const QualityReport report = quality(mesh_); report.inverted > 0)
      throw MeshError(
          fmt::format("{} triangles of {} rings are inverted: a ring is too thin for its number of sides, "
                      "use more rings",
                      report.inverted, radii_.size() - 1));
  }

  Mesh take() { return std::move(mesh_); }

  /// Names the triangles between circles `from` and `to`, numbered as in the pattern.
  void name_triangles(const std::string& place, int from, int to) {
    std::vector<int> cells(static_cast<std::size_t>(6 * (to * to - from * from)));
    std::iota(cells.begin(), cells.end(), 6 * (from * from - first_ * first_));
    mesh_.cell_sets[place] = {0, std::move(cells)};
    mesh_.node_sets[place] = nodes_of(mesh_, mesh_.cell_sets[place]);
  }

  void name_circle(const std::string& place, int circle) {
    std::vector<int>& nodes = mesh_.node_sets[place];
    for (int j = 0; j < size(circle); ++j) nodes.push_back(node(circle, j));
    for_each_side([&](int i, int middle) {
      if (i == circle) nodes.push_back(middle);
    });
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }

 private:
  int last() const { return first_ + static_cast<int>(radii_.size()) - 1; }
  static int size(int circle) { return std::max(1, 6 * circle); }
  int start(int circle) const {
    const auto nodes_before = [](int i) { return i == 0 ? 0 : 1 + 3 * i * (i - 1); };
    return nodes_before(circle) - nodes_before(first_);
  }
  int node(int circle, int j) const { return start(circle) + j % size(circle); }

  void add_circle(int i) {
    for (int j = 0; j < size(i); ++j) {
      const double angle = 2 * std::numbers::pi * j / size(i), r = radii_[i - first_];
      mesh_.nodes.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
  }

  /// Between circles i - 1 and i: in each of six sectors i triangles with their base outside, i - 1 with it
  /// inside.
  void add_triangles(int i) {
    const auto add = [&](int a, int b, int c) {
      mesh_.blocks[0].nodes.insert(mesh_.blocks[0].nodes.end(), {a, b, c});
    };
    for (int sector = 0; sector < 6; ++sector) {
      const int inside = sector * (i - 1), outside = sector * i;
      for (int j = 0; j < i; ++j)
        add(node(i - 1, inside + j), node(i, outside + j), node(i, outside + j + 1));
      for (int j = 0; j + 1 < i; ++j)
        add(node(i - 1, inside + j), node(i, outside + j + 1), node(i - 1, inside + j + 1));
    }
  }

  /// Visits the sides that lie along a circle: visit(circle, middle node).
  template<class Visit>
  void for_each_side(Visit visit) const {
    if (order_ == 1) return;
    const CellBlock& triangles = mesh_.blocks[0];
    std::vector<int> circles(static_cast<std::size_t>(start(last()) + size(last())));
    for (int i = first_; i <= last(); ++i) std::fill_n(circles.begin() + start(i), size(i), i);
    for (int c = 0; c < triangles.size(); ++c) {
      const auto nodes = triangles.cell(c);
      for (int k = 0; k < 3; ++k)
        if (const int i = circles[nodes[k]]; i == circles[nodes[(k + 1) % 3]]) visit(i, nodes[3 + k]);
    }
  }

  void bend_sides(const std::vector<int>& circles) {
    for_each_side([&](int circle, int middle) {
      if (std::ranges::find(circles, circle) == circles.end()) return;
      mesh_.nodes[middle] *= radii_[circle - first_] / mesh_.nodes[middle].norm();
    });
  }

  int first_;
  std::vector<double> radii_;
  int order_;
  Mesh mesh_;
};

void validate(double inside, double outside, const char* names, int rings, int fewest, int order) {
  if (!(inside > 0 && outside > inside) || !std::isfinite(outside))
    throw std::invalid_argument(
        fmt::format("{} must be positive and ascending, not {:.6g} m and {:.6g} m", names, inside, outside));
  if (rings < fewest)
    throw std::invalid_argument(fmt::format("at least {} rings are needed, not {}", fewest, rings));
  if (order != 1 && order != 2)
    throw std::invalid_argument(fmt::format("the order of a mesh is 1 or 2, not {}", order));
}

} // namespace

int rings_of_electrode(double radius, double electrode_radius, int rings) {
  if (electrode_radius == radius) return rings;
  return std::clamp(static_cast<int>(std::lround(rings * electrode_radius / radius)), 1, rings - 1);
}

int rings_of_hole(double inner_radius, double outer_radius, int rings) {
  return std::max(1, static_cast<int>(std::lround(rings * inner_radius / (outer_radius - inner_radius))));
}

Mesh disc_mesh(double radius, double electrode_radius, int rings, int order, bool curved) {
  const bool covered = electrode_radius == radius;
  validate(covered ? radius / 2 : electrode_radius, radius, "the radii of electrode and disc", rings, 2,
           order);
  const int inside = rings_of_electrode(radius, electrode_radius, rings);
  std::vector<double> radii;
  for (int i = 0; i < inside; ++i) radii.push_back(electrode_radius * i / inside);
  for (int i = inside; i <= rings; ++i)
    radii.push_back(
        covered ? radius
                : std::lerp(electrode_radius, radius, static_cast<double>(i - inside) / (rings - inside)));

  // Triangles of curved sides hold no parabola, and those next to the middle stay as curved as they are in
  // finer meshes: the height there would converge with order 2. So only edges are curved.
  Rings pattern(0, std::move(radii), order, curved ? std::vector{inside, rings} : std::vector<int>{});
  pattern.name_triangles("film", 0, rings);
  pattern.name_triangles("electrode", 0, inside);
  if (!covered) pattern.name_triangles("passive", inside, rings);
  pattern.name_circle("electrode_edge", inside);
  pattern.name_circle("rim", rings);
  pattern.name_circle("centre", 0);
  return pattern.take();
}

Mesh annulus_mesh(double inner_radius, double outer_radius, int rings, int order, bool curved,
                  double grading) {
  validate(inner_radius, outer_radius, "the inner and outer radius of an annulus", rings, 1, order);
  const double pattern_start = rings * inner_radius / (outer_radius - inner_radius);
  if (pattern_start > 1e5)
    throw std::invalid_argument(
        fmt::format("an annulus from {:.6g} m to {:.6g} m is too narrow for {} rings: use fewer "
                    "rings",
                    inner_radius, outer_radius, rings));
  const int first = rings_of_hole(inner_radius, outer_radius, rings);
  std::vector<int> circles(curved ? static_cast<std::size_t>(rings) + 1 : 0);
  std::iota(circles.begin(), circles.end(), first);
  Rings pattern(first, graded_steps(inner_radius, outer_radius, rings, grading), order, circles);
  pattern.name_triangles("film", first, first + rings);
  pattern.name_circle("inner", first);
  pattern.name_circle("outer", first + rings);
  return pattern.take();
}

} // namespace dielast::meshing
