// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/film_raster.hpp"

#include "meshing/solids/sides.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace dielast::post {

namespace {

using meshing::CellBlock;

/// Values at the nodes of triangles: means over the triangles of one region that share a node.
class NodeValues {
 public:
  NodeValues(const meshing::Mesh& mesh, const Panel& panel) : panel_(panel), nodes_(mesh.nodes.size()) {
    if (panel.values.empty()) return;
    const int regions = panel.regions.empty() ? 1 : std::ranges::max(panel.regions) + 1;
    sums_.resize(static_cast<std::size_t>(regions) * nodes_);
    std::size_t number = 0;
    for (const CellBlock& block : mesh.blocks) {
      if (is_line(block.type)) continue;
      for (int cell = 0; cell < block.size(); ++cell, ++number)
        if (const double value = panel.values[number]; std::isfinite(value))
          for (const int node : block.cell(cell)) {
            auto& [sum, count] = sums_[place(number, node)];
            sum += value;
            ++count;
          }
    }
  }
  /// Of a node of triangle `number`; not a number where the triangle has no value.
  double at(std::size_t number, int node) const {
    if (panel_.values.empty() || !std::isfinite(panel_.values[number])) return NAN;
    const auto& [sum, count] = sums_[place(number, node)];
    return sum / count;
  }

 private:
  std::size_t place(std::size_t number, int node) const {
    const auto region = static_cast<std::size_t>(panel_.regions.empty() ? 0 : panel_.regions[number]);
    return region * nodes_ + static_cast<std::size_t>(node);
  }

  const Panel& panel_;
  std::size_t nodes_;
  std::vector<std::pair<double, int>> sums_; ///< by region and node
};

/// What lies across the light has its full colours.
constexpr double darkest = 0.55;

double light_on(const Eigen::Vector3d& normal, const Placement& place) {
  const Eigen::Vector3d light(place.light.x(), -place.light.y(), place.light.z());
  return darkest + (1 - darkest) * std::abs(normal.dot(light)) / std::max(normal.norm(), 1e-300);
}

/// Corners in px, y downwards; as long as twice the area.
Eigen::Vector3d normal_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                          const Placement& place) {
  const auto raised = [&](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(x.x(), x.y(), place.relief * x.z());
  };
  return (raised(b) - raised(a)).cross(raised(c) - raised(a));
}

double light_on(const std::array<Corner, 3>& triangle, const Placement& place) {
  if (triangle[0].light != 1) return 1; // the corners' own
  if (place.light.z() == 1 && triangle[0].depth == triangle[1].depth &&
      triangle[0].depth == triangle[2].depth)
    return 1;
  const auto at = [&](std::size_t i) {
    return Eigen::Vector3d(triangle[i].place.x(), triangle[i].place.y(), triangle[i].depth);
  };
  return light_on(normal_of(at(0), at(1), at(2), place), place);
}

/// Light on the nodes of film that is nearly flat, such that waves look smooth; empty for other film.
std::vector<double> light_on_nodes(const meshing::Mesh& mesh, const Panel& panel, const Placement& place) {
  if (place.relief == 1) return {};
  std::vector<Eigen::Vector3d> normals(panel.positions.size(), Eigen::Vector3d::Zero());
  const auto add = [&](int a, int b, int c) {
    const auto at = [&](int node) { return place(panel.positions[static_cast<std::size_t>(node)]); };
    const Eigen::Vector3d normal = normal_of(at(a), at(b), at(c), place);
    for (const int node : {a, b, c}) normals[static_cast<std::size_t>(node)] += normal;
  };
  for (const CellBlock& block : mesh.blocks)
    for (int cell = 0; cell < block.size() && is_triangle(block.type); ++cell) {
      const auto n = block.cell(cell);
      if (n.size() == 3)
        add(n[0], n[1], n[2]);
      else
        for (const auto& part : {std::array{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}) {
          const auto node = [&](std::size_t i) { return n[static_cast<std::size_t>(part[i])]; };
          add(node(0), node(1), node(2));
        }
    }
  std::vector<double> light;
  for (const Eigen::Vector3d& normal : normals) light.push_back(light_on(normal, place));
  return light;
}

constexpr int most_parts = 3; ///< of a side

/// A triangle of six nodes, perhaps with curved sides, as `parts`^2 flat ones.
void draw_triangle(Raster& raster, const std::array<Eigen::Vector3d, 6>& x,
                   const std::array<double, 6>& value, const std::array<double, 6>& light, int parts,
                   const Palette& palette, const Placement& place) {
  std::array<std::array<Corner, most_parts + 1>, most_parts + 1> corners;
  for (int j = 0; j <= parts; ++j)
    for (int i = 0; i <= parts - j; ++i) {
      const double r = static_cast<double>(i) / parts, s = static_cast<double>(j) / parts, t = 1 - r - s;
      const std::array<double, 6> N{t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1),
                                    4 * r * t,       4 * r * s,       4 * s * t};
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      double v = 0, here = 0;
      for (std::size_t a = 0; a < 6; ++a) {
        p += N[a] * x[a];
        v += N[a] * value[a];
        here += N[a] * light[a];
      }
      if (light[0] == 1) here = 1;
      corners[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = {p.head<2>(), p.z(), v, here};
    }
  const auto draw = [&](const std::array<Corner, 3>& part) {
    raster.draw(part, palette, light_on(part, place));
  };
  const auto count = static_cast<std::size_t>(parts);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t i = 0; i < count - j; ++i) {
      draw({corners[j][i], corners[j][i + 1], corners[j + 1][i]});
      if (i + j + 1 < count) draw({corners[j][i + 1], corners[j + 1][i + 1], corners[j + 1][i]});
    }
}

