// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/fits/fit_results.hpp"

#include <nlohmann/json.hpp>

namespace dielast::cases {

/// fit.json: ending, parameters with intervals (null where there is none), correlation, errors of the tests,
/// warnings. SI.
nlohmann::ordered_json fit_json(const FitResults& results);

/// fit.csv: one row per row of every test: its name, time (empty without), stretch, nominal stress as
/// measured and of the model.
std::string fit_table(const FitResults& results);

/// material.toml: the fitted material as a [film.material] table of a case, in SI; the fitted numbers with
/// six digits.
std::string material_toml(const FitResults& results);

} // namespace dielast::cases
