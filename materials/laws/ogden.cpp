// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/ogden.hpp"

namespace dielast::materials {

std::optional<std::string> Ogden::problem() const {
  if (moduli.empty()) return "an ogden law needs at least one modulus and exponent";
  if (moduli.size() != exponents.size())
    return "an ogden law needs one exponent for each modulus: there are " + std::to_string(moduli.size()) +
           " moduli and " + std::to_string(exponents.size()) + " exponents";
  for (const double exponent : exponents)
    if (exponent == 0) return "an exponent of an ogden law is 0";
  if (!(initial_shear_modulus() > 0))
    return "the sum of modulus times exponent of an ogden law, twice its shear modulus, must be positive";
  return std::nullopt;
}

} // namespace dielast::materials
