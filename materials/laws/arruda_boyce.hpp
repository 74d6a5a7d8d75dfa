// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/invariant_law.hpp"

namespace dielast::materials {

/// Incompressible eight-chain law (Arruda & Boyce 1993) with the inverse Langevin function
/// z (3 - z^2)/(1 - z^2) (Cohen 1991), where z^2 = I1/(3 lambda_L^2) and z0^2 = 1/lambda_L^2:
///   W = G/6 [I1 - 3 - 6 lambda_L^2 ln((1 - z^2)/(1 - z0^2))], J/m^3;  2 dW/dI1 = G (3 - z^2)/(3 (1 - z^2)).
/// Beyond the locking stretch the energy is not a number.
struct ArrudaBoyce {
  double shear_modulus = 0;   ///< G, Pa
  double locking_stretch = 0; ///< lambda_L, of a chain

  static constexpr std::string_view name = "arruda-boyce";
  static constexpr std::string_view formula =
      "W = G/6 [I1 - 3 - 6 L^2 ln((1 - z^2)/(1 - 1/L^2))], z^2 = I1/(3 L^2)";
  static constexpr std::string_view source =
      "Arruda & Boyce 1993, J. Mech. Phys. Solids 41, 389; Cohen 1991, Rheol. Acta 30, 270";
  static constexpr std::array parameters{
      ParameterOf<ArrudaBoyce>{{.name = "shear_modulus",
                                .unit = "Pa",
                                .meaning = "modulus G of the network, the shear modulus of long chains"},
                               &ArrudaBoyce::shear_modulus},
      ParameterOf<ArrudaBoyce>{{.name = "locking_stretch",
                                .unit = "1",
                                .meaning = "stretch L at which the chains are straight",
                                .above = 1},
                               &ArrudaBoyce::locking_stretch}};

  double initial_shear_modulus() const { return 2 * derivatives(3.0).W1; }
  bool admits(double I1) const { return I1 < 3 * locking_stretch * locking_stretch; }

  template<class T>
  T energy(const T& I1) const {
    const double limit = locking_stretch * locking_stretch;
    return shear_modulus / 6 * (I1 - 3.0 - 6 * limit * log1p(-(I1 - 3.0) / (3 * limit - 3)));
  }
  template<class T>
  InvariantDerivatives<T> derivatives(const T& I1) const {
    const double limit = locking_stretch * locking_stretch;
    const T slack = 1.0 / (1.0 - I1 / (3 * limit)); // 1/(1 - z^2)
    return {energy(I1), shear_modulus / 6 * (1.0 + 2.0 * slack), shear_modulus / (9 * limit) * slack * slack};
  }
};

} // namespace dielast::materials
