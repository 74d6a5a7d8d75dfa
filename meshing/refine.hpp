// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

namespace dielast::meshing {

/// Every triangle of a plane mesh is split into four, every line into two, at the middles of their sides;
/// curved sides of 6-node triangles keep their curve. Nodes keep their numbers, new ones come behind them. A
/// place of lines or triangles has all nodes of its parts, a place of single nodes stays as it is.
/// Precondition: no meridians.
Mesh refined(Mesh mesh);

} // namespace dielast::meshing
