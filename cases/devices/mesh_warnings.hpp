// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "meshing/mesh.hpp"

#include <string>
#include <vector>

namespace dielast::cases {

/// What the user should know of an own mesh, one sentence each: it has no unit in its file, and its regions
/// may meet without being joined.
std::vector<std::string> mesh_warnings(const Case& one, const meshing::Mesh& mesh);

} // namespace dielast::cases
