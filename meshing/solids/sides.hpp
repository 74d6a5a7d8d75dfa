// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

namespace dielast::meshing {

/// Sides of the mesh's 6-node triangles whose three nodes are in a place and that belong to one triangle
/// only, as cells of a 3-node type, directed such that the triangle lies on their right: seen from what is
/// beyond the side they turn counter-clockwise. Throws MeshError where the place has none.
CellBlock sides_at(const Mesh& mesh, const std::string& place, CellType type);

} // namespace dielast::meshing
