// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/identify_spec.hpp"
#include "cases/fits/fit.hpp"
#include "cases/fitting/fit_solver.hpp"
#include "post/pictures/report.hpp"

namespace dielast::cases {

struct IdentifyOutcome {
  FitEnding ending{};
  int iterations = 0;
  std::vector<FittedParameter> unknowns; ///< in their own units
  Eigen::MatrixXd correlation;
  double deviation = 0;                                 ///< s of the weighted residuals
  std::vector<std::vector<std::complex<double>>> model; ///< for each test, as measured
  std::vector<double> errors;                           ///< rms for each test, relative
};

/// Nonlinear least squares over all numbers of the tests that are not kept out:
///   r = weight (model - measured)/scale,
/// scale the largest measured value of a quantity, of a response the magnitude of each row; by
/// Levenberg-Marquardt (Ceres) in q = ln(value/start), derivatives by central differences over whole runs, at
/// most `threads` at once (0: one per core). Intervals and correlations: see fit_statistics.hpp, those of q
/// carried over to the values. Throws CaseError where the start has no model, or an unknown changes no
/// measured number.
IdentifyOutcome solve_identification(const Identification& asked, int threads,
                                     const std::function<bool(int iteration, double misfit)>& on_iteration);

/// Writes identify.json, identify.csv, identified.toml (the case with what was found) and report.html. What
/// does not converge, or is interrupted, leaves the best that was found. Throws FileError and
/// post::WriteError.
ExitCode run_identification(const Identification& asked, const std::filesystem::path& directory, int threads);

/// The files of run_identification.
std::string identify_json(const Identification& asked, const IdentifyOutcome& outcome);
std::string identify_table(const Identification& asked, const IdentifyOutcome& outcome);
post::Report identify_report(const Identification& asked, const IdentifyOutcome& outcome);
std::string identify_summary(const Identification& asked, const IdentifyOutcome& outcome);
std::vector<std::string> identify_warnings(const Identification& asked, const IdentifyOutcome& outcome);

} // namespace dielast::cases
