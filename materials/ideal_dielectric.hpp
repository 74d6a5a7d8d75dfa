#pragma once

#include "materials/parameter.hpp"

#include <array>

namespace dielast::materials {

/// Ideal dielectric elastomer: the permittivity does not depend on the deformation (Zhao & Suo 2007), so that
/// D = eps E and, for a film of undeformed thickness H under the voltage Phi, the potential per undeformed
/// volume is -eps/2 (Phi/H)^2 det C (C: in-plane right Cauchy-Green tensor).
struct IdealDielectric {
  static constexpr std::array parameters{
      Parameter{.name = "permittivity", .unit = "F/m", .meaning = "permittivity eps"},
      Parameter{.name = "breakdown_field",
                .unit = "V/m",
                .meaning = "true electric field at breakdown",
                .fallback = 100e6}};

  double permittivity = 0;        ///< eps, F/m
  double breakdown_field = 100e6; ///< V/m
};

} // namespace dielast::materials
