// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/fit_spec.hpp"
#include "cases/console/exit_code.hpp"

namespace dielast::cases {

struct FitSettings {
  std::filesystem::path directory; ///< made when it does not exist
  bool resume = false;             ///< nothing is done where the directory holds the fit's complete results
};

/// Fits a material and writes fit.json, fit.csv, material.toml and report.html. A fit that does not converge
/// or is interrupted leaves the best parameters that it has found; resumed, it starts over, and ends in the
/// bytes of one that was not stopped. Throws FileError, on `resume` of another fit, too, and
/// post::WriteError.
ExitCode run_fit(const Fit& fit, const FitSettings& settings);

} // namespace dielast::cases
