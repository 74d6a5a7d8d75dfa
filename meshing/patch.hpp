// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

namespace dielast::meshing {

/// A rectangle of two 3-node triangles with its corner at the origin; length along x, width along y, m.
///
/// Places: triangles `film`; nodes `left`, `right`, `bottom`, `top` (sides), `centre` (its centroid is the
/// rectangle's). Throws std::invalid_argument when a size is not positive.
Mesh patch_mesh(double length, double width, int order = 1);

} // namespace dielast::meshing
