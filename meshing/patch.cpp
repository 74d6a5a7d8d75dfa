// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/patch.hpp"

#include "meshing/middle_nodes.hpp"

#include <stdexcept>

namespace dielast::meshing {

Mesh patch_mesh(double length, double width, int order) {
  if (!(length > 0 && width > 0)) throw std::invalid_argument("a patch needs a length and a width above 0");
  Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {length, 0, 0}, {length, width, 0}, {0, width, 0}};
  mesh.blocks = {{CellType::triangle3, {0, 1, 2, 0, 2, 3}}};
  mesh.cell_sets["film"] = {0, {0, 1}};
  if (order == 2) add_middle_nodes(mesh);
  add_node_sets(mesh);
  for (int n = 0; n < mesh.node_count(); ++n) {
    const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(n)];
    if (x.x() == 0) mesh.node_sets["left"].push_back(n);
    if (x.x() == length) mesh.node_sets["right"].push_back(n);
    if (x.y() == 0) mesh.node_sets["bottom"].push_back(n);
    if (x.y() == width) mesh.node_sets["top"].push_back(n);
  }
  mesh.node_sets["centre"] = mesh.node_sets.at("film");
  return mesh;
}

} // namespace dielast::meshing
