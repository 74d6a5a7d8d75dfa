// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "meshing/mesh.hpp"
#include "meshing/shares.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace dielast::cases {

/// What the user should know of the meshes that the geometries make, one sentence each.
std::vector<std::string> mesh_warnings(const Case& one, const meshing::Mesh& mesh);

/// The same of the user's own ones: there is no unit in a file, and regions may meet without being joined.
/// `parts` says which part each cell of the film belongs to, here and below.
std::vector<std::string> mesh_file_warnings(const Case& one, const meshing::Mesh& mesh,
                                            std::span<const int> parts);

/// A sentence for every part whose film is thick for its width (membranes and shells are of thin films), and
/// for walls that are wide for their length.
std::vector<std::string> thickness_warnings(const Case& one, const meshing::Mesh& mesh,
                                            std::span<const int> parts);

/// A sentence for every place with nodes beside what it is made of over which something is spread, or a mean
/// taken: what each node has of it says the mesh then, not the place.
std::vector<std::string> share_warnings(const Case& one,
                                        const std::map<std::string, meshing::Shares>& shares);

} // namespace dielast::cases
