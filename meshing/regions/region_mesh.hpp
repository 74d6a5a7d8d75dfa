// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"
#include "meshing/regions/region.hpp"

#include <span>

namespace dielast::meshing {

/// Film between two circles, cut into triangles along the edges of regions. Triangles are about as large as
/// those of `rings` rings whose thickness grows linearly with the radius, the outermost `grading` (>= 1)
/// times the innermost, and smaller where edges are close to one another. Order 1 or 2; with 2 the sides
/// along arcs are curved.
///
/// Places: triangles `film` and of each region by its name; nodes `inner` and `outer`, or of a disc `rim` and
/// `centre`. Throws MeshError for regions that cross or that a place is named after already,
/// std::invalid_argument for other parameters out of range.
Mesh region_mesh(const RoundFilm& film, std::span<const Region> regions, int rings, double grading,
                 int order);

/// Sides that a whole circle would have of the arc that this mesh divides into the fewest.
int fewest_sides(const RoundFilm& film, std::span<const Region> regions, int rings, double grading);

} // namespace dielast::meshing
