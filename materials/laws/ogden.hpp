// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/pack.hpp"
#include "materials/laws/parameter.hpp"

#include <array>
#include <optional>
#include <string>

namespace dielast::materials {

/// Incompressible Ogden law: W = sum_p mu_p/alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3), J/m^3, with
/// the principal stretches l_i (Ogden 1972).
struct Ogden {
  std::vector<double> moduli;    ///< mu_p, Pa
  std::vector<double> exponents; ///< alpha_p, not 0; one for each modulus

  static constexpr std::string_view name = "ogden";
  static constexpr std::string_view formula =
      "W = sum mu_p/alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3)";
  static constexpr std::string_view source = "Ogden 1972, Proc. R. Soc. A 326, 565";
  static constexpr std::array parameters{
      ParameterOf<Ogden>{{.name = "moduli",
                          .unit = "Pa",
                          .meaning = "coefficients mu_p, one for each exponent",
                          .above = any_sign},
                         nullptr,
                         &Ogden::moduli},
      ParameterOf<Ogden>{
          {.name = "exponents", .unit = "1", .meaning = "exponents alpha_p, not 0", .above = any_sign},
          nullptr,
          &Ogden::exponents}};

  double initial_shear_modulus() const {
    double sum = 0;
    for (std::size_t p = 0; p < moduli.size(); ++p) sum += moduli[p] * exponents[p];
    return sum / 2;
  }
  bool admits(double /*I1*/) const { return true; }

  /// What is wrong with the lists, in words for the user; none: nothing.
  std::optional<std::string> problem() const;

  /// c_i: principal values of C.
  template<class T>
  T energy(const T& c1, const T& c2, const T& c3) const {
    T sum{};
    for (std::size_t p = 0; p < moduli.size(); ++p) {
      const double half = exponents[p] / 2;
      sum += moduli[p] / exponents[p] * (pow(c1, half) + pow(c2, half) + pow(c3, half) - 3.0);
    }
    return sum;
  }
};

} // namespace dielast::materials
