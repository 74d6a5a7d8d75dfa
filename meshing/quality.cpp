// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

namespace dielast::meshing {

namespace {

using Eigen::Vector3d;

/// Where triangles are seen from: drawn in a plane of constant z, from above; in the x-z plane, as of solids
/// of revolution, from the side from which most of them turn to the left; on another surface each from its
/// corners' side.
class Seen {
 public:
  explicit Seen(const Mesh& mesh) {
    if (mesh.nodes.empty()) return;
    const Vector3d size = mesh.bounds().sizes();
    if (!(size.y() > 0))
      from_ = Vector3d::UnitY() * std::copysign(1.0, across_y(mesh));
    else if (size.z() > 1e-9 * size.norm())
      from_.reset();
  }
  /// Twice the area of a piece of a cell, negative where it is seen from behind; `normal` is that of the
  /// cell's corners.
  double area(const Vector3d& along, const Vector3d& to_the_left, const Vector3d& normal) const {
    const Vector3d across = along.cross(to_the_left);
    return from_ ? across.dot(*from_) : std::copysign(across.norm(), across.dot(normal));
  }

 private:
  static double across_y(const Mesh& mesh) {
    double sum = 0;
    for (const CellBlock& block : mesh.blocks)
      for (int c = 0; is_triangle(block.type) && c < block.size(); ++c) {
        const auto x = [&](std::size_t k) { return mesh.nodes[static_cast<std::size_t>(block.cell(c)[k])]; };
        sum += (x(1) - x(0)).cross(x(2) - x(0)).y();
      }
    return sum;
  }

  std::optional<Vector3d> from_ = Vector3d::UnitZ();
};

struct Measure {
  double area;
  bool inverted;
};

Measure measure(const Mesh& mesh, const Seen& seen, std::span<const int> nodes) {
  const auto x = [&](int k) -> const Vector3d& { return mesh.nodes[nodes[k]]; };
  const Vector3d normal = (x(1) - x(0)).cross(x(2) - x(0));
  if (nodes.size() == 3) {
    const double area = seen.area(x(1) - x(0), x(2) - x(0), normal) / 2;
    return {area, !(area > 0)};
  }
  // Points and weights of degree 4 (Dunavant 1985): barycentric (s, s, 1 - 2 s) and its permutations.
  constexpr std::array<std::array<double, 2>, 2> rule{
      {{0.445948490915965, 0.223381589678011}, {0.091576213509771, 0.109951743655322}}};
  Measure result{0, false};
  for (const auto& [s, weight] : rule)
    for (int corner = 0; corner < 3; ++corner) {
      std::array<double, 3> l{s, s, s};
      l[corner] = 1 - 2 * s;
      // dN/dl1 - dN/dl0 and dN/dl2 - dN/dl0 of N_i = l_i (2 l_i - 1), N_ij = 4 l_i l_j.
      const Vector3d from_0 = (4 * l[0] - 1) * x(0) + 4 * l[1] * x(3) + 4 * l[2] * x(5);
      const Vector3d along_1 = (4 * l[1] - 1) * x(1) + 4 * l[0] * x(3) + 4 * l[2] * x(4) - from_0;
      const Vector3d along_2 = (4 * l[2] - 1) * x(2) + 4 * l[1] * x(4) + 4 * l[0] * x(5) - from_0;
      const double jacobian = seen.area(along_1, along_2, normal);
      result.area += weight * jacobian / 2;
      result.inverted |= !(jacobian > 0);
    }
  return result;
}

/// The straight tetrahedron of the corners.
struct Straight {
  double smallest_angle, aspect; ///< degrees, 1 for the regular one
  explicit Straight(const std::array<Vector3d, 4>& x) : smallest_angle(180), aspect(0) {
    std::array<Vector3d, 4> normal; // of the face opposite to a corner, pointing outwards, twice its area
    double surface = 0, longest = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      const Vector3d &p = x[(a + 1) % 4], &q = x[(a + 2) % 4], &r = x[(a + 3) % 4];
      normal[a] = (q - p).cross(r - p);
      if (normal[a].dot(x[a] - p) > 0) normal[a] = -normal[a];
      surface += normal[a].norm() / 2;
      for (std::size_t b = 0; b < a; ++b) {
        const double angle = std::atan2(normal[a].cross(normal[b]).norm(), -normal[a].dot(normal[b]));
        smallest_angle = std::min(smallest_angle, angle * 180 / std::numbers::pi);
        longest = std::max(longest, (x[a] - x[b]).norm());
      }
    }
    const double volume = std::abs((x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0])) / 6;
    aspect = longest * surface / (6 * std::sqrt(6.0) * volume); // inradius: 3 volume / surface
  }
};

