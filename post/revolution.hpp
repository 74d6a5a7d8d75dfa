// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace dielast::post {

/// A mesh node turned about the z axis by an angle.
struct TurnedNode {
  int node = 0;
  double cosine = 1, sine = 0; ///< of the angle

  /// The node's vector, turned with it.
  Eigen::Vector3d operator()(std::span<const Eigen::Vector3d> per_node) const {
    const Eigen::Vector3d& v = per_node[static_cast<std::size_t>(node)];
    return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y(), v.z()};
  }
};

/// The surface of a film of revolution, for drawing: its meridian at equal angles, with facets between the
/// meridian's neighbouring nodes (middle ones included): quadrilaterals, triangles where one of the two is on
/// the axis. The facets' normals are the meridian's (t_z, 0, -t_x), turned.
struct Revolution {
  struct Facet {
    std::array<int, 4> points; ///< indices into `points`, counter-clockwise about the normal
    int corners;               ///< 3 or 4 of them
    int cell;                  ///< the meridian's cell
    int sector;                ///< by (sector + 1/2)/sectors of a turn its middle is turned
  };

  static constexpr int sectors = 48;

  /// Precondition: `meridians` is a block of the mesh and of meridians.
  Revolution(const meshing::Mesh& mesh, const meshing::CellBlock& meridians);

  std::vector<TurnedNode> points; ///< a node on the axis has one point, any other one per sector
  std::vector<Facet> facets;      ///< those of cell 0, then of cell 1, ...
};

} // namespace dielast::post
