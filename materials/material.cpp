// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/material.hpp"

#include <utility>

namespace dielast::materials {

Material with_dashpot(Material material, double stiffer) {
  if (material.viscosity > 0)
    material.branches.push_back({.law = NeoHookean{stiffer * initial_shear_modulus(material.law)},
                                 .viscosity = std::exchange(material.viscosity, 0.0)});
  return material;
}

} // namespace dielast::materials
