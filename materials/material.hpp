#pragma once

#include "materials/ideal_dielectric.hpp"
#include "materials/neo_hookean.hpp"

#include <variant>

namespace dielast::materials {

/// The registry of equilibrium laws: a new law is one more alternative.
using ElasticLaw = std::variant<NeoHookean>;

/// What a film is made of: an equilibrium law and a dielectric, composed into one potential (see
/// plane_stress.hpp).
struct Material {
  ElasticLaw law;
  IdealDielectric dielectric;
  double density = 960; ///< kg/m^3
};

} // namespace dielast::materials
