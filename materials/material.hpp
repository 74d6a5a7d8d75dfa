// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/branch.hpp"
#include "materials/laws/dielectric.hpp"
#include "materials/laws/elastic_law.hpp"

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
  double viscosity = 0; ///< of a dashpot beside the law (Kelvin & Voigt), Pa s
};

/// The dashpot beside the law as one more branch, with a spring that hardly gives: 1e4 times as stiff as the
/// law, so that in motions with omega the complex modulus mu + i omega eta is off by less than 1e-4 omega
/// eta/mu of itself, and loads that jump move the film by 1e-4 of where they lead at once.
inline Material with_dashpot(Material material) {
  constexpr double stiffer = 1e4;
  if (material.viscosity > 0)
    material.branches.push_back({.law = NeoHookean{stiffer * initial_shear_modulus(material.law)},
                                 .viscosity = std::exchange(material.viscosity, 0.0)});
  return material;
}

} // namespace dielast::materials
