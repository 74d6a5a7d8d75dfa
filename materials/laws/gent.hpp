// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/invariant_law.hpp"

namespace dielast::materials {

/// Incompressible Gent law: W = -mu J/2 ln(1 - (I1 - 3)/J), J/m^3; it stiffens without limit as I1 - 3 nears
/// J (Gent 1996). Beyond, the energy is not a number.
struct Gent {
  double shear_modulus = 0; ///< mu, Pa
  double stretch_limit = 0; ///< J

  static constexpr std::string_view name = "gent";
  static constexpr std::string_view formula = "W = -mu J/2 ln(1 - (I1 - 3)/J)";
  static constexpr std::string_view source = "Gent 1996, Rubber Chem. Technol. 69, 59";
  static constexpr std::array parameters{
      ParameterOf<Gent>{
          {.name = "shear_modulus", .unit = "Pa", .meaning = "shear modulus mu at small strain"},
          &Gent::shear_modulus},
      ParameterOf<Gent>{{.name = "stretch_limit", .unit = "1", .meaning = "limit J of I1 - 3"},
                        &Gent::stretch_limit}};

  double initial_shear_modulus() const { return shear_modulus; }
  bool admits(double I1) const { return I1 - 3 < stretch_limit; }

  template<class T>
  T energy(const T& I1) const {
    return -0.5 * shear_modulus * stretch_limit * log(1.0 - (I1 - 3.0) / stretch_limit);
  }
  template<class T>
  InvariantDerivatives<T> derivatives(const T& I1) const {
    const T W1 = 0.5 * shear_modulus / (1.0 - (I1 - 3.0) / stretch_limit);
    return {energy(I1), W1, W1 * W1 * (2 / (shear_modulus * stretch_limit))};
  }
};

} // namespace dielast::materials
