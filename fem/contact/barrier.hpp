// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace dielast::fem {

/// An energy and its derivatives in the gap, per length or area.
struct BarrierEnergy {
  double value = 0, slope = 0, curvature = 0;
};

/// The barrier of Li et al. 2020 (ACM Trans. Graph. 39, 49): energy per length or area of what touches
///   stiffness * b(g), b(g) = -(g - thickness)^2 ln(g / thickness) for gaps g below the thickness, 0 above.
/// It is smooth, and infinite where faces meet; -slope is the contact's force per length, or its pressure.
/// With a foot, stiffness * foot/2 (g - thickness)^2 is added: what only just touches is not loose.
struct Barrier {
  double thickness = 0; ///< m
  double stiffness = 0; ///< of lengths Pa, of areas Pa/m
  double foot = 0;

  /// Of a gap, on any way that is tried.
  static constexpr double kept = 0.1;

  /// The largest gap at which it acts: surfaces that are drawn on one another touch, in spite of rounding.
  double reach() const { return thickness * (1 + 1e-9); }
  bool touches(double gap) const { return gap <= reach(); }
  BarrierEnergy at(double gap) const {
    if (!touches(gap)) return {};
    const double into = gap - thickness, ratio = into / gap, log = std::log(gap / thickness);
    return {stiffness * into * into * (foot / 2 - log), stiffness * into * (foot - 2 * log - ratio),
            stiffness * (foot - 2 * log - 4 * ratio + ratio * ratio)};
  }
};

} // namespace dielast::fem
