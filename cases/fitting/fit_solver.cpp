// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/fit_solver.hpp"

#include "cases/fitting/fit_starts.hpp"
#include "cases/fitting/fit_statistics.hpp"

#include <limits>

namespace dielast::cases {
namespace {

constexpr double time_tolerance = 1e-6; // of the largest stress

/// Where the solver has come to.
struct Attempt {
  Eigen::VectorXd q;
  double cost = 0;
  FitEnding ending{};
};

Attempt attempt_from(Eigen::VectorXd q, const FitTask& task, const std::vector<Coordinate>& coordinates,
                     const std::vector<int>& steps, int& iterations) {
  const Misfit misfit(task, coordinates, steps);
  LeastSquares problem{
      .rows = misfit.rows(),
      .residuals = [&](const auto& at) { return misfit.residuals(at); },
      .jacobian = [&](const auto& at, const auto& r) { return misfit.differences(at, r).slope; },
      .lower = Eigen::VectorXd(q.size()),
      .upper = Eigen::VectorXd(q.size()),
      .max_iterations = task.max_iterations,
      .first_radius = 10, // a full first step may leave the neighbourhood of the start
      .function_tolerance = 1e-10,
      .parameter_tolerance = 1e-10,
      .gradient_tolerance = 1e-14,
      .crawl_tolerance = 1e-5};
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    problem.lower[i] = coordinates[static_cast<std::size_t>(i)].lower;
    problem.upper[i] = coordinates[static_cast<std::size_t>(i)].upper;
  }
  if (task.on_iteration)
    problem.on_iteration = [&, before = iterations](int iteration, double rms) {
      return task.on_iteration(before + iteration, rms);
    };
  const LeastSquaresEnd end = minimise(problem, q);
  iterations += end.iterations;
  return {std::move(q), end.cost, end.ending};
}

/// Verifies the steps of time at the solution and goes on with finer ones; `steps` are those of the end.
Attempt minimise_in_time(const FitTask& task, const std::vector<Coordinate>& coordinates,
                         std::vector<int>& steps, const Eigen::VectorXd& start, int& iterations) {
  Attempt attempt{start};
  for (int round = 0; round < 4; ++round) {
    attempt = attempt_from(attempt.q, task, coordinates, steps, iterations);
    const materials::Material reached = Misfit(task, coordinates, steps).material(attempt.q);
    std::vector<int> finer = steps;
    for (std::size_t f = 0; f < steps.size(); ++f)
      finer[f] = steps_needed(reached, task.tests[f].history, time_tolerance, steps[f]);
    if (attempt.ending != FitEnding::converged || finer == steps) break;
    steps = std::move(finer);
  }
  return attempt;
}

/// Whether another start may lead to less: the misfit of relaxation times and exponents has valleys of
/// its own, and a parameter that has come to its bound has left one.
bool deserves_another_start(const FitTask& task, const std::vector<Coordinate>& coordinates,
                            const Eigen::VectorXd& start, const Attempt& attempt) {
  constexpr double nothing = 1e-12; // of the squares of relative errors
  if (attempt.ending == FitEnding::gave_up) return true;
  if (attempt.cost < nothing) return false;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (task.parameters[i].unit == "s" || is_exponent(task.parameters[i]) ||
        coordinates[i].at_bound(attempt.q[at]) ||
        has_run_away(task.parameters[i], coordinates[i], attempt.q[at], start[at]))
      return true;
  }
  return false;
}

Attempt minimise_in_time(const FitTask& task, const std::vector<Coordinate>& coordinates,
                         std::vector<int>& steps, const FitStart& start, int& iterations) {
  std::vector<Coordinate> seen = coordinates;
  for (const auto& [i, sign] : start.signs) seen[i] = seen[i].of_sign(sign);
  const auto from_to = [&](const std::vector<Coordinate>& from, const std::vector<Coordinate>& to,
                           Eigen::VectorXd q) {
    for (const auto& [i, sign] : start.signs) {
      double& one = q[static_cast<Eigen::Index>(i)];
      one = to[i].q(from[i].p(one));
    }
    return q;
  };
  Attempt attempt = minimise_in_time(task, seen, steps, from_to(coordinates, seen, start.q), iterations);
  attempt.q = from_to(seen, coordinates, attempt.q);
  return attempt;
}

