// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"
#include "meshing/solids/surface.hpp"

namespace dielast::meshing {

/// 10-node tetrahedra with straight sides that fill a surface but for its cavities, by TetGen's Delaunay
/// refinement; `size`: about the longest side, in the surface's unit.
///
/// Places: tetrahedra `film`; nodes `surface`, its smooth faces `face_1`, `face_2` ... in the order in which
/// the surface has them, and, where the surface has triangles in a side of the box around it, `x_min`,
/// `x_max`, `y_min` ... Throws MeshError where a surface is turned
/// the wrong way round, or TetGen gives up.
Mesh filled(const Surface& surface, double size);

} // namespace dielast::meshing
