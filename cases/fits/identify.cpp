// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/identify.hpp"

#include "cases/console/terminal.hpp"
#include "cases/fits/device_model.hpp"
#include "cases/fits/processes.hpp"
#include "cases/fitting/fit_statistics.hpp"
#include "cases/fitting/least_squares.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/resolved.hpp"
#include "post/files/report_files.hpp"
#include "post/files/results_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace dielast::cases {
namespace {

using Model = std::vector<std::vector<std::complex<double>>>; ///< for each test

/// Models and residuals as functions of the coordinates q = ln(value/start).
class DeviceMisfit {
 public:
  DeviceMisfit(const Identification& asked, int threads) : asked_(asked), device_(asked), threads_(threads) {}

  int rows() const { return static_cast<int>(asked_.fitted_numbers()); }
  std::vector<double> values(const Eigen::VectorXd& q) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < asked_.unknowns.size(); ++i)
      all.push_back(asked_.unknowns[i].start * std::exp(q[static_cast<Eigen::Index>(i)]));
    return all;
  }

  /// At several points at once; nothing where a run has none, and `failure` says why.
  std::vector<std::optional<Model>> models(const std::vector<Eigen::VectorXd>& points,
                                           std::string* failure = nullptr) const {
    const std::size_t runs = device_.run_count();
    const auto computed = in_processes(points.size() * runs, threads_, [&](std::size_t i) {
      return device_.run(i % runs, values(points[i / runs]));
    });
    std::vector<std::optional<Model>> all;
    for (std::size_t p = 0; p < points.size(); ++p) {
      auto& model = all.emplace_back(Model(asked_.tests.size()));
      for (std::size_t r = 0; r < runs; ++r) {
        const Computed& run = computed[p * runs + r];
        if (!run.failure.empty()) {
          if (failure) *failure = run.failure;
          model.reset();
          break;
        }
        std::size_t at = 0;
        for (const std::size_t t : device_.tests_of(r))
          for (std::size_t i = 0; i < asked_.tests[t].x.size(); ++i) {
            const double real = run.values.at(at++);
            (*model)[t].emplace_back(real, asked_.tests[t].is_response() ? run.values.at(at++) : 0.0);
          }
      }
    }
    return all;
  }

  /// Relative errors of a test's rows.
  std::vector<std::complex<double>> errors(std::size_t t, const Model& model) const {
    const DeviceTest& test = asked_.tests[t];
    double largest = 0;
    for (const auto& value : test.measured) largest = std::max(largest, std::abs(value));
    std::vector<std::complex<double>> all;
    for (std::size_t i = 0; i < test.x.size(); ++i)
      all.push_back((model[t][i] - test.measured[i]) /
                    (test.is_response() ? std::abs(test.measured[i]) : largest));
    return all;
  }

  LeastSquares::Residuals residuals(const std::optional<Model>& model) const {
    if (!model) return std::nullopt;
    Eigen::VectorXd r(rows());
    Eigen::Index row = 0;
    for (std::size_t t = 0; t < asked_.tests.size(); ++t) {
      const DeviceTest& test = asked_.tests[t];
      if (test.predict) continue;
      for (const std::complex<double>& error : errors(t, *model)) {
        r[row++] = test.weight * error.real();
        if (test.is_response()) r[row++] = test.weight * error.imag();
      }
    }
    return r.allFinite() ? std::optional(r) : std::nullopt;
  }

  Differences differences(const Eigen::VectorXd& q, const Eigen::VectorXd& r) const {
    return central_differences(q, r, 2e-3, [&](const std::vector<Eigen::VectorXd>& points) {
      std::vector<LeastSquares::Residuals> all;
      for (const auto& model : models(points)) all.push_back(residuals(model));
      return all;
    });
  }

 private:
  const Identification& asked_;
  DeviceModel device_;
  int threads_;
};

[[noreturn]] void reject(const Identification& asked, const std::string& message) {
  throw CaseError({{{asked.source.string()}, "identify.unknowns", message}});
}

/// The start must have a model, which every unknown changes.
void require_start(const Identification& asked, const DeviceMisfit& misfit) {
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(asked.unknowns.size()));
  std::string failure;
  const auto start = misfit.residuals(misfit.models({q}, &failure)[0]);
  if (!start)
    reject(asked, fmt::format("nothing to compare with at the start values: {}",
                              failure.empty() ? "a value is not finite" : failure));
  constexpr double nothing = 1e-9; // relative, of a change by a factor e
  const Eigen::MatrixXd J = misfit.differences(q, *start).slope;
  if (J.size() == 0) reject(asked, "the case does not run beside its start values");
  for (Eigen::Index i = 0; i < q.size(); ++i)
    if (J.col(i).lpNorm<Eigen::Infinity>() < nothing)
      reject(asked, fmt::format("found \"{}\": it changes nothing that was measured",
                                asked.unknowns[static_cast<std::size_t>(i)].key));
}

} // namespace

