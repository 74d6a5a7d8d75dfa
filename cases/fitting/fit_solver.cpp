// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/fit_solver.hpp"

#include "cases/fitting/fit_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

constexpr double time_tolerance = 2e-4;

/// A parameter as the solver sees it: unbounded in scale.
class Coordinate {
 public:
  Coordinate(const FitParameter& parameter, double start, double modulus, double range)
      : logarithmic_(std::isfinite(parameter.above)) {
    if (logarithmic_) {
      above_ = parameter.above;
      lower = q(start) - std::log(range), upper = q(start) + std::log(range);
      if (std::isfinite(parameter.below)) upper = std::min(upper, q(parameter.below));
    } else {
      scale_ = start != 0 ? std::abs(start) : parameter.unit == "Pa" ? modulus : 1;
      lower = q(start) - range, upper = q(start) + range;
    }
  }
  double q(double p) const { return logarithmic_ ? std::log(p - above_) : p / scale_; }
  double p(double q) const { return logarithmic_ ? above_ + std::exp(q) : scale_ * q; }
  bool at_bound(double q) const {
    const double near = 1e-6 * (upper - lower);
    return q <= lower + near || q >= upper - near;
  }

  double lower = 0, upper = 0;

 private:
  bool logarithmic_;
  double above_ = 0, scale_ = 1;
};

/// The residuals as a function of the coordinates.
class Misfit {
 public:
  Misfit(const FitTask& task, const std::vector<Coordinate>& coordinates, const std::vector<int>& steps)
      : task_(task), coordinates_(coordinates), steps_(steps) {}

  int rows() const {
    int all = 0;
    for (const MeasuredTest& test : task_.tests)
      if (!test.predict) all += static_cast<int>(test.stress.size());
    return all;
  }
  materials::Material material(const Eigen::VectorXd& q) const {
    materials::Material changed = task_.start;
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      task_.parameters[i].set(changed, coordinates_[i].p(q[static_cast<Eigen::Index>(i)]));
    return changed;
  }
  LeastSquares::Residuals residuals(const Eigen::VectorXd& q) const {
    Eigen::VectorXd r(rows());
    const materials::Material changed = material(q);
    Eigen::Index row = 0;
    for (std::size_t f = 0; f < task_.tests.size(); ++f) {
      const MeasuredTest& test = task_.tests[f];
      if (test.predict) continue;
      const std::vector<double> model = nominal_stress(changed, test.history, steps_[f]);
      const double scale = test.weight / test.largest_stress();
      for (std::size_t i = 0; i < model.size(); ++i) r[row++] = scale * (model[i] - test.stress[i]);
    }
    return r.allFinite() ? std::optional(r) : std::nullopt;
  }
  Differences differences(const Eigen::VectorXd& q, const Eigen::VectorXd& r) const {
    return central_differences(q, r, 1e-4, [&](const std::vector<Eigen::VectorXd>& points) {
      std::vector<LeastSquares::Residuals> all;
      for (const Eigen::VectorXd& point : points) all.push_back(residuals(point));
      return all;
    });
  }

 private:
  const FitTask& task_;
  const std::vector<Coordinate>& coordinates_;
  const std::vector<int>& steps_;
};

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
      .gradient_tolerance = 1e-14};
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

/// Another start: relaxation times spread evenly, in their logarithms, from the shortest time between rows to
/// the duration of the tests, moduli and viscosities scaled to the measured stresses.
Eigen::VectorXd other_start(const FitTask& task, const std::vector<Coordinate>& coordinates,
                            const std::vector<int>& steps, Eigen::VectorXd q) {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (const MeasuredTest& test : task.tests)
    for (std::size_t i = 1; !test.predict && i < test.history.time.size(); ++i) {
      shortest = std::min(shortest, test.history.time[i] - test.history.time[i - 1]);
      longest = std::max(longest, test.history.time[i] - test.history.time[0]);
    }
  std::vector<Eigen::Index> times, moduli;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (task.parameters[i].unit == "s") times.push_back(static_cast<Eigen::Index>(i));
    if (task.parameters[i].unit.starts_with("Pa")) moduli.push_back(static_cast<Eigen::Index>(i));
  }
  const auto limited = [&](Eigen::Index i, double p) {
    const Coordinate& c = coordinates[static_cast<std::size_t>(i)];
    q[i] = std::clamp(c.q(p), c.lower, c.upper);
  };
  for (std::size_t n = 0; n < times.size() && longest > 0; ++n) {
    const double part = static_cast<double>(n + 1) / static_cast<double>(times.size() + 1);
    limited(times[n], shortest * std::pow(longest / shortest, part));
  }
  double measured = 0, model = 0;
  const materials::Material here = Misfit(task, coordinates, steps).material(q);
  for (std::size_t f = 0; f < task.tests.size(); ++f) {
    const MeasuredTest& test = task.tests[f];
    if (test.predict) continue;
    const std::vector<double> stress = nominal_stress(here, test.history, steps[f]);
    const double scale = test.weight / test.largest_stress();
    for (std::size_t i = 0; i < stress.size(); ++i) {
      measured += scale * scale * stress[i] * test.stress[i];
      model += scale * scale * stress[i] * stress[i];
    }
  }
  if (measured > 0 && std::isfinite(model))
    for (const Eigen::Index i : moduli)
      limited(i, coordinates[static_cast<std::size_t>(i)].p(q[i]) * measured / model);
  return q;
}

/// Whether another start may lead to less: the misfit of relaxation times has valleys of its own, and a
/// parameter that has come to its bound has left one.
bool deserves_another_start(const FitTask& task, const std::vector<Coordinate>& coordinates,
                            const Attempt& attempt) {
  if (attempt.ending == FitEnding::gave_up) return true;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (task.parameters[i].unit == "s" || coordinates[i].at_bound(attempt.q[static_cast<Eigen::Index>(i)]))
      return true;
  return false;
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
  const FitStatistics statistics = fit_statistics(J, r);
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

  std::vector<int> steps = outcome.steps; // for a second attempt
  Attempt best = minimise_in_time(task, coordinates, outcome.steps, start, outcome.iterations);
  if (best.ending != FitEnding::interrupted && deserves_another_start(task, coordinates, best)) {
    const Eigen::VectorXd other = other_start(task, coordinates, steps, start);
    Attempt second = minimise_in_time(task, coordinates, steps, other, outcome.iterations);
    const double alike = best.ending == FitEnding::gave_up ? 1 + 1e-6 : 1 - 1e-6;
    const bool usable = second.cost >= 0; // -1: the model has no stress there
    const FitEnding ending = second.ending;
    if (usable && second.cost < alike * best.cost) {
      best = std::move(second);
      outcome.steps = std::move(steps);
    }
    if (ending == FitEnding::interrupted) best.ending = ending;
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
