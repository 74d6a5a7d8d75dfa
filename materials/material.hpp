// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/branch.hpp"
#include "materials/laws/dielectric.hpp"
#include "materials/laws/elastic_law.hpp"

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

/// How many times as stiff as the law at small strain the spring of a dashpot beside it is, see
/// with_dashpot(): film's stress and energy are rounded to a ten-billionth of the law's modulus, those of
/// solids to more, so that their spring is softer.
constexpr double spring_of_films_dashpot = 1e6, spring_of_solids_dashpot = 1e4;

/// The dashpot beside the law as one more branch, with a spring that hardly gives, `stiffer` times as stiff
/// as the law: in motions with omega the complex modulus mu + i omega eta is off by less than omega eta/(mu
/// stiffer) of itself, and loads that jump move the film by 1/stiffer of where they lead at once (mu: at
/// small strain).
Material with_dashpot(Material material, double stiffer = spring_of_films_dashpot);

} // namespace dielast::materials
