// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace dielast::meshing {

/// What triangles must follow: closed curves of straight sides around a plane region and its holes, and other
/// sides in it. Any unit of length.
struct PlanarGraph {
  std::vector<Eigen::Vector2d> points; ///< ends of sides; others become nodes, too
  std::vector<std::array<int, 2>> outline;
  std::vector<std::array<int, 2>> inner{};
};

/// Triangles of a plane region. The first points are those of its graph or outline, in order.
struct Triangulation {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::array<int, 3>> triangles; ///< counter-clockwise
  std::vector<int> pieces; ///< for each triangle the piece in which it lies, from 0: sides part a region
};

/// Constrained Delaunay triangulation.
///
/// Every side becomes the side of a triangle; only points between the sides are added. The target size at a
/// point is min over sides (length + distance / 2), at most `largest_size(point)`. The points repeat the
/// mirror symmetries of the graph about the axes through the middle of its bounding box. Deterministic.
/// Throws MeshError when sides cross.
Triangulation triangulate(const PlanarGraph& graph,
                          const std::function<double(const Eigen::Vector2d&)>& largest_size);

/// Of a simple polygon (counter-clockwise); the largest size is `grading` (>= 1) times its longest side.
Triangulation triangulate(std::span<const Eigen::Vector2d> outline, double grading);

} // namespace dielast::meshing
