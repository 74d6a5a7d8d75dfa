// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace dielast::meshing {

/// Triangles of a plane region. The first points are those of its outline, in order.
struct Triangulation {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::array<int, 3>> triangles; ///< counter-clockwise
};

/// Constrained Delaunay triangulation of a simple polygon (counter-clockwise, any unit of length).
///
/// Every side of `outline` becomes the side of exactly one triangle; only interior points are added. The
/// target size at a point is min over sides (length + distance / 2), at most `grading` (>= 1) times the
/// longest side. The points repeat the mirror symmetries of the outline about the axes through the middle of
/// its bounding box. Deterministic. Throws MeshError when the outline crosses itself.
Triangulation triangulate(std::span<const Eigen::Vector2d> outline, double grading);

} // namespace dielast::meshing