/// Columns: d(x)/d(l_k) of a 10-node tetrahedron at barycentric coordinates.
std::array<Vector3d, 4> slopes_of_tetrahedron(const Mesh& mesh, std::span<const int> nodes,
                                              const std::array<double, 4>& l) {
  constexpr std::array<std::array<std::size_t, 3>, 6> sides{
      {{0, 1, 4}, {1, 2, 5}, {2, 0, 6}, {0, 3, 7}, {1, 3, 8}, {2, 3, 9}}};
  const auto x = [&](std::size_t k) -> const Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(nodes[k])];
  };
  std::array<Vector3d, 4> slope;
  for (std::size_t a = 0; a < 4; ++a) slope[a] = (4 * l[a] - 1) * x(a);
  for (const auto& [a, b, middle] : sides) {
    slope[a] += 4 * l[b] * x(middle);
    slope[b] += 4 * l[a] * x(middle);
  }
  return slope;
}

double determinant(const std::array<Vector3d, 4>& slope) {
  return (slope[1] - slope[0]).cross(slope[2] - slope[0]).dot(slope[3] - slope[0]);
}

bool folds_tetrahedron(const Mesh& mesh, std::span<const int> nodes) {
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b <= a; ++b) { // a corner, or the middle of a side
      std::array<double, 4> l{};
      l[a] += 0.5, l[b] += 0.5;
      if (!(determinant(slopes_of_tetrahedron(mesh, nodes, l)) > 0)) return true;
    }
  return false;
}

bool folds_triangle(const Mesh& mesh, std::span<const int> nodes) {
  constexpr std::array<std::array<std::size_t, 3>, 3> middle{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
  const auto x = [&](std::size_t k) -> const Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(nodes[k])];
  };
  const Vector3d normal = (x(1) - x(0)).cross(x(2) - x(0));
  // d(x)/d(l_i) = sum_k l_k slope(i, k), as the coordinates' sum is 1
  const auto slope = [&](std::size_t i, std::size_t k) -> Vector3d {
    return i == k ? Vector3d(3 * x(i)) : Vector3d(4 * x(middle[i][k]) - x(i));
  };
  std::array<Vector3d, 3> first, second;
  for (std::size_t k = 0; k < 3; ++k)
    first[k] = slope(1, k) - slope(0, k), second[k] = slope(2, k) - slope(0, k);
  const auto m = [&](std::size_t i, std::size_t j) {
    return normal.dot(first[i].cross(second[j]) + first[j].cross(second[i])) / 2;
  };
  const double m0 = m(0, 0), m1 = m(1, 1), m2 = m(2, 2);
  if (!(m0 > 0 && m1 > 0 && m2 > 0)) return true;
  const double p01 = m(0, 1) + std::sqrt(m0 * m1), p02 = m(0, 2) + std::sqrt(m0 * m2),
               p12 = m(1, 2) + std::sqrt(m1 * m2);
  if (!(p01 > 0 && p02 > 0 && p12 > 0)) return true;
  return !(std::sqrt(m0 * m1 * m2) + m(0, 1) * std::sqrt(m2) + m(0, 2) * std::sqrt(m1) +
               m(1, 2) * std::sqrt(m0) + std::sqrt(2 * p01 * p02 * p12) >
           0);
}

