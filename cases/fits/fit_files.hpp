// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/fits/fit_results.hpp"
#include "post/pictures/report.hpp"

#include <nlohmann/json_fwd.hpp>

namespace dielast::cases {

// What fits of materials, of devices and of functions share.

inline constexpr double poor_fit = 0.2; ///< rms error, relative, from which on a fit is warned of

/// Null where it is no number.
nlohmann::ordered_json finite_json(double value);
const char* word(FitEnding ending);
/// Adds value, interval, start and whether it is at a bound.
void append_value(nlohmann::ordered_json& named, const FittedParameter& one);
nlohmann::ordered_json correlation_json(const Eigen::MatrixXd& correlation);
/// Adds their section, where there are any.
void add_warnings(post::Report& report, const std::vector<std::string>& warnings);

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
