// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

namespace dielast::meshing {

/// A straight row of lines of equal length: 2-node (order 1) or 3-node ones. Places: `line`, and the nodes
/// `start` and `end`. Throws std::invalid_argument without elements, or where it ends where it starts.
Mesh line_mesh(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int elements, int order);

/// One straight rod. Places: `film`, and the nodes `start` and `end`. Throws like line_mesh().
Mesh rod_mesh(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

} // namespace dielast::meshing
