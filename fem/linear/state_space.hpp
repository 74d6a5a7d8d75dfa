// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/linear/linearisation.hpp"

#include <limits>
#include <span>
#include <vector>

namespace dielast::fem {

/// Linear model x' = A x + B u, y = C x + D u. Units of u and y are those of its Channels.
struct StateSpace {
  Eigen::MatrixXd A, B, C, D;

  Eigen::Index order() const { return A.rows(); }
  /// C (s - A)^-1 B + D: y per u, of motions exp(s t).
  Eigen::MatrixXcd transfer(std::complex<double> s) const;
};

/// From where to where a linear model leads.
struct Channels {
  std::vector<std::size_t> inputs;  ///< ports; u is what their supply says is given: V of the circuit's
                                    ///< source or of the electrode, C, Pa or m^3
  Eigen::MatrixXd rows;             ///< outputs: y = row . du over the free equations, m
  std::vector<std::size_t> charges; ///< further outputs, behind them: the charges of these ports, C

  Eigen::Index output_count() const { return rows.rows() + static_cast<Eigen::Index>(charges.size()); }
};

struct ModalBasis {
  int modes = 12; ///< at most so many vibration modes are taken
  double highest_frequency =
      std::numeric_limits<double>::infinity(); ///< rad/s; faster ones follow statically
  bool drifts = false; ///< see ModalOptions; forces and voltages then move no mass centre
};

/// The linearisation about a relaxed equilibrium, projected: du = sum of vibration modes (mass-normalised, at
/// fixed voltages) + static responses to the ports with relaxed and with instantaneous stiffness, which have
/// no inertia (Craig & Bampton's correction, MacNeal 1971). Its states: amplitudes and velocities of the
/// modes, per rate of relaxation what the branches remember of every amplitude, and the charge of every
/// circuit; each in units of the root of an energy. Throws std::domain_error where the linearisation does,
/// where rates vary with the place (nominal dashpots: there are as many states as integration points), and
/// where the modes are not found.
StateSpace state_space(Equilibrium& equilibrium, const State& state, const Channels& channels,
                       const ModalBasis& basis);

/// Largest |y_model - y|/|y| over inputs, outputs and frequencies (rad/s), y from harmonic_response().
double largest_error(const StateSpace& model, const Linearisation& full, const Channels& channels,
                     std::span<const double> frequencies);

} // namespace dielast::fem
