// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <array>

namespace dielast::meshing {

/// A side of a 10-node tetrahedron that no other has: a 6-node triangle, counter-clockwise seen from outside.
struct OuterSide {
  int cell; ///< the tetrahedron
  std::array<int, 6> nodes;
};
std::vector<OuterSide> outer_sides(const CellBlock& tetrahedra);

/// Outer sides of the mesh's 10-node tetrahedra whose nodes are in a place, clockwise seen from outside, such
/// that their normals point into the solid. Throws MeshError where the place has none.
CellBlock faces_at(const Mesh& mesh, const std::string& place);

/// Whether each side of these 6-node triangles is that of another one, too.
bool is_closed(const CellBlock& triangles);

/// Sides of the mesh's 6-node triangles whose three nodes are in a place and that belong to one triangle
/// only, as cells of a 3-node type, directed such that the triangle lies on their right: seen from what is
/// beyond the side they turn counter-clockwise. Throws MeshError where the place has none.
CellBlock sides_at(const Mesh& mesh, const std::string& place, CellType type);

} // namespace dielast::meshing
