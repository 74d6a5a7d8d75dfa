// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/material.hpp"

#include <array>

namespace dielast::fem {

/// Reduces a film's material to a membrane. The mesh is drawn in the film's prestretched plane: with the
/// prestretch F0 = diag(lambda_p1, lambda_p2) from the unstretched film to the drawing, C = F0^T C_drawn F0
/// and the undeformed volume is H dA_drawn / (lambda_p1 lambda_p2). A rod is a strip of film, see
/// RodKinematics.
struct MembraneSection {
  materials::Material material;
  double thickness = 0; ///< undeformed H of a layer, m
  int layers = 1;       ///< one on another, each with the electrode's voltage across it
  double covers = 0;    ///< undeformed thickness of all that is bonded to them without a voltage across it, m
  std::array<double, 2> prestretch{1.0, 1.0}; ///< lambda_p along x and y of the drawing; of a rod along it
  bool tension_field = false;                 ///< wrinkles carry no compression (materials/tension_field.hpp)
  double wrinkled = 1e-5; ///< share of the taut film's potential left where it wrinkles: a regular tangent
  double width = 0;       ///< of a rod: unstretched, all layers side by side, m

  /// Thickness of the whole section over that of the layers. Covers deform and wrinkle with these: energy and
  /// stresses are means over the section, as if all of it had the field, with so much less permittivity.
  double bulk() const { return 1 + covers / (layers * thickness); }
};

} // namespace dielast::fem