IdentifyOutcome solve_identification(const Identification& asked, int threads,
                                     const std::function<bool(int, double)>& on_iteration) {
  const DeviceMisfit misfit(asked,
                            threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency()));
  require_start(asked, misfit);
  const auto count = static_cast<Eigen::Index>(asked.unknowns.size());
  Eigen::VectorXd q = Eigen::VectorXd::Zero(count);
  const double bound = std::log(asked.range);
  const LeastSquaresEnd end =
      minimise({.rows = misfit.rows(),
                .residuals = [&](const auto& at) { return misfit.residuals(misfit.models({at})[0]); },
                .jacobian = [&](const auto& at, const auto& r) { return misfit.differences(at, r).slope; },
                .lower = Eigen::VectorXd::Constant(count, -bound),
                .upper = Eigen::VectorXd::Constant(count, bound),
                .max_iterations = asked.max_iterations,
                .function_tolerance = 1e-8, // runs are good to 1e-9
                .parameter_tolerance = 1e-8,
                .gradient_tolerance = 1e-12,
                .on_iteration = on_iteration},
               q);

  IdentifyOutcome outcome{.ending = end.ending, .iterations = end.iterations};
  Differences at_end; // its ends: where keys end on their own, or the case does not run beyond
  const auto at_bound = [&](Eigen::Index i) {
    const auto at = static_cast<std::size_t>(i);
    return std::abs(q[i]) >= bound * (1 - 1e-6) || (at < at_end.ends.size() && at_end.ends[at]);
  };
  Model unknown; // of a run that was interrupted
  for (const DeviceTest& test : asked.tests)
    unknown.emplace_back(test.x.size(), std::numeric_limits<double>::quiet_NaN());
  outcome.model = misfit.models({q})[0].value_or(unknown);
  const auto r = misfit.residuals(outcome.model);
  if (r && outcome.ending != FitEnding::interrupted) at_end = misfit.differences(q, *r);
  Eigen::MatrixXd& J = at_end.slope;
  if (J.size() == 0) J.setZero(misfit.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i)
    if (at_bound(i)) J.col(i).setZero();
  const FitStatistics statistics = fit_statistics(J, r.value_or(Eigen::VectorXd::Zero(misfit.rows())));
  outcome.deviation = statistics.deviation;
  outcome.correlation = statistics.correlation;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double start = asked.unknowns[static_cast<std::size_t>(i)].start, half = statistics.half_widths[i];
    const double one = start * std::exp(q[i] - half), other = start * std::exp(q[i] + half);
    outcome.unknowns.push_back({.start = start,
                                .value = start * std::exp(q[i]),
                                .low = std::min(one, other),
                                .high = std::max(one, other),
                                .at_bound = at_bound(i)});
  }
  for (std::size_t t = 0; t < asked.tests.size(); ++t) {
    double squares = 0;
    for (const auto& error : misfit.errors(t, outcome.model)) squares += std::norm(error);
    outcome.errors.push_back(std::sqrt(squares / static_cast<double>(asked.tests[t].x.size())));
  }
  return outcome;
}

ExitCode run_identification(const Identification& asked, const std::filesystem::path& directory,
                            int threads) {
  post::ResultsFolder folder(directory, "fit");
  folder.begin();
  say("{}: {} unknowns, {} tests, in {}\n", asked.title, asked.unknowns.size(), asked.tests.size(),
      directory.string());
  const auto tell = [](int iteration, double misfit) {
    say("  iteration {:3d}   rms of the weighted residuals {:.6g}\n", iteration, misfit);
    std::fflush(stdout);
    return !interrupted();
  };
  const IdentifyOutcome outcome = solve_identification(asked, threads, tell);
  std::vector<std::string> found;
  for (std::size_t i = 0; i < outcome.unknowns.size(); ++i)
    found.push_back(asked.unknowns[i].assignment(outcome.unknowns[i].value));
  folder.write("identified.toml", resolved_text(read_case(asked.base, found)));
  folder.write("identify.csv", identify_table(asked, outcome));
  post::write_report(folder, identify_report(asked, outcome));
  folder.write("identify.json", identify_json(asked, outcome));
  say("{}", identify_summary(asked, outcome));
  for (const std::string& warning : identify_warnings(asked, outcome)) say(stderr, "warning: {}\n", warning);
  say("results in {}: report.html, identified.toml, identify.csv, identify.json\n", directory.string());
  if (outcome.ending == FitEnding::interrupted) return ExitCode::interrupted;
  const ExitCode code = outcome.ending == FitEnding::converged ? ExitCode::ok : ExitCode::not_converged;
  if (code != ExitCode::ok)
    say(stderr, "error: not converged after {} iterations: the best values so far\n", outcome.iterations);
  folder.set_complete(static_cast<int>(code));
  return code;
}

} // namespace dielast::cases
