// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace dielast::meshing {

/// Throws MeshError where gmsh would read something else than a mesh file says, without a word: two physical
/// groups of one dimension and name, of which it drops the second one's name; and in files of version 2.2
/// more elements than are announced, and elements of one entity in different physical groups, as it puts each
/// of an entity's elements into all of the entity's groups. What is damaged otherwise is left to gmsh.
void check_gmsh_file(const std::filesystem::path& path);

} // namespace dielast::meshing
