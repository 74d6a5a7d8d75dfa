// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/pack.hpp"
#include "materials/laws/parameter.hpp"

#include <array>

namespace dielast::materials {

/// St. Venant-Kirchhoff law: W = lambda/2 (tr E)^2 + mu tr(E^2), J/m^3, with Green's strain E = (C - 1)/2.
/// The only compressible law, for stiff layers that bend far but strain little: it softens under large
/// compression.
struct StVenantKirchhoff {
  double youngs_modulus = 0; ///< Y, Pa
  double poisson_ratio = 0;  ///< nu

  static constexpr std::string_view name = "st-venant-kirchhoff";
  static constexpr std::string_view formula = "W = lambda/2 (tr E)^2 + mu tr(E^2)";
  static constexpr std::string_view source = "Holzapfel 2000, Nonlinear Solid Mechanics, sec. 6.5";
  static constexpr std::array parameters{
      ParameterOf<StVenantKirchhoff>{{.name = "youngs_modulus", .unit = "Pa", .meaning = "Young's modulus"},
                                     &StVenantKirchhoff::youngs_modulus},
      ParameterOf<StVenantKirchhoff>{
          {.name = "poisson_ratio", .unit = "1", .meaning = "Poisson's ratio nu", .above = -1, .below = 0.5},
          &StVenantKirchhoff::poisson_ratio}};

  double initial_shear_modulus() const { return youngs_modulus / (2 * (1 + poisson_ratio)); }
  double first_lame() const {
    return youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio));
  }
  bool admits(double /*I1*/) const { return true; }

  /// In plane stress, c_i: principal values of the in-plane C; the strain E33 = -nu/(1 - nu) (E11 + E22).
  template<class T>
  T plane_stress_energy(const T& c1, const T& c2) const {
    const T E1 = 0.5 * (c1 - 1.0), E2 = 0.5 * (c2 - 1.0);
    const double nu = poisson_ratio;
    return youngs_modulus / (2 * (1 - nu * nu)) * (E1 * E1 + E2 * E2 + 2 * nu * E1 * E2);
  }
};

} // namespace dielast::materials
