// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <string>

namespace dielast::cases {

/// What a controller drives.
enum class Driven {
  voltage,      ///< of an electrode's source, V
  pressure,     ///< of the chamber, Pa
  volume,       ///< that is pumped into it, m^3
  force,        ///< of a load, N
  displacement, ///< of a support, m
};

/// One number among a case's loads.
struct DrivenLoad {
  Driven what{};
  std::string of{}; ///< the electrode, or the place; empty: the chamber
  int along = 0;    ///< of forces and displacements: 0, 1, 2 = x, y, z

  auto operator<=>(const DrivenLoad&) const = default; // NOLINT: its 0 is taken for a pointer
};

/// [[controller]]: in a transient what it drives follows a quantity that is measured at equal times and is
/// held in between: what the case says of the load, gain times what the quantity lacks of its target, and the
/// integral of that. The quantity and what is driven are in SI units.
struct Controller {
  static constexpr double most_samples = 1e6; ///< in a step
  DrivenLoad drives;
  std::string quantity;
  double target = 0;
  double gain = 0;                ///< per unit of the quantity
  double integral_gain = 0;       ///< per second and unit of the quantity
  double every = 0;               ///< between two measurements, s
  double lowest = 0, highest = 0; ///< while it is at a limit the integral does not go beyond it
};

} // namespace dielast::cases
