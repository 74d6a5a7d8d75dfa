// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <array>

namespace dielast::meshing {

/// A rectangle; lengths in m. `start`: its first x. Under the electrode, from electrode[0] to electrode[1]
/// behind the start, the height is charged but for a cover below and above.
struct SlabShape {
  double length = 0, height = 0, start = 0;
  std::array<double, 2> electrode{};
  double cover = 0;
};

/// Triangles of a slab with its lower side at height 0 along x; heights along y, or along z where it is
/// `upright`. `across` elements across the height; along x they are as long as high at the electrode's ends,
/// and up to `grading` times that away from them, but a third as many at least, and one more for each
/// doubling of those across. Where the slab is higher than long, `across` elements along x, and so up the
/// height.
///
/// Places: triangles `film`, `electrode`, `passive` (where there is any); nodes `left`, `right`, `bottom`,
/// `top`, `lower_electrode` and `upper_electrode`, the lower and upper sides of what is charged.
/// Throws std::invalid_argument for a shape that cannot be.
Mesh slab_mesh(const SlabShape& shape, int across, double grading, bool upright);

/// A slab with a width along z about z = 0, m, and its electrode's. `grading`: also along z, away from the
/// electrode's sides, or where it covers the width, the slab's; at least as many there, too.
struct BlockShape {
  SlabShape slab;
  double width = 0, electrode_width = 0;
};

/// Tetrahedra of a slab with a width: those of the triangles of slab_mesh(), drawn out along z.
///
/// Places: those of slab_mesh(), of tetrahedra, and the nodes `back` (z < 0) and `front` (z > 0). Throws
/// std::invalid_argument for a shape that cannot be.
Mesh block_mesh(const BlockShape& shape, int across, double grading);

/// The half plane x >= 0 of a hollow sphere about the origin, in the plane y = 0. Curved sides; `across`
/// elements across the wall, twice as long along it.
///
/// Places: triangles `film`; nodes `inner`, `outer`, `equator`, `south`, `north` (the lines on the axis).
/// Throws std::invalid_argument unless 0 < inner radius < outer radius.
Mesh hollow_sphere_mesh(double inner_radius, double outer_radius, int across);

/// The eighth x, y, z >= 0 of a hollow sphere, of tetrahedra; `across` elements across the wall, and as long
/// along it as in hollow_sphere_mesh().
///
/// Places: tetrahedra `film`; nodes `inner`, `outer`, `equator` (z = 0), `side_x` (x = 0), `side_y` (y = 0).
/// Throws std::invalid_argument unless 0 < inner radius < outer radius.
Mesh sphere_eighth_mesh(double inner_radius, double outer_radius, int across);

} // namespace dielast::meshing