/// Volume, with the rule of degree 2 of the solid elements.
Measure measure_tetrahedron(const Mesh& mesh, std::span<const int> nodes) {
  const auto x = [&](int k) -> const Vector3d& { return mesh.nodes[static_cast<std::size_t>(nodes[k])]; };
  if (nodes.size() == 4) {
    const double volume = (x(1) - x(0)).cross(x(2) - x(0)).dot(x(3) - x(0)) / 6;
    return {volume, !(volume > 0)};
  }
  const double near = (5 - std::sqrt(5.0)) / 20;
  Measure result{0, false};
  for (std::size_t point = 0; point < 4; ++point) {
    std::array<double, 4> l{near, near, near, near};
    l[point] = 1 - 3 * near;
    const double det = determinant(slopes_of_tetrahedron(mesh, nodes, l));
    result.area += det / 24;
    result.inverted |= !(det > 0);
  }
  return result;
}

void add_tetrahedra(const Mesh& mesh, const CellBlock& block, QualityReport& report) {
  for (int c = 0; c < block.size(); ++c) {
    const auto nodes = block.cell(c);
    std::array<Vector3d, 4> x;
    for (std::size_t a = 0; a < 4; ++a) x[a] = mesh.nodes[static_cast<std::size_t>(nodes[a])];
    const Straight straight(x);
    const auto [volume, inverted] = measure_tetrahedron(mesh, nodes);
    if (straight.smallest_angle < report.smallest_angle) {
      report.smallest_angle = straight.smallest_angle;
      report.worst_cell = c;
      report.worst_place = (x[0] + x[1] + x[2] + x[3]) / 4;
    }
    report.smallest_volume = report.tetrahedra == 0 ? volume : std::min(report.smallest_volume, volume);
    report.largest_volume = std::max(report.largest_volume, volume);
    report.volume += volume;
    report.tetrahedra += 1;
    report.largest_aspect = std::max(report.largest_aspect, straight.aspect);
    report.inverted += inverted;
    report
        .angles[std::min(static_cast<std::size_t>(straight.smallest_angle / 10), report.angles.size() - 1)] +=
        1;
  }
}

} // namespace

bool folds(const Mesh& mesh, CellType type, std::span<const int> nodes) {
  return type == CellType::triangle6       ? folds_triangle(mesh, nodes)
         : type == CellType::tetrahedron10 ? folds_tetrahedron(mesh, nodes)
                                           : false;
}

QualityReport quality(const Mesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  QualityReport report{.nodes = mesh.node_count(),
                       .smallest_angle = infinity,
                       .smallest_area = infinity,
                       .largest_area = -infinity};
  const Seen seen(mesh);
  Eigen::AlignedBox3d box;
  for (const CellBlock& block : mesh.blocks) {
    for (const int node : block.nodes) box.extend(mesh.nodes[static_cast<std::size_t>(node)]);
    if (is_tetrahedron(block.type)) {
      add_tetrahedra(mesh, block, report);
      continue;
    }
    if (!is_triangle(block.type)) {
      (is_line(block.type)       ? report.lines
       : is_meridian(block.type) ? report.meridians
                                 : report.rods) += block.size();
      continue;
    }
    for (int c = 0; c < block.size(); ++c) {
      const auto nodes = block.cell(c);
      const auto x = [&](int k) -> const Vector3d& { return mesh.nodes[nodes[k % 3]]; };
      double smallest = infinity, longest = 0, perimeter = 0;
      for (int k = 0; k < 3; ++k) {
        const Vector3d u = x(k + 1) - x(k), v = x(k + 2) - x(k);
        smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / std::numbers::pi);
        longest = std::max(longest, u.norm());
        perimeter += u.norm();
      }
      const double inradius = (x(1) - x(0)).cross(x(2) - x(0)).norm() / perimeter;
      const auto [area, inverted] = measure(mesh, seen, nodes);
      if (smallest < report.smallest_angle) {
        report.smallest_angle = smallest;
        report.worst_cell = c;
        report.worst_place = (x(0) + x(1) + x(2)) / 3;
      }
      report.triangles += 1;
      report.largest_aspect = std::max(report.largest_aspect, longest / (2 * std::numbers::sqrt3 * inradius));
      report.smallest_area = std::min(report.smallest_area, area);
      report.largest_area = std::max(report.largest_area, area);
      report.area += area;
      report.inverted += inverted;
      report.angles[std::min(static_cast<std::size_t>(smallest / 10), report.angles.size() - 1)] += 1;
    }
  }
  if (!box.isEmpty()) report.size = box.sizes();
  if (report.triangles == 0) report.smallest_area = report.largest_area = 0;
  if (report.worst_cell < 0) report.smallest_angle = 0;
  return report;
}

