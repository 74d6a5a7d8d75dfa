// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"
#include "post/pictures/picture.hpp"
#include "post/pictures/raster.hpp"

#include <Eigen/Core>

#include <span>
#include <utility>

namespace dielast::post {

constexpr Colour plain_film{0.86, 0.89, 0.92};

/// A device that is not flat is seen from aside and above; otherwise along z, what is nearly flat in a light
/// from aside that shows its relief.
struct View {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< rows: right, up and towards the viewer
  Eigen::Vector3d light = Eigen::Vector3d::UnitZ();   ///< towards it, in these axes
  double relief = 1;                                  ///< see Placement
};

View view_of(std::span<const Panel> panels);

/// Whether lines of the mesh run along all edges of its film, which is of triangles.
bool is_framed(const meshing::Mesh& mesh);

/// From a state's positions to px of a canvas, y downwards, z towards the viewer.
struct Placement {
  double scale;
  Eigen::Vector3d centre; ///< in the middle of the canvas
  Eigen::Vector2d size;   ///< of the canvas
  Eigen::Vector3d light;  ///< unit vector towards it
  double relief = 1;      ///< by which heights are exaggerated where light falls on them

  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d p = scale * (x - centre);
    return {size.x() / 2 + p.x(), size.y() / 2 - p.y(), p.z()};
  }
};

/// The triangles of a panel, coloured by its values between their nodes; `range` of the colours.
Raster film_raster(const meshing::Mesh& mesh, const Panel& panel, std::pair<double, double> range,
                   const Placement& place);

} // namespace dielast::post
