// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/arruda_boyce.hpp"
#include "materials/laws/gent.hpp"
#include "materials/laws/mooney_rivlin.hpp"
#include "materials/laws/neo_hookean.hpp"
#include "materials/laws/ogden.hpp"
#include "materials/laws/st_venant_kirchhoff.hpp"
#include "materials/laws/yeoh.hpp"

#include <variant>

namespace dielast::materials {

/// The registry of laws: a new law is one more alternative.
using ElasticLaw = std::variant<NeoHookean, MooneyRivlin, Yeoh, Ogden, Gent, ArrudaBoyce, StVenantKirchhoff>;

/// Pa, at small strain.
inline double initial_shear_modulus(const ElasticLaw& law) {
  return std::visit([](const auto& one) { return one.initial_shear_modulus(); }, law);
}

/// False where I1 is beyond what the law can be stretched to.
inline bool admits(const ElasticLaw& law, double I1) {
  return std::visit([I1](const auto& one) { return one.admits(I1); }, law);
}

} // namespace dielast::materials
