// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/material.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace dielast::cases {

/// One number of a material that a fit may change: a parameter of the law ("shear_modulus", "moduli[2]"),
/// the viscosity beside it, or one of a branch ("branch[1].shear_modulus", "branch[1].relaxation_time");
/// lists are counted from 1.
struct FitParameter {
  std::string name;
  std::string unit; ///< SI
  double above = 0; ///< the value is larger than this
  double below = std::numeric_limits<double>::infinity();
  std::function<double(const materials::Material&)> get;
  std::function<void(materials::Material&, double)> set;
};

/// All of them, in the order of the laws' tables. When its spring changes, a branch keeps its relaxation
/// time, or its viscosity, which is then its parameter instead, where keeps_viscosity[its number] says so;
/// branches beyond the end of that list keep their relaxation time.
std::vector<FitParameter> fit_parameters(const materials::Material& material,
                                         const std::vector<bool>& keeps_viscosity = {});

} // namespace dielast::cases
