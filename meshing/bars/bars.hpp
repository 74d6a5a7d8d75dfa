// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

namespace dielast::meshing {

/// A straight row of lines of equal length: 2-node (order 1) or 3-node ones. Places: `line`, and the nodes
/// `start` and `end`. Throws std::invalid_argument without elements, or where it ends where it starts.
Mesh line_mesh(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int elements, int order);

/// One straight rod. Places: `film`, and the nodes `start` and `end`. Throws like line_mesh().
Mesh rod_mesh(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Two rolls beside a hinge, as drawn, m. The hinge leads from the origin along -x; a ribbon leads back from
/// the tip, at half the hinge's thickness and `arm` from the axis, to the end of a roll that lies `arm`
/// farther out, parallel to x.
struct RollsShape {
  double roll_length = 0, hinge_length = 0, hinge_thickness = 0, ribbon_length = 0, arm = 0;
};

/// Places: `film` (both rolls), `upper` (y > 0) and `lower`, `hinge`, `upper_ribbon` and `lower_ribbon`, and
/// the nodes `base` (of the hinge), `tip_ends` (of hinge and ribbons, on the tip), `joints` (of ribbons and
/// rolls), `roots` (of the rolls). `elements`: of the hinge and of each ribbon; `order` 1 or 2. Throws
/// std::invalid_argument where an arm is not shorter than the ribbon.
Mesh rolls_mesh(const RollsShape& shape, int elements, int order);

} // namespace dielast::meshing
