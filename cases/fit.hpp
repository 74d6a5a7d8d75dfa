#pragma once

#include "cases/exit_code.hpp"
#include "cases/fit_spec.hpp"

namespace dielast::cases {

/// Fits a material and writes fit.json, fit.csv, material.toml and report.html into the directory, which is
/// made when it does not exist. A fit that does not converge or is interrupted leaves the best parameters
/// that it has found. Throws FileError and post::WriteError.
ExitCode run_fit(const Fit& fit, const std::filesystem::path& directory);

} // namespace dielast::cases