/// Parts of a side: all have as many, so that neighbours leave no gap. Two follow a side that is bent by no
/// more than `bend`, within half a pixel.
int parts_of_sides(const meshing::Mesh& mesh, const Panel& panel, const Placement& place) {
  constexpr double px_of_part = 8, bend = 2;
  double px = 0, bent = 0;
  int sides = 0;
  for (const CellBlock& block : mesh.blocks)
    for (int cell = 0; cell < block.size() && !is_line(block.type); ++cell, ++sides) {
      const std::span<const int> nodes = block.cell(cell);
      const auto at = [&](std::size_t i) { return panel.positions[static_cast<std::size_t>(nodes[i])]; };
      px += place.scale * (at(0) - at(1)).norm();
      if (block.type != meshing::CellType::triangle6) continue;
      for (std::size_t i = 0; i < 3; ++i)
        bent = std::max(bent, place.scale * (at(3 + i) - (at(i) + at((i + 1) % 3)) / 2).norm());
    }
  return std::clamp(static_cast<int>(std::lround(px / std::max(sides, 1) / px_of_part)), 1,
                    bent <= bend ? 2 : most_parts);
}

} // namespace

bool is_framed(const meshing::Mesh& mesh) {
  using Side = std::array<int, 2>; // by its ends, ascending
  std::vector<Side> sides, lines;
  const auto add = [](std::vector<Side>& to, int a, int b) {
    to.push_back({std::min(a, b), std::max(a, b)});
  };
  for (const CellBlock& block : mesh.blocks) {
    if (!is_line(block.type) && !is_triangle(block.type)) return false;
    for (int cell = 0; cell < block.size(); ++cell) {
      const std::span<const int> nodes = block.cell(cell);
      if (is_line(block.type))
        add(lines, nodes[0], nodes[1]);
      else
        for (std::size_t i = 0; i < 3; ++i) add(sides, nodes[i], nodes[(i + 1) % 3]);
    }
  }
  std::ranges::sort(sides);
  std::ranges::sort(lines);
  for (auto side = sides.begin(); side != sides.end();) {
    const auto next = std::find_if(side, sides.end(), [&](const Side& other) { return other != *side; });
    if (next - side == 1 && !std::ranges::binary_search(lines, *side)) return false;
    side = next;
  }
  return true;
}

View view_of(std::span<const Panel> panels) {
  constexpr double flat = 0.04, even = 1e-6; ///< height over width
  constexpr double turned = 0.45, raised = 0.5, shown = 0.1;
  Eigen::AlignedBox3d box;
  for (const Panel& panel : panels)
    for (const Eigen::Vector3d& x : panel.positions) box.extend(x);
  const double height = box.isEmpty() ? 0 : box.sizes().z() / box.sizes().head<2>().norm();
  if (!(height > even)) return {};
  if (height <= flat) return {.light = Eigen::Vector3d(-1, 1, 1).normalized(), .relief = shown / height};
  const double c = std::cos(turned), s = std::sin(turned), up = std::sin(raised), aside = std::cos(raised);
  View view;
  view.axes << c, s, 0, -s * up, c * up, aside, s * aside, -c * aside, up;
  view.light = view.axes.col(2);
  return view;
}

Raster film_raster(const meshing::Mesh& mesh, const Panel& panel, std::pair<double, double> range,
                   const Placement& place) {
  const bool flat = std::ranges::all_of(
      panel.positions, [&](const Eigen::Vector3d& x) { return x.z() == panel.positions.front().z(); });
  Raster raster(static_cast<int>(place.size.x()), static_cast<int>(place.size.y()), flat);
  const NodeValues values(mesh, panel);
  const Palette palette = panel.values.empty() ? Palette(plain_film) : Palette(range);
  const int parts = parts_of_sides(mesh, panel, place);
  const std::vector<double> lights = light_on_nodes(mesh, panel, place);
  std::size_t number = 0;
  const auto draw = [&](std::size_t of, std::span<const int> nodes) {
    std::array<Eigen::Vector3d, 6> x;
    std::array<double, 6> value{}, light;
    light.fill(1);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      x[a] = place(panel.positions[static_cast<std::size_t>(nodes[a])]);
      value[a] = values.at(of, nodes[a]);
      if (!lights.empty()) light[a] = lights[static_cast<std::size_t>(nodes[a])];
    }
    if (nodes.size() == 3) {
      const auto corner = [&](std::size_t i) { return Corner{x[i].head<2>(), x[i].z(), value[i], light[i]}; };
      const std::array<Corner, 3> triangle{corner(0), corner(1), corner(2)};
      raster.draw(triangle, palette, light_on(triangle, place));
    } else {
      draw_triangle(raster, x, value, light, parts, palette, place);
    }
  };
  for (const CellBlock& block : mesh.blocks) {
    if (is_line(block.type)) continue;
    if (block.type == meshing::CellType::tetrahedron10)
      for (const meshing::OuterSide& side : meshing::outer_sides(block))
        draw(number + static_cast<std::size_t>(side.cell), side.nodes());
    if (is_triangle(block.type))
      for (int cell = 0; cell < block.size(); ++cell)
        draw(number + static_cast<std::size_t>(cell), block.cell(cell));
    number += static_cast<std::size_t>(block.size());
  }
  return raster;
}

} // namespace dielast::post
