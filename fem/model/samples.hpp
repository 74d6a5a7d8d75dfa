// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/tension_field.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace dielast::fem {

/// What a point of a solid says instead of a film's F and S. Axes: x, y, z; of a solid of revolution those at
/// y = 0, so that y is the hoop's direction.
struct SolidSample {
  Eigen::Matrix3d F;      ///< dx/dX
  Eigen::Matrix3d cauchy; ///< true stress, elastic + electrostatic, Pa
  Eigen::Vector3d field;  ///< true electric field, V/m
  double thickness = 0;   ///< of one of its layers, deformed, m; NaN where it has none
};

/// The film at one integration point.
struct MembraneSample {
  int cell = 0;                  ///< triangle, numbered as in the mesh's block
  double volume = 0;             ///< undeformed volume that the point stands for, m^3
  Eigen::Matrix<double, 3, 2> F; ///< dx/dX, from the UNSTRETCHED film to the current surface
  Eigen::Matrix2d
      S; ///< second Piola-Kirchhoff stress, elastic + electrostatic, Pa, w.r.t. the unstretched film
  double widening = 1;          ///< area of the film itself over that of F: more than 1 where it is wrinkled
  materials::Tension tension{}; ///< by the principal stresses, or as the relaxed film found it
  double thickness = 0;         ///< undeformed thickness H, m
  double voltage = 0;           ///< Phi across the film here, V; 0 outside every electrode
  double field_share = 1;       ///< nominal field here over Phi/H: of a bent layer's, uneven across it
  int electrode = -1;           ///< number of the electrode that covers it; -1: none
  int layer = 0;                ///< of a shell with several: 0 is the film itself, others lie on it
  double breakdown_field = 0;   ///< true field at which this film breaks down, V/m
  bool bears_compression = false;             ///< of a shell or a solid
  std::shared_ptr<const SolidSample> solid{}; ///< of a solid, F and S above are NaN; otherwise null
};

/// A wall at one integration point. Components: 1 along the wall, 2 across it in the film's plane, 3 normal
/// to the film; force = (axial, shear, shear), moment = (torsion, bending about 2, bending about 3).
struct BeamSample {
  int cell = 0;              ///< line, numbered as in the mesh's block
  double length = 0;         ///< undeformed length that the point stands for, m
  Eigen::Vector3d force;     ///< N
  Eigen::Vector3d moment;    ///< N m
  Eigen::Vector3d strain;    ///< axial and shear strains, -
  Eigen::Vector3d curvature; ///< change of curvature, 1/m
  double fibre_strain = 0;   ///< largest |strain| of fibres along the wall, over what the point stands for, -
  double yield_strain = 0;   ///< strain at which the wall's material yields, -
};

/// What the integration points say at one state.
struct Samples {
  std::vector<MembraneSample> film;
  std::vector<BeamSample> walls;
};

} // namespace dielast::fem
