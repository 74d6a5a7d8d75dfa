// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/axisymmetric.hpp"
#include "materials/material.hpp"

namespace dielast::materials {

/// Homogeneous tests of a film that is pulled to the stretch l along its first axis. Across, the film is
///   uniaxial: as wide as it is without a force there;  pure_shear: as wide as undeformed;
///   equal_biaxial: stretched by l, too.
enum class Mode { uniaxial, pure_shear, equal_biaxial };

/// One point of a film in a homogeneous test, without a field: the law and the branches with their internal
/// variables, by the potentials that an integration point of a film has.
class MaterialPoint {
 public:
  /// Undeformed and relaxed.
  MaterialPoint(const Material& material, Mode mode);

  /// Nominal stress, Pa, at the stretch l to which `scheme` leads from the last accepted times; the mean of
  /// both axes where both are pulled. Not a number where the law or a branch cannot be, or where there is no
  /// width without a force.
  double stress(double l, const TimeScheme& scheme);
  /// Accepts that state: the internal variables are those at its end.
  void accept(double l, const TimeScheme& scheme);
  /// Of a branch, at the last accepted time.
  const Internal& internal(std::size_t branch) const { return now_[branch]; }

 private:
  AxisymmetricPotential potential(double l, double across, const TimeScheme& scheme) const;
  double across(double l, const TimeScheme& scheme);
  double free_width(double l, double start, const TimeScheme& scheme) const;

  Material material_;
  Mode mode_;
  std::vector<Internal> now_, before_;
  double narrowing_ = 1; ///< uniaxial: the last stretch across, times sqrt(l)
};

} // namespace dielast::materials
