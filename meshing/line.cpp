// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/line.hpp"

#include "meshing/middle_nodes.hpp"

#include <stdexcept>

namespace dielast::meshing {

namespace {

Mesh row(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int elements, CellType type,
         const char* place) {
  if (elements < 1 || from == to)
    throw std::invalid_argument("a line needs elements, and must end elsewhere than it starts");
  Mesh mesh;
  mesh.blocks = {{type, {}}};
  for (int n = 0; n <= elements; ++n) {
    const double part = static_cast<double>(n) / elements;
    mesh.nodes.emplace_back((1 - part) * from + part * to);
    if (n == 0) continue;
    mesh.blocks[0].nodes.insert(mesh.blocks[0].nodes.end(), {n - 1, n});
    mesh.cell_sets[place].cells.push_back(n - 1);
  }
  mesh.node_sets["start"] = {0};
  mesh.node_sets["end"] = {elements};
  return mesh;
}

} // namespace

Mesh line_mesh(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int elements, int order) {
  Mesh mesh = row(from, to, elements, CellType::line2, "line");
  if (order == 2) add_middle_nodes(mesh);
  add_node_sets(mesh);
  return mesh;
}

Mesh rod_mesh(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Mesh mesh = row(from, to, 1, CellType::rod2, "film");
  add_node_sets(mesh);
  return mesh;
}

} // namespace dielast::meshing
