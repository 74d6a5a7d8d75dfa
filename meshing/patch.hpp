// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

namespace dielast::meshing {

/// A rectangle of two 3-node triangles with its corner at the origin; length along x, width along y, m.
///
/// Places: triangles `film`; nodes `left`, `right`, `bottom`, `top` (sides), `centre` (its centroid is the
/// rectangle's). Throws std::invalid_argument when a size is not positive.
Mesh patch_mesh(double length, double width, int order = 1);

/// m
struct StripShape {
  double length, width;                     ///< along y, along x
  double electrode_length, electrode_width; ///< of the rectangle in its middle, at most those of the strip
};

/// A rectangle of rows of triangles, x from -width/2 to width/2, y from -length to 0, mirrored in its middle
/// lines; about `across` elements from side to side, with nodes along the electrode's edge.
///
/// Places: triangles `film`, `electrode` and, where there are any beside it, `passive`; nodes `upper_end` (y
/// = 0), `lower_end`, `left`, `right`. Throws std::invalid_argument for sizes that cannot be.
Mesh strip_mesh(const StripShape& shape, int across, int order);

} // namespace dielast::meshing
