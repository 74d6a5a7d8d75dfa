// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <string>

namespace dielast::meshing {

/// A mesh of triangles and lines as a gmsh file (MSH 2.2), coordinates in m to the last digit; every place is
/// a physical group, of points where it has no cells. read_gmsh() makes the mesh of it again, numbered
/// otherwise. Precondition: no meridians, which gmsh does not know.
std::string gmsh_text(const Mesh& mesh);

} // namespace dielast::meshing
