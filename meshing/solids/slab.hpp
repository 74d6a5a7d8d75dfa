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
/// and up to `grading` times that away from them.
///
/// Places: triangles `film`, `electrode`, `passive` (where there is any); nodes `left`, `right`, `bottom`,
/// `top`. Throws std::invalid_argument for a shape that cannot be.
Mesh slab_mesh(const SlabShape& shape, int across, double grading, bool upright);

/// The half plane x >= 0 of a hollow sphere about the origin, in the plane y = 0. Curved sides; `across`
/// elements across the wall, twice as long along it.
///
/// Places: triangles `film`; nodes `inner`, `outer`, `equator`, `south`, `north` (the lines on the axis).
/// Throws std::invalid_argument unless 0 < inner radius < outer radius.
Mesh hollow_sphere_mesh(double inner_radius, double outer_radius, int across);

} // namespace dielast::meshing
