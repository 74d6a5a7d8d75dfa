// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <span>
#include <vector>

namespace dielast::post {

/// An edge of a bar beside one of its nodes.
struct BarPoint {
  int node = 0;
  Eigen::Vector3d arm; ///< from the node, as drawn, m

  Eigen::Vector3d place(std::span<const Eigen::Vector3d> nodes) const { return of(nodes) + arm; }
  /// m; `rotation` per node from the mesh as drawn.
  Eigen::Vector3d displacement(std::span<const Eigen::Vector3d> displacement,
                               std::span<const Eigen::Quaterniond> rotation) const {
    return of(displacement) + turned(rotation) - arm;
  }
  /// How a small motion of the nodes, displacement and spin, about rotations moves the edge.
  Eigen::Vector3d motion(std::span<const Eigen::Vector3d> displacement, std::span<const Eigen::Vector3d> spin,
                         std::span<const Eigen::Quaterniond> rotation) const {
    return of(displacement) + of(spin).cross(turned(rotation));
  }

 private:
  Eigen::Vector3d of(std::span<const Eigen::Vector3d> per_node) const {
    return per_node[static_cast<std::size_t>(node)];
  }
  Eigen::Vector3d turned(std::span<const Eigen::Quaterniond> rotation) const {
    return rotation[static_cast<std::size_t>(node)] * arm;
  }
};

/// The bars along the lines of a mesh as the solids that they are, for drawing: hexahedra between
/// neighbouring nodes of a line (middle ones included), each with a section of its own at both ends, so that
/// bars that meet in a joint overlap there.
struct Bars {
  struct Hexahedron {
    std::array<int, 8> points; ///< indices into `points`, in VTK's order
    int cell;                  ///< the line
  };

  /// `widths` across each line in the plane of x and y, `heights` along z, as drawn, m. Precondition: `lines`
  /// is a block of the mesh and of lines, none along z.
  Bars(const meshing::Mesh& mesh, const meshing::CellBlock& lines, std::span<const double> widths,
       std::span<const double> heights);

  std::vector<BarPoint> points;
  std::vector<Hexahedron> hexahedra; ///< those of line 0, then of line 1, ...
};

} // namespace dielast::post
