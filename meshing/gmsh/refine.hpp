// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

namespace dielast::meshing {

/// Every triangle is split into four, every tetrahedron into eight, every line into two, at the middles of
/// their sides; curved sides of cells with middle nodes keep their curve. Nodes keep their numbers, new ones
/// come behind them. A place of cells has all nodes of its parts. A place that is given by its nodes has what
/// is new on sides, triangles and the boundary of tetrahedra that are all of its nodes; of a mesh without
/// middle nodes on sides between two of its nodes, but for those that cut off a corner of the boundary.
/// Precondition: no meridians.
Mesh refined(Mesh mesh);

} // namespace dielast::meshing
