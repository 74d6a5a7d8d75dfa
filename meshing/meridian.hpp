// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

namespace dielast::meshing {

/// Meridians of films of revolution about the z axis: curves in the plane y = 0, x the radius. Cells run so
/// that their normal n = (t_z, 0, -t_x), t from the first node to the second, points up or out: from the rim
/// to the centre, from the south pole to the north pole. Cells and their corners are numbered along the
/// curve, middle nodes follow. Dimensions in m, `order` 1 or 2; all throw std::invalid_argument when a
/// parameter is out of range.

/// `elements` >= 2, uniform on either side of the electrode's edge. Places: cells `film`, `electrode` (inside
/// electrode_radius <= radius), `passive` (where there is any); nodes `electrode_edge`, `rim`, `centre`.
Mesh disc_meridian(double radius, double electrode_radius, int elements, int order);

/// `elements` >= 1, growing outwards geometrically; `grading` >= 1: length of the outermost over that of the
/// innermost. Places: cells `film`; nodes `inner`, `outer`.
Mesh annulus_meridian(double inner_radius, double outer_radius, int elements, int order, double grading);

/// Half a circle of equal elements; `elements` >= 1, their number rounded up to an even one. Places: cells
/// `film`; nodes `equator`, `south`, `north`.
Mesh balloon_meridian(double radius, int elements, int order);

/// A cylinder from z = 0 to `length`, of about `elements` >= 2 with a node at each end of the electrode in
/// its middle. Places: cells `film`, `electrode` and, where there are any beside it, `passive`; nodes
/// `lower_end` (z = 0), `upper_end`.
Mesh roll_meridian(double length, double radius, double electrode_length, int elements, int order);

} // namespace dielast::meshing
