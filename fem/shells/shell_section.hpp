// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/material.hpp"

#include <array>
#include <optional>
#include <vector>

namespace dielast::fem {

/// A film in a shell, with its own electrode pair, if any.
struct ShellLayer {
  materials::Material material;
  double thickness = 0;                              ///< undeformed H, m
  std::optional<std::array<double, 2>> prestretch{}; ///< of its own, see ShellSection
  int number = 0;                                    ///< in its samples, see MembraneSample::layer
};

/// The layers of a shell, one on the other along its normal. As for a membrane (see MembraneSection) the mesh
/// is drawn in the prestretched plane, in which the layers are bonded; a shell that is not drawn flat,
/// parallel to the xy plane, has no prestretch.
struct ShellSection {
  std::vector<ShellLayer> layers;
  std::array<double, 2> prestretch{1.0, 1.0}; ///< lambda_p along x and y of the drawing, where a layer has
                                              ///< none of its own
  double offset = 0;      ///< from the drawn surface to the middle of the layers before `prestretch`, m
  double drilling = 1e-3; ///< holds spins about directors, where there are any, over the shear's stiffness

  /// Stretches of a layer along x and y over those that it would have with `prestretch`.
  std::array<double, 2> extra_stretch(const ShellLayer& layer) const {
    if (!layer.prestretch) return {1.0, 1.0};
    return {(*layer.prestretch)[0] / prestretch[0], (*layer.prestretch)[1] / prestretch[1]};
  }
  /// What a layer fills of the thickness before `prestretch`, m: it keeps its volume.
  double depth_of(const ShellLayer& layer) const {
    const auto [x, y] = extra_stretch(layer);
    return layer.thickness / (x * y);
  }
  /// What a function of a layer and of the place of its middle, m above the drawn surface before
  /// `prestretch`, says of all layers, from below.
  template<class Visitor>
  void for_each_layer(const Visitor& visit) const {
    double height = 0;
    for (const ShellLayer& layer : layers) height += depth_of(layer);
    double bottom = offset - height / 2;
    for (const ShellLayer& layer : layers) {
      const double depth = depth_of(layer);
      visit(layer, bottom + depth / 2);
      bottom += depth;
    }
  }
};

/// The mass of a shell's section: of its drawn surface, kg/m^2, and where its centre lies above that as
/// drawn, m; 0 where that is a rounding of the thickness, below 1e-6 of it.
struct ShellMass {
  double per_area = 0, lever = 0;

  static ShellMass of(const ShellSection& section);
};

} // namespace dielast::fem
