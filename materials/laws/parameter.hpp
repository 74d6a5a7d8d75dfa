// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <optional>
#include <string_view>
#include <vector>

namespace dielast::materials {

/// One number a user may give: the single place where its name, unit, range, default and meaning stand.
/// Validation, `dielast info`, the JSON schema and the documentation are made from it.
struct Parameter {
  std::string_view name;
  std::string_view unit; ///< SI, as udunits spells it; "1" for a pure number
  std::string_view meaning;
  double above = 0;                                       ///< the value must be larger than this
  double below = std::numeric_limits<double>::infinity(); ///< and smaller than this
  std::optional<double> fallback{};                       ///< default in SI; none: the user must give it
};

/// A parameter and the member of S that holds it: one number, or a list of them (the other is null).
template<class S>
struct ParameterOf : Parameter {
  double S::*number = nullptr;
  std::vector<double> S::*list = nullptr;
};

/// `above` of a parameter that may be negative.
constexpr double any_sign = -std::numeric_limits<double>::infinity();

} // namespace dielast::materials
