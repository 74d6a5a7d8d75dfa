// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

namespace dielast::meshing {

/// Disc of hexagonal rings about the origin: ring i has 6 i nodes, ring 0 is the centre. The radii are
/// piecewise uniform, such that one ring lies on `electrode_radius` (m, at most `radius`); `rings` >= 2,
/// `order` 1 or 2. `curved` puts the middle nodes of sides along the electrode's edge and the rim onto
/// their circles (order 2).
///
/// Places: triangles `film`, `electrode` (inside electrode_radius), `passive` (where there is any); nodes
/// `electrode_edge`, `rim`, `centre`. Throws std::invalid_argument when a parameter is out of range,
/// MeshError when a ring is too thin for its sides.
Mesh disc_mesh(double radius, double electrode_radius, int rings, int order, bool curved);
/// How many of the rings are inside the electrode: its edge has six times as many sides.
int rings_of_electrode(double radius, double electrode_radius, int rings);

/// Annulus of `rings` >= 1 rings of triangles between the two radii (m); `grading` >= 1: thickness of the
/// outermost over the innermost, growing geometrically; `curved` as above, on all circles. The first circle
/// has six nodes for each of rings_of_hole(), so that triangles are nearly equilateral.
///
/// Places: triangles `film`; nodes `inner`, `outer`. Errors as disc_mesh().
Mesh annulus_mesh(double inner_radius, double outer_radius, int rings, int order, bool curved,
                  double grading = 1);
/// How many rings would be as wide as its hole: rings inner / (outer - inner) to the nearest integer >= 1.
int rings_of_hole(double inner_radius, double outer_radius, int rings);

} // namespace dielast::meshing