/// One that gave up must be better by more than noise lets differ; one without a model has a negative cost.
double counted_cost(const Attempt& attempt) {
  if (attempt.cost < 0) return std::numeric_limits<double>::infinity();
  return attempt.ending == FitEnding::gave_up ? 1.01 * attempt.cost : attempt.cost;
}

void add_statistics(const Misfit& misfit, const std::vector<Coordinate>& coordinates,
                    const Eigen::VectorXd& q, FitOutcome& outcome) {
  const LeastSquares::Residuals found = misfit.residuals(q);
  const Eigen::VectorXd r = found.value_or(Eigen::VectorXd::Constant(misfit.rows(), NAN));
  auto [J, ends] = found ? misfit.differences(q, r) : Differences{};
  if (J.size() == 0) J.setZero(r.size(), q.size());
  ends.resize(coordinates.size());
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (ends[i] || coordinates[i].at_bound(q[static_cast<Eigen::Index>(i)]))
      J.col(static_cast<Eigen::Index>(i)).setZero();
  const FitStatistics statistics = fit_statistics(J, r, time_tolerance);
  outcome.deviation = statistics.deviation;
  outcome.correlation = statistics.correlation;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const double at = q[static_cast<Eigen::Index>(i)];
    const double half_width = statistics.half_widths[static_cast<Eigen::Index>(i)];
    FittedParameter& one = outcome.parameters[i];
    one.ends_model = ends[i];
    one.at_bound = one.ends_model || coordinates[i].at_bound(at);
    one.low = coordinates[i].p(at - half_width), one.high = coordinates[i].p(at + half_width);
  }
}

} // namespace

double MeasuredTest::largest_stress() const {
  double largest = 0;
  for (const double one : stress) largest = std::max(largest, std::abs(one));
  return largest;
}

bool FittedParameter::determined() const { return !at_bound && std::isfinite(low) && std::isfinite(high); }

FitOutcome solve_fit(const FitTask& task) {
  FitOutcome outcome;
  std::vector<Coordinate> coordinates;
  Eigen::VectorXd start(static_cast<Eigen::Index>(task.parameters.size()));
  const double modulus = materials::initial_shear_modulus(task.start.law);
  for (const FitParameter& parameter : task.parameters) {
    const double value = parameter.get(task.start);
    const auto i = static_cast<Eigen::Index>(coordinates.size());
    coordinates.emplace_back(parameter, value, modulus, task.range);
    start[i] = coordinates.back().q(value);
    outcome.parameters.push_back({.start = value});
  }
  for (const MeasuredTest& test : task.tests)
    outcome.steps.push_back(steps_needed(task.start, test.history, time_tolerance));

  const std::vector<int> first_steps = outcome.steps;
  Attempt best = minimise_in_time(task, coordinates, outcome.steps, start, outcome.iterations);
  std::vector<FitStart> others;
  if (best.ending != FitEnding::interrupted && deserves_another_start(task, coordinates, start, best))
    others = other_starts(task, coordinates, first_steps, start, best.q);
  for (const FitStart& other : others) {
    if (!Misfit(task, coordinates, first_steps).residuals(other.q)) continue; // no stress there
    std::vector<int> steps = first_steps;
    Attempt next = minimise_in_time(task, coordinates, steps, other, outcome.iterations);
    const FitEnding ending = next.ending;
    if (counted_cost(next) < (1 - 1e-6) * counted_cost(best)) {
      best = std::move(next);
      outcome.steps = std::move(steps);
    }
    if (ending == FitEnding::interrupted) best.ending = ending;
    if (ending == FitEnding::interrupted || !deserves_another_start(task, coordinates, start, best)) break;
  }

  const Misfit misfit(task, coordinates, outcome.steps);
  outcome.ending = best.ending;
  outcome.material = misfit.material(best.q);
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    outcome.parameters[i].value = task.parameters[i].get(outcome.material);
  for (std::size_t f = 0; f < task.tests.size(); ++f)
    outcome.stress.push_back(nominal_stress(outcome.material, task.tests[f].history, outcome.steps[f]));
  add_statistics(misfit, coordinates, best.q, outcome);
  return outcome;
}

} // namespace dielast::cases
