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
};

} // namespace dielast::materials
