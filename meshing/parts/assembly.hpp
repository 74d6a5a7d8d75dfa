// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <string>

namespace dielast::meshing {

/// Adds a mesh to another, with its own nodes: its places are called "<name>.<place>", and all of it
/// "<name>". Films of both become one block, walls of both another. Throws MeshError: elements of different
/// orders or kinds, or a place of that name is there.
void append(Mesh& whole, const Mesh& part, const std::string& name);

/// Makes one node of each two that two places have at the same point, within 1e-6 of the mesh's extent.
/// Throws MeshError where a node of the smaller place has none in the other, and says how far away the
/// nearest one is; where a node of the other is between these, on an edge or a surface of a cell that has
/// them, outside or inside (the meshes would be cracked there); or where the places share all of these nodes
/// already.
void join(Mesh& mesh, const std::string& place, const std::string& other);

} // namespace dielast::meshing
