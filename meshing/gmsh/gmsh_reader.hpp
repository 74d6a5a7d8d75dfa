// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/gmsh/gmsh_contents.hpp"
#include "meshing/mesh.hpp"

#include <filesystem>

namespace dielast::meshing {

/// Reads a mesh file of gmsh (MSH 4.1 or 2.2), coordinates in m: 4- or 10-node tetrahedra, 3- or 6-node
/// triangles and 2- or 3-node lines, all of one order. Nodes without a cell are dropped; clockwise triangles
/// are turned round, and where there are 4-node tetrahedra all cells get middle nodes.
///
/// Places are the physical groups of points, lines, surfaces and volumes, by name; one without a name is
/// called "surface 3" after its tag. `film` (all tetrahedra, without any all triangles) is added unless the
/// file has a place of that name. Throws MeshError saying what to change.
Mesh read_gmsh(const std::filesystem::path& path);

/// The mesh of what gmsh has found in a file, which is not believed: a damaged file may have made gmsh write
/// anything there. Messages come without the file's name.
Mesh mesh_of(GmshContents contents);

} // namespace dielast::meshing
