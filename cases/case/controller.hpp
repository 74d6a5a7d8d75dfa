// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace dielast::cases {

/// [[controller]]: in a transient what the source of an electrode gives follows a quantity that is measured
/// at equal times and is held in between: the voltage of its [drive], gain times what the quantity lacks of
/// its target, and the integral of that. The quantity is in its SI unit.
struct Controller {
  static constexpr double most_samples = 1e6; ///< in a step
  std::string electrode;
  std::string quantity;
  double target = 0;
  double gain = 0;                ///< V per unit of the quantity
  double integral_gain = 0;       ///< V/s per unit of the quantity
  double every = 0;               ///< between two measurements, s
  double lowest = 0, highest = 0; ///< V; while the source is at a limit the integral does not go beyond it
};

} // namespace dielast::cases
