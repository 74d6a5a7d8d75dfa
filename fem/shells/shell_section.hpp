// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/material.hpp"

#include <array>
#include <vector>

namespace dielast::fem {

/// A film in a shell, with its own electrode pair, if any.
struct ShellLayer {
  materials::Material material;
  double thickness = 0; ///< undeformed H, m
};

/// The layers of a shell, one on the other along its normal. As for a membrane (see MembraneSection) the mesh
/// is drawn in the prestretched plane; a shell that is not drawn flat, parallel to the xy plane, has none.
struct ShellSection {
  std::vector<ShellLayer> layers;
  std::array<double, 2> prestretch{1.0, 1.0}; ///< lambda_p along x and y of the drawing
  double offset = 0;      ///< from the drawn surface to the middle of the undeformed layers, m
  double drilling = 1e-3; ///< holds spins about directors, where there are any, over the shear's stiffness
};

} // namespace dielast::fem
