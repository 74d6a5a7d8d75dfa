// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/material.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace dielast::cases {

/// One number of a material that a fit may change: a parameter of the law ("shear_modulus", "moduli[2]"), or
/// of a branch ("branch[1].shear_modulus", "branch[1].relaxation_time"); lists are counted from 1. A branch
/// keeps its relaxation time when its spring changes.
struct FitParameter {
  std::string name;
  std::string unit; ///< SI
  double above = 0; ///< the value is larger than this
  double below = std::numeric_limits<double>::infinity();
  std::function<double(const materials::Material&)> get;
  std::function<void(materials::Material&, double)> set;
};

/// All of them, in the order of the laws' tables.
std::vector<FitParameter> fit_parameters(const materials::Material& material);

} // namespace dielast::cases
