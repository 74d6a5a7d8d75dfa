// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/linear/linearisation.hpp"

#include <span>

namespace dielast::fem {

/// Amplitudes of what is given.
struct HarmonicDrive {
  Eigen::VectorXd source; ///< per port, what its supply says: V of the circuit's source or of the electrode,
                          ///< C where the charge is given; Pa, m^3 of chambers
  Eigen::VectorXd force;  ///< per free equation, N

  /// Unit amplitude at one port, 1 N along one free equation.
  static HarmonicDrive at_port(const Model& model, std::size_t port);
  static HarmonicDrive along(const Model& model, int equation);
};

/// Complex amplitudes of everything, which moves as Re(amplitude exp(i omega t)) about the equilibrium.
struct HarmonicResponse {
  double frequency = 0;          ///< omega, rad/s
  Eigen::VectorXcd displacement; ///< per free equation, m (rad)
  Eigen::VectorXcd voltage;      ///< per port, V
  Eigen::VectorXcd charge;       ///< per port, C
  Eigen::VectorXcd current; ///< per port, A, drawn from the source: i omega dQ + G dPhi. At a port driven
                            ///< by 1 V it is the admittance, its inverse the impedance.
};

/// Steady response to a small harmonic drive at each of the frequencies (rad/s, 0 too), branches and circuits
/// taken along: Z(i omega) u = B is solved (see ResponseBasis), the ports are eliminated. Throws
/// std::domain_error at an undamped resonance.
std::vector<HarmonicResponse> harmonic_response(const Linearisation& at, const HarmonicDrive& drive,
                                                std::span<const double> frequencies);

} // namespace dielast::fem
