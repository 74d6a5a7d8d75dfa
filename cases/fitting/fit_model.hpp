// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/material_point.hpp"

#include <vector>

namespace dielast::cases {

/// A homogeneous test as it was done: rows of a stretch that goes straight from one to the next. The film is
/// undeformed and relaxed until t = 0, or until the first row when that is earlier.
struct StretchHistory {
  materials::Mode mode{};
  std::vector<double> time; ///< s, growing; empty: infinitely slow, the branches are relaxed
  std::vector<double> stretch;
};

/// Nominal stress at every row, Pa, of a point of film (materials/material_point.hpp), which goes in `steps`
/// equal steps of time between two rows, and in twice as many: BDF2, or backward Euler where a step is more
/// than twice the one before, extrapolated to third order. A dashpot beside the law adds what it resists at
/// the row's rate: where the rows follow a curve that of the curve, at a corner that before it; in a uniaxial
/// test the branches must leave the width isotropic, which nominal dashpots do not. Not finite from where the
/// law cannot be on.
std::vector<double> nominal_stress(const materials::Material& material, const StretchHistory& history,
                                   int steps);

/// Smallest power of two of steps between rows, not below `at_least`, that is fine enough: twice as many
/// change no row by more than `tolerance` times the largest stress. At most 1024.
int steps_needed(const materials::Material& material, const StretchHistory& history, double tolerance,
                 int at_least = 1);

} // namespace dielast::cases
