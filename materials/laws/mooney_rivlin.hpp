// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/pack.hpp"
#include "materials/laws/parameter.hpp"

#include <array>

namespace dielast::materials {

/// Incompressible Mooney-Rivlin law: W = c1 (I1 - 3) + c2 (I2 - 3), J/m^3 (Rivlin 1948).
struct MooneyRivlin {
  double c1 = 0, c2 = 0; ///< Pa

  static constexpr std::string_view name = "mooney-rivlin";
  static constexpr std::string_view formula = "W = c1 (I1 - 3) + c2 (I2 - 3)";
  static constexpr std::string_view source = "Rivlin 1948, Phil. Trans. R. Soc. A 241, 379";
  static constexpr std::array parameters{
      ParameterOf<MooneyRivlin>{{.name = "c1", .unit = "Pa", .meaning = "coefficient of I1 - 3"},
                                &MooneyRivlin::c1},
      ParameterOf<MooneyRivlin>{
          {.name = "c2", .unit = "Pa", .meaning = "coefficient of I2 - 3", .above = any_sign},
          &MooneyRivlin::c2}};

  double initial_shear_modulus() const { return 2 * (c1 + c2); }
  bool admits(double /*I1*/) const { return true; }

  template<class T>
  T energy(const T& I1, const T& I2) const {
    return c1 * (I1 - 3.0) + c2 * (I2 - 3.0);
  }
};

} // namespace dielast::materials
