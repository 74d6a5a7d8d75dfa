// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"
#include "meshing/middle_nodes.hpp"

#include <functional>
#include <random>

namespace dielast::fem::test {

/// Square film of `side` (m) from the origin, 2 n^2 triangles whose inner corners are moved at random by up
/// to `distortion` of their spacing. Places: triangles `film`, nodes `edge`.
inline meshing::Mesh distorted_square(int n, int order, double side = 1, double distortion = 0.25) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-distortion, distortion);
  meshing::Mesh mesh;
  meshing::CellBlock triangles{meshing::CellType::triangle3, {}};
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const bool inside = i > 0 && i < n && j > 0 && j < n;
      const double x = i + (inside ? shift(random) : 0), y = j + (inside ? shift(random) : 0);
      mesh.nodes.emplace_back(side * x / n, side * y / n, 0);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      if ((i + j) % 2)
        triangles.nodes.insert(triangles.nodes.end(), {a, b, c, a, c, d});
      else
        triangles.nodes.insert(triangles.nodes.end(), {a, b, d, b, c, d});
    }
  mesh.cell_sets["film"].cells.resize(static_cast<std::size_t>(triangles.size()));
  for (int c = 0; c < triangles.size(); ++c) mesh.cell_sets["film"].cells[static_cast<std::size_t>(c)] = c;
  mesh.blocks = {std::move(triangles)};
  if (order == 2) meshing::add_middle_nodes(mesh);
  meshing::add_node_sets(mesh);
  const double margin = 1e-9 * side;
  for (int a = 0; a < mesh.node_count(); ++a) {
    const Eigen::Vector3d& X = mesh.nodes[static_cast<std::size_t>(a)];
    if (X.head<2>().minCoeff() < margin || X.head<2>().maxCoeff() > side - margin)
      mesh.node_sets["edge"].push_back(a);
  }
  return mesh;
}

/// Film of `length` by `width` (m) from the origin along x, one row of 2 n triangles. Node sets `left` and
/// `right` are its ends.
inline meshing::Mesh strip(int n, int order, double length, double width) {
  meshing::Mesh mesh;
  meshing::CellBlock triangles{meshing::CellType::triangle3, {}};
  for (int i = 0; i <= n; ++i)
    for (const double y : {0.0, width}) mesh.nodes.emplace_back(length * i / n, y, 0);
  for (int i = 0; i < 2 * n; i += 2)
    triangles.nodes.insert(triangles.nodes.end(), {i, i + 2, i + 1, i + 2, i + 3, i + 1});
  mesh.blocks = {std::move(triangles)};
  if (order == 2) meshing::add_middle_nodes(mesh);
  for (int a = 0; a < mesh.node_count(); ++a) {
    if (mesh.nodes[static_cast<std::size_t>(a)].x() == 0) mesh.node_sets["left"].push_back(a);
    if (mesh.nodes[static_cast<std::size_t>(a)].x() == length) mesh.node_sets["right"].push_back(a);
  }
  return mesh;
}

/// Adds a block of lines along a curve over s in 0..1, with new nodes in the curve's order; `place(t)` maps
/// uniform steps t to s.
inline void add_line(
    meshing::Mesh& mesh, int elements, int order, const std::function<Eigen::Vector3d(double)>& curve,
    const std::function<double(double)>& place = [](double t) { return t; }) {
  meshing::CellBlock lines{order == 2 ? meshing::CellType::line3 : meshing::CellType::line2, {}};
  int node = mesh.node_count();
  mesh.nodes.push_back(curve(0));
  for (int e = 0; e < elements; ++e, node += order) {
    const double from = place(static_cast<double>(e) / elements),
                 to = place(static_cast<double>(e + 1) / elements);
    if (order == 2) mesh.nodes.push_back(curve((from + to) / 2));
    mesh.nodes.push_back(curve(to));
    lines.nodes.insert(lines.nodes.end(), {node, node + order});
    if (order == 2) lines.nodes.push_back(node + 1);
  }
  mesh.blocks.push_back(std::move(lines));
}

/// A mesh that is one line, see add_line().
inline meshing::Mesh line(
    int elements, int order, const std::function<Eigen::Vector3d(double)>& curve,
    const std::function<double(double)>& place = [](double t) { return t; }) {
  meshing::Mesh mesh;
  add_line(mesh, elements, order, curve, place);
  return mesh;
}

} // namespace dielast::fem::test
