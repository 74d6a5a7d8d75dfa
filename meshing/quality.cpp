// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dielast::meshing {

namespace {

using Eigen::Vector3d;

/// In the plane in which the triangles are drawn: along x and y, of a solid of revolution x and z.
struct Plane {
  int up;
  explicit Plane(const Mesh& mesh) : up(mesh.nodes.empty() || mesh.bounds().sizes().y() > 0 ? 1 : 2) {}
  double cross(const Vector3d& a, const Vector3d& b) const { return a.x() * b[up] - a[up] * b.x(); }
};

struct Measure {
  double area;
  bool inverted;
};

Measure measure(const Mesh& mesh, const Plane& plane, std::span<const int> nodes) {
  const auto x = [&](int k) -> const Vector3d& { return mesh.nodes[nodes[k]]; };
  if (nodes.size() == 3) {
    const double area = plane.cross(x(1) - x(0), x(2) - x(0)) / 2;
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
      const double jacobian = plane.cross(along_1, along_2);
      result.area += weight * jacobian / 2;
      result.inverted |= !(jacobian > 0);
    }
  return result;
}

} // namespace

QualityReport quality(const Mesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  QualityReport report{.nodes = mesh.node_count(),
                       .smallest_angle = infinity,
                       .smallest_area = infinity,
                       .largest_area = -infinity};
  const Plane plane(mesh);
  for (const CellBlock& block : mesh.blocks) {
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
        smallest =
            std::min(smallest, std::atan2(std::abs(plane.cross(u, v)), u.dot(v)) * 180 / std::numbers::pi);
        longest = std::max(longest, u.norm());
        perimeter += u.norm();
      }
      const double inradius = std::abs(plane.cross(x(1) - x(0), x(2) - x(0))) / perimeter;
      const auto [area, inverted] = measure(mesh, plane, nodes);
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
  if (report.triangles == 0) report.smallest_angle = report.smallest_area = report.largest_area = 0;
  return report;
}

std::string format(const QualityReport& report) {
  std::string text = fmt::format("nodes      {}\n", report.nodes);
  if (report.meridians > 0)
    text += fmt::format("meridians  {}\n", report.meridians);
  else if (report.rods > 0)
    text += fmt::format("rods       {}\n", report.rods);
  else
    text += fmt::format("triangles  {}\n", report.triangles);
  text += fmt::format("lines      {}\n", report.lines);
  if (report.triangles == 0) return text;
  text += fmt::format("area       {:.6g} mm2 (triangles {:.4g} .. {:.4g} mm2)\n", report.area * 1e6,
                      report.smallest_area * 1e6, report.largest_area * 1e6);
  text += fmt::format("angle      {:.2f} deg at least, triangle {} at ({:.4g}, {:.4g}) mm\n",
                      report.smallest_angle, report.worst_cell, report.worst_place.x() * 1e3,
                      report.worst_place.y() * 1e3);
  text += fmt::format("aspect     {:.3g} at most (1 is equilateral)\ninverted   {}\n", report.largest_aspect,
                      report.inverted);
  text += "smallest angles of the triangles:\n";
  for (std::size_t k = 0; k < report.angles.size(); ++k) {
    const auto bar =
        static_cast<std::size_t>((50L * report.angles[k] + report.triangles - 1) / report.triangles);
    text += fmt::format("  {:2}-{} deg {:7}{}{}\n", 10 * k, 10 * k + 10, report.angles[k], bar > 0 ? " " : "",
                        std::string(bar, '#'));
  }
  return text;
}

} // namespace dielast::meshing