namespace {

/// Places of nodes as whole numbers, in steps within which two are the same.
class Grid {
 public:
  explicit Grid(const Mesh& mesh) : mesh_(mesh), step_(1e-9 * mesh.bounds().diagonal().norm()) {}
  std::array<double, 3> at(int node) const {
    const Eigen::Vector3d& x = mesh_.nodes[static_cast<std::size_t>(node)];
    return {std::round(x.x() / step_), std::round(x.y() / step_), std::round(x.z() / step_)};
  }

 private:
  const Mesh& mesh_;
  double step_;
};

} // namespace

int nodes_on_others(const Mesh& mesh, const CellBlock& cells) {
  const std::set<int> nodes(cells.nodes.begin(), cells.nodes.end());
  const Grid grid(mesh);
  std::set<std::array<double, 3>> points;
  for (const int node : nodes) points.insert(grid.at(node));
  return static_cast<int>(nodes.size() - points.size());
}

int nodes_beside(const Mesh& mesh, const std::set<int>& nodes, const CellBlock& cells) {
  const std::set<int> own(cells.nodes.begin(), cells.nodes.end());
  const Grid grid(mesh);
  std::set<std::array<double, 3>> points;
  for (const int node : own) points.insert(grid.at(node));
  return static_cast<int>(std::ranges::count_if(
      nodes, [&](int node) { return !own.contains(node) && points.contains(grid.at(node)); }));
}

std::string format(const QualityReport& report) {
  std::string text = fmt::format("nodes      {}\n", report.nodes);
  if (report.meridians > 0)
    text += fmt::format("meridians  {}\n", report.meridians);
  else if (report.rods > 0)
    text += fmt::format("rods       {}\n", report.rods);
  else if (report.tetrahedra > 0)
    text += fmt::format("tetrahedra {}\n", report.tetrahedra);
  else
    text += fmt::format("triangles  {}\n", report.triangles);
  text += fmt::format("lines      {}\n", report.lines);
  const Vector3d size = report.size * 1e3;
  text += fmt::format("size       {:.4g} x {:.4g} x {:.4g} mm\n", size.x(), size.y(), size.z());
  const int cells = report.triangles + report.tetrahedra;
  if (cells == 0) return text;
  const Vector3d worst = report.worst_place * 1e3;
  if (report.tetrahedra > 0) {
    text += fmt::format("volume     {:.6g} mm3 (tetrahedra {:.4g} .. {:.4g} mm3)\n", report.volume * 1e9,
                        report.smallest_volume * 1e9, report.largest_volume * 1e9);
    text += fmt::format(
        "angle      {:.2f} deg between faces at least, tetrahedron {} at ({:.4g}, {:.4g}, {:.4g}) mm\n",
        report.smallest_angle, report.worst_cell, worst.x(), worst.y(), worst.z());
  } else {
    text += fmt::format("area       {:.6g} mm2 (triangles {:.4g} .. {:.4g} mm2)\n", report.area * 1e6,
                        report.smallest_area * 1e6, report.largest_area * 1e6);
    text += fmt::format("angle      {:.2f} deg at least, triangle {} at ({:.4g}, {:.4g}{}) mm\n",
                        report.smallest_angle, report.worst_cell, worst.x(), worst.y(),
                        worst.z() == 0 ? "" : fmt::format(", {:.4g}", worst.z()));
  }
  text += fmt::format("aspect     {:.3g} at most (1 is equilateral)\ninverted   {}\n", report.largest_aspect,
                      report.inverted);
  text += fmt::format("smallest angles of the {}:\n", report.tetrahedra > 0 ? "tetrahedra" : "triangles");
  for (std::size_t k = 0; k < report.angles.size(); ++k) {
    const auto bar = static_cast<std::size_t>((50L * report.angles[k] + cells - 1) / cells);
    text += fmt::format("  {:2}-{} deg {:7}{}{}\n", 10 * k, 10 * k + 10, report.angles[k], bar > 0 ? " " : "",
                        std::string(bar, '#'));
  }
  return text;
}

} // namespace dielast::meshing
