// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/branch.hpp"
#include "materials/laws/dielectric.hpp"
#include "materials/laws/elastic_law.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace dielast::materials {

/// What a film is made of: an equilibrium law, a dielectric, and Maxwell branches beside the law, composed
/// into one potential (see plane_stress.hpp and branch.hpp).
struct Material {
  ElasticLaw law;
  Dielectric dielectric;
  double density = 960; ///< kg/m^3
  std::vector<Branch> branches;
  double viscosity = 0;    ///< of a dashpot beside the law (Kelvin & Voigt), Pa s
  double fastest_rate = 0; ///< at which what is asked of that dashpot changes, 1/s
};

/// How much stiffer than what it is beside the spring is that stands before a viscosity.
constexpr double stiffness_before_viscosity = 1e4;

/// The dashpot beside the law as one more branch, with a spring that hardly gives: 1e4 times as stiff as the
/// stiffer of the law and of what the dashpot resists at the fastest rate r, mu and r eta. So in motions with
/// omega <= r the complex modulus mu + i omega eta is off by less than 1e-4 of itself, and loads that jump
/// move the film by 1e-4 of where they lead over 1/r, or in the end.
inline Material with_dashpot(Material material) {
  const double eta = std::exchange(material.viscosity, 0.0);
  if (eta > 0)
    material.branches.push_back(
        {.law = NeoHookean{stiffness_before_viscosity *
                           std::max(initial_shear_modulus(material.law), material.fastest_rate * eta)},
         .viscosity = eta});
  return material;
}

} // namespace dielast::materials
