// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/invariant_law.hpp"

namespace dielast::materials {

/// Incompressible Yeoh law: W = c1 x + c2 x^2 + c3 x^3 with x = I1 - 3, J/m^3 (Yeoh 1993).
struct Yeoh {
  double c1 = 0, c2 = 0, c3 = 0; ///< Pa

  static constexpr std::string_view name = "yeoh";
  static constexpr std::string_view formula = "W = c1 (I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3";
  static constexpr std::string_view source = "Yeoh 1993, Rubber Chem. Technol. 66, 754";
  static constexpr std::array parameters{
      ParameterOf<Yeoh>{{.name = "c1", .unit = "Pa", .meaning = "half of the shear modulus at small strain"},
                        &Yeoh::c1},
      ParameterOf<Yeoh>{{.name = "c2",
                         .unit = "Pa",
                         .meaning = "coefficient of (I1 - 3)^2",
                         .above = any_sign,
                         .fallback = 0},
                        &Yeoh::c2},
      ParameterOf<Yeoh>{{.name = "c3",
                         .unit = "Pa",
                         .meaning = "coefficient of (I1 - 3)^3",
                         .above = any_sign,
                         .fallback = 0},
                        &Yeoh::c3}};

  double initial_shear_modulus() const { return 2 * c1; }
  bool admits(double /*I1*/) const { return true; }

  template<class T>
  T energy(const T& I1) const {
    const T x = I1 - 3.0;
    return x * (c1 + x * (c2 + x * c3));
  }
  template<class T>
  InvariantDerivatives<T> derivatives(const T& I1) const {
    const T x = I1 - 3.0;
    return {energy(I1), c1 + x * (2 * c2 + x * (3 * c3)), 2 * c2 + x * (6 * c3)};
  }
};

} // namespace dielast::materials
