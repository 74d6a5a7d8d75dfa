// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/fit_spec.hpp"

namespace dielast::cases {

/// Numbers of a fit of which this is the correlation can hardly be told apart.
inline constexpr double dependent = 0.95;

/// How far the model is from a test.
struct FitError {
  double rms = 0, largest = 0; ///< relative to the largest measured stress; NaN where the model has no stress
  double likeness = 0; ///< correlation of the errors of neighbouring rows; near 1 the misfit is systematic
};

/// What a fit file asked for and what came out.
struct FitResults {
  const Fit& fit;
  FitTask task;
  FitOutcome outcome;
  std::vector<FitError> errors; ///< one for each test

  FitResults(const Fit& of, FitTask fitted, FitOutcome found);

  /// In words: how the fit ended.
  std::string ending() const;
  /// Parameters at a bound, not determined or nearly dependent; systematic misfit; tests beyond the law.
  std::vector<std::string> warnings() const;
};

} // namespace dielast::cases
