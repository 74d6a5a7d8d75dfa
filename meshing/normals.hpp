// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace dielast::meshing {

/// Turns triangles (3 or 6 nodes) so that neighbours have their normals on one side. Triangles of a plane of
/// constant z, and surfaces whose mean normal is 30 degrees or more above or below that plane, have them
/// upwards; others away from their middle, and where neither tells, as in the first triangle. Surfaces end
/// where a side belongs to more than two triangles. Throws MeshError for a surface with one side only.
void turn_alike(const std::vector<Eigen::Vector3d>& nodes, CellBlock& triangles);

/// Unit normals of triangles at their nodes, 3 or 6 (d(x)/d(xi) x d(x)/d(eta), as they turn).
std::vector<Eigen::Vector3d> normals(const std::vector<Eigen::Vector3d>& nodes,
                                     std::span<const int> triangle);

/// Unit normals of a surface of triangles at each node of the mesh, the mean of its triangles'; zero at nodes
/// of none.
std::vector<Eigen::Vector3d> node_normals(const Mesh& mesh, const CellBlock& triangles);

} // namespace dielast::meshing
