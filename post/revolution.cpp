// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/revolution.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::post {

Revolution::Revolution(const meshing::Mesh& mesh, const meshing::CellBlock& meridians) {
  const auto radius = [&](int node) { return std::abs(mesh.nodes[static_cast<std::size_t>(node)].x()); };
  double largest = 0;
  for (const int node : meridians.nodes) largest = std::max(largest, radius(node));
  const auto on_axis = [&](int node) { return radius(node) <= 1e-9 * largest; };

  std::vector<int> first_point(mesh.nodes.size(), -1);
  const auto point = [&](int node, int sector) {
    int& first = first_point[static_cast<std::size_t>(node)];
    if (first < 0) {
      first = static_cast<int>(points.size());
      for (int s = 0; s < (on_axis(node) ? 1 : sectors); ++s) {
        const double angle = 2 * std::numbers::pi * s / sectors;
        points.push_back({node, std::cos(angle), std::sin(angle)});
      }
    }
    return on_axis(node) ? first : first + sector % sectors;
  };
  const auto add_strip = [&](int a, int b, int cell) {
    for (int s = 0; s < sectors; ++s) {
      if (on_axis(a))
        facets.push_back({{point(a, s), point(b, s + 1), point(b, s), -1}, 3, cell, s});
      else if (on_axis(b))
        facets.push_back({{point(a, s), point(a, s + 1), point(b, s), -1}, 3, cell, s});
      else
        facets.push_back({{point(a, s), point(a, s + 1), point(b, s + 1), point(b, s)}, 4, cell, s});
    }
  };
  for (int cell = 0; cell < meridians.size(); ++cell) {
    const auto nodes = meridians.cell(cell);
    int from = nodes[0];
    for (const int middle : nodes.subspan(2)) {
      add_strip(from, middle, cell);
      from = middle;
    }
    add_strip(from, nodes[1], cell);
  }
}

} // namespace dielast::post
