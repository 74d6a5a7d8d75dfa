#pragma once

#include "materials/parameter.hpp"

#include <array>

namespace dielast::materials {

/// First and second derivatives of an energy density in the invariants I1, I2.
template<class T>
struct InvariantDerivatives {
  T W1, W2, W11, W12, W22;
};

/// Incompressible neo-Hookean law: W = mu/2 (I1 - 3), J/m^3 (Treloar 1943).
struct NeoHookean {
  static constexpr std::string_view name = "neo-hookean";
  static constexpr std::string_view formula = "W = mu/2 (I1 - 3)";
  static constexpr std::array parameters{
      Parameter{.name = "shear_modulus", .unit = "Pa", .meaning = "shear modulus mu at small strain"}};

  double shear_modulus = 0; ///< mu, Pa

  template<class T>
  T energy(const T& I1, const T& /*I2*/) const {
    return 0.5 * shear_modulus * (I1 - 3.0);
  }
  /// W is linear in I1: the compiler removes every product with the zeros.
  static constexpr bool linear_in_first_invariant = true;
  template<class T>
  InvariantDerivatives<T> derivatives(const T& /*I1*/, const T& /*I2*/) const {
    return {T{} + 0.5 * shear_modulus, T{}, T{}, T{}, T{}};
  }
};

} // namespace dielast::materials
