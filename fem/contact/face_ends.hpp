// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/contact/surface_ends.hpp"
#include "meshing/mesh.hpp"

#include <Eigen/Core>

#include <vector>

namespace dielast::fem {

/// Where a surface of 6-node triangles ends, as drawn: on edges that one face has alone. What SurfaceEnds is
/// to sides.
class FaceEnds {
 public:
  FaceEnds() = default;
  /// `over`: length along which the ramp rises from an end, m; as much as there is where that is less.
  FaceEnds(const meshing::CellBlock& faces, const std::vector<Eigen::Vector3d>& drawn, double over);

  /// Distances of a face's nodes from the end, over that length: end_ramp() of what its shape functions tell
  /// between them is the ramp.
  const Eigen::Vector<double, 6>& at(int face) const { return faces_[static_cast<std::size_t>(face)]; }

 private:
  std::vector<Eigen::Vector<double, 6>> faces_;
};

} // namespace dielast::fem
