// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/mesh_warnings.hpp"

#include "meshing/quality.hpp"
#include "post/engineering.hpp"

#include <fmt/format.h>

namespace dielast::cases {

std::vector<std::string> mesh_warnings(const Case& one, const meshing::Mesh& mesh) {
  constexpr double largest = 1; // m, of the templates' dimensions
  if (!one.geometry<MeshFile>()) return {};
  std::vector<std::string> warnings;
  if (const int cut = one.parts.size() == 1 ? meshing::nodes_on_others(mesh) : 0)
    warnings.push_back(fmt::format(
        "the film is cut: {} of its nodes lie on others; let gmsh fragment the drawing to join its parts",
        cut));
  const Eigen::Vector3d size = mesh.bounds().sizes();
  const bool has_unit = one.unnamed()->mesh.unit.has_value();
  if (!has_unit || size.maxCoeff() > largest)
    warnings.push_back(fmt::format("mesh.unit{}: the film is {} x {}",
                                   has_unit ? "" : " is missing, one unit of the mesh file is taken for 1 m",
                                   post::engineering(size.x(), "m"), post::engineering(size.y(), "m")));
  return warnings;
}

} // namespace dielast::cases
