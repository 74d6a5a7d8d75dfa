// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace dielast::materials {

/// How internal variables y go from accepted times to the next one, dt later:
///   y' = (a0 y - (h1 y_n + h2 y_{n-1})) / dt,
/// the backward Euler scheme or the two-step backward differentiation formula (BDF2) with variable steps
/// (Hairer & Wanner II, ch. III.5). dt = 0 freezes the dashpots (instantaneous response), dt = infinity lets
/// them flow until the branches carry nothing (relaxed response).
struct TimeScheme {
  double dt = 0; ///< s
  double a0 = 1, h1 = 1, h2 = 0;

  static TimeScheme frozen() { return {}; }
  static TimeScheme relaxed() { return {std::numeric_limits<double>::infinity()}; }
  static TimeScheme backward_euler(double dt) { return {dt}; }
  /// `dt_before`: the step between the last two accepted times, s; stable for dt < 2.41 dt_before.
  static TimeScheme bdf2(double dt, double dt_before) {
    const double w = dt / dt_before;
    return {dt, (1 + 2 * w) / (1 + w), 1 + w, -w * w / (1 + w)};
  }

  bool is_frozen() const { return dt == 0; }
  bool is_relaxed() const { return dt == std::numeric_limits<double>::infinity(); }
};

} // namespace dielast::materials
