// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"

#include <optional>
#include <vector>

namespace dielast::fem {

struct ModalOptions {
  int count = 6;       ///< of modes wanted; there are as many as unknowns with a mass
  bool drifts = false; ///< nothing holds the model: rigid motions are left out, see rigid_motions()
};

/// Small free vibration u = shape cos(omega t) about an equilibrium: K shape = omega^2 M shape, with K the
/// tangent under the control of the state; shape . M shape = 1.
struct VibrationMode {
  double stiffness = 0; ///< omega^2, 1/s^2; negative: the state is unstable, the mode grows by exp(|omega| t)
  Eigen::VectorXd shape; ///< per free equation, 1/sqrt(kg)

  /// omega, rad/s; 0 where the mode does not vibrate.
  double frequency() const;
};

/// The modes of the least omega^2, ascending, about an equilibrium under any load: prestretched,
/// charged, with its dead forces. Electrodes whose charge is given (chambers whose volume is) keep it, so
/// that K is bordered (see BorderedTangent); all others, those on circuits too, keep their voltage. Unknowns
/// without mass follow statically, and dashpots let go (slow vibration). Motion without stiffness is allowed
/// where it has mass. Nothing where K is singular otherwise or the iteration does not converge. Shapes are
/// oriented (see orient(); rotations count times the model's length scale).
///
/// Rayleigh and Ritz in the span of a few vectors X and T X, T^2 X, T^3 X with T = K^-1 M, restarted from the
/// lowest Ritz vectors until they converge (block Krylov; subspace iteration of Bathe, Finite Element
/// Procedures, ch. 11.6, that forgets less). In the inner product of M and the range of T, where a singular M
/// does no harm. A block of vectors rather than Lanczos's single one: discs and squares have their
/// frequencies in pairs, of which one vector sees a twin only by round-off.
std::optional<std::vector<VibrationMode>> vibration_modes(Equilibrium& equilibrium, const State& state,
                                                          const ModalOptions& options);

/// Shift with which the mass holds what nothing else does, over the squared frequency of single unknowns.
constexpr double least_shift = 1e-9;

/// A scheme that adds shift M to the tangent, shift in 1/s^2, and nothing of the dampers.
GeneralisedAlpha mass_times(double shift);

} // namespace dielast::fem
