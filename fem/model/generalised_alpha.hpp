// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace dielast::fem {

/// Generalised-alpha method (Chung & Hulbert 1993) for M a + C v + r(u) = 0, r = internal minus external
/// forces:
///   M a_{1-alpha_m} + C v_{1-alpha_f} + (1 - alpha_f) r_1 + alpha_f r_0 = 0,  x_{1-alpha} = (1-alpha) x_1 +
///   alpha x_0,  a_1 = (u_1 - u_0 - dt v_0) / (beta dt^2) - start a_0,  v_1 = v_0 + dt ((1-gamma) a_0 + gamma
///   a_1),
/// start = 1/(2 beta) - 1. Forces are interpolated, not states, so that dashpots and circuits keep their own
/// scheme, at the end of the step. dt = 0: no inertia.
struct GeneralisedAlpha {
  double dt = 0; ///< s
  double alpha_m = 0, alpha_f = 0, beta = 0, gamma = 0, start = 0;

  /// Second order; `rho`: what is left of the highest frequencies after a step, 0..1.
  static GeneralisedAlpha of(double dt, double rho) {
    const double alpha_m = (2 * rho - 1) / (rho + 1), alpha_f = rho / (rho + 1);
    const double beta = (1 - alpha_m + alpha_f) * (1 - alpha_m + alpha_f) / 4;
    return {dt, alpha_m, alpha_f, beta, 0.5 - alpha_m + alpha_f, 1 / (2 * beta) - 1};
  }
  /// First order; needs no acceleration to start from.
  static GeneralisedAlpha backward_euler(double dt) { return {dt, 0, 0, 1, 1, 0}; }

  bool is_static() const { return dt == 0; }
  double mass_factor() const { return (1 - alpha_m) / ((1 - alpha_f) * beta * dt * dt); }
  double damping_factor() const { return gamma / (beta * dt); }
  /// Local error of displacements over the change of acceleration (Zienkiewicz & Xie 1991), s^2.
  double error_factor() const { return dt * dt * (beta > 1.0 / 6 ? beta - 1.0 / 6 : 1.0 / 6 - beta); }
};

} // namespace dielast::fem
