// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/patch.hpp"

#include <stdexcept>

namespace dielast::meshing {

Mesh patch_mesh(double length, double width) {
  if (!(length > 0 && width > 0)) throw std::invalid_argument("a patch needs a length and a width above 0");
  Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {length, 0, 0}, {length, width, 0}, {0, width, 0}};
  mesh.blocks = {{CellType::triangle3, {0, 1, 2, 0, 2, 3}}};
  mesh.cell_sets["film"] = {0, {0, 1}};
  mesh.node_sets = {{"film", {0, 1, 2, 3}}, {"left", {0, 3}}, {"right", {1, 2}},
                    {"bottom", {0, 1}},     {"top", {2, 3}},  {"centre", {0, 1, 2, 3}}};
  return mesh;
}

} // namespace dielast::meshing
