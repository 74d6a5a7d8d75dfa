// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/fit_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

FitError error_of(const MeasuredTest& test, const std::vector<double>& model) {
  const double scale = test.largest_stress();
  FitError error;
  double squares = 0, products = 0, last = 0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const double one = (model[i] - test.stress[i]) / scale;
    error.largest = std::isnan(one) ? one : std::max(error.largest, std::abs(one));
    squares += one * one;
    products += one * last;
    last = one;
  }
  error.rms = std::sqrt(squares / static_cast<double>(model.size()));
  error.likeness = squares > 0 ? products / squares : 0;
  return error;
}

/// Which bound a parameter is at, and what that tells. `range`: of the fit.
std::string bound_of(const FittedParameter& one, double range) {
  constexpr double near = 1e-6, wide = 100;
  const double ratio = std::abs(one.value / one.start), factor = std::max(ratio, 1 / ratio);
  if (!(factor > (1 - near) * range)) return "its bound: the tests do not tell it";
  return fmt::format("the bound that fit.range sets, {:.6g} times its start value: {}", one.value / one.start,
                     range < wide ? "the tests may want it farther away"
                                  : "the tests do not tell it, or start values are far off");
}

} // namespace

FitResults::FitResults(const Fit& of, FitTask fitted, FitOutcome found)
    : fit(of), task(std::move(fitted)), outcome(std::move(found)) {
  for (std::size_t t = 0; t < task.tests.size(); ++t)
    errors.push_back(error_of(task.tests[t], outcome.stress[t]));
}

std::string FitResults::ending() const {
  const std::string after =
      fmt::format("after {} iterations{}", outcome.iterations,
                  outcome.iterations > fit.max_iterations ? " in several attempts" : "");
  switch (outcome.ending) {
  case FitEnding::converged:
    return "converged " + after;
  case FitEnding::gave_up:
    return "not converged " + after + ": the best parameters so far";
  case FitEnding::interrupted:
    break;
  }
  return "interrupted " + after + ": the best parameters so far";
}

std::vector<std::string> FitResults::warnings() const {
  constexpr double systematic = 0.5;
  constexpr double rounding = 1e-6, time_steps = 1e-4; // errors that are none of the model's
  std::vector<std::string> all;
  for (std::size_t i = 0; i < outcome.parameters.size(); ++i) {
    const FittedParameter& one = outcome.parameters[i];
    const std::string& name = task.parameters[i].name;
    if (one.ends_model)
      all.push_back(fmt::format("{} is at its bound: beyond it the material has no stable state at a stretch "
                                "that was measured, and what fits better may lie there",
                                name));
    else if (one.at_bound)
      all.push_back(name + " is at " + bound_of(one, fit.range));
    else if (!one.determined())
      all.push_back(
          fmt::format("{} is not identifiable: the fitted tests do not depend on it, or only on its "
                      "combination with others",
                      name));
    for (std::size_t j = 0; j < i; ++j)
      if (const double r = outcome.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
          std::abs(r) > dependent)
        all.push_back(fmt::format("{} and {} can hardly be told apart: correlation {:.3f}",
                                  task.parameters[j].name, name, r));
  }
  for (std::size_t t = 0; t < errors.size(); ++t) {
    const std::string name = fit.tests[t].name();
    const bool in_time = !fit.tests[t].measured.history.time.empty() && !fit.film.material.branches.empty();
    if (!fit.tests[t].doubt.empty()) all.push_back(name + ": " + fit.tests[t].doubt);
    if (std::isnan(errors[t].rms))
      all.push_back(fmt::format("{}: the law does not reach all of its stretches", name));
    else if (!fit.tests[t].predict && errors[t].likeness > systematic &&
             errors[t].rms > (in_time ? time_steps : rounding))
      all.push_back(
          fmt::format("{}: errors of neighbouring rows are alike (correlation {:.2f}): the misfit is the "
                      "model's, and the intervals are too narrow",
                      name, errors[t].likeness));
  }
  return all;
}

} // namespace dielast::cases
