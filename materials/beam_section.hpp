// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/parameter.hpp"

#include <array>

namespace dielast::materials {

/// Isotropic linear elastic solid, for frames and printed walls.
struct ElasticSolid {
  double youngs_modulus = 0;  ///< E, Pa
  double poisson_ratio = 0;   ///< nu
  double yield_strain = 0.55; ///< TPU: 55 %
  double density = 1200;      ///< kg/m^3; of thermoplastic polyurethanes

  static constexpr std::array parameters{
      ParameterOf<ElasticSolid>{{.name = "youngs_modulus", .unit = "Pa", .meaning = "Young's modulus E"},
                                &ElasticSolid::youngs_modulus},
      ParameterOf<ElasticSolid>{{.name = "poisson_ratio",
                                 .unit = "1",
                                 .meaning = "Poisson's ratio nu",
                                 .above = -1,
                                 .below = 0.5000001},
                                &ElasticSolid::poisson_ratio},
      ParameterOf<ElasticSolid>{
          {.name = "yield_strain", .unit = "1", .meaning = "strain at yield", .fallback = 0.55},
          &ElasticSolid::yield_strain},
      ParameterOf<ElasticSolid>{
          {.name = "density", .unit = "kg/m^3", .meaning = "mass per volume", .fallback = 1200},
          &ElasticSolid::density},
  };
};

/// Stiffnesses of a beam's cross-section. Axis 1 is the beam's tangent, 2 lies across it in the film's plane,
/// 3 is normal to the film.
struct BeamSection {
  double EA = 0;           ///< axial, N
  double GA2 = 0, GA3 = 0; ///< shear along 2 and 3, N
  double GJ = 0;           ///< torsion, N m^2
  double EI2 = 0, EI3 = 0; ///< bending about axis 2 (out of the plane) and about axis 3 (in the plane), N m^2
  double half_width = 0;   ///< distance of the outermost fibre along 2, m
  double half_height = 0;  ///< distance of the outermost fibre along 3, m
  double yield_strain = 0;
  double line_density = 0; ///< mass per length, kg/m
  double rotary2 = 0,
         rotary3 = 0; ///< moments of inertia per length about axes 2 and 3, kg m; about 1: the sum
};

/// Rectangular section, `width` along axis 2 and `height` along axis 3 (m): shear factor 5/6, Saint-Venant
/// torsion constant from its series (Timoshenko & Goodier, Theory of Elasticity, art. 109).
BeamSection rectangular_section(const ElasticSolid& solid, double width, double height);

/// Two bars of half the height, on either face of a layer of the thickness `gap` (m) that keeps their
/// sections in one plane and has no stiffness of its own. They bend as one; each twists about its own axis.
BeamSection two_faced_section(const ElasticSolid& solid, double width, double height, double gap);

} // namespace dielast::materials
