// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/invariant_law.hpp"

namespace dielast::materials {

/// Incompressible neo-Hookean law: W = mu/2 (I1 - 3), J/m^3 (Treloar 1943).
struct NeoHookean {
  double shear_modulus = 0; ///< mu, Pa

  static constexpr std::string_view name = "neo-hookean";
  static constexpr std::string_view formula = "W = mu/2 (I1 - 3)";
  static constexpr std::string_view source = "Treloar 1943, Trans. Faraday Soc. 39, 241";
  static constexpr std::array parameters{ParameterOf<NeoHookean>{
      {.name = "shear_modulus", .unit = "Pa", .meaning = "shear modulus mu at small strain"},
      &NeoHookean::shear_modulus}};

  double initial_shear_modulus() const { return shear_modulus; }
  bool admits(double /*I1*/) const { return true; }

  template<class T>
  T energy(const T& I1) const {
    return 0.5 * shear_modulus * (I1 - 3.0);
  }
  template<class T>
  InvariantDerivatives<T> derivatives(const T& I1) const {
    return {energy(I1), T{} + 0.5 * shear_modulus, T{}};
  }
};

template<>
inline constexpr bool linear_in_first_invariant<NeoHookean> = true;

} // namespace dielast::materials
