#include "cases/fit.hpp"

#include "cases/fit_files.hpp"
#include "cases/fit_reader.hpp"
#include "cases/fit_report.hpp"
#include "cases/run.hpp"
#include "post/file_output.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace dielast::cases {

ExitCode run_fit(const Fit& fit, const std::filesystem::path& directory) {
  make_directory(directory);
  for (const char* stale : {"fit.json", "fit.csv", "material.toml", "report.html"})
    std::filesystem::remove(directory / stale);
  FitTask task = fit_task(fit);
  fmt::print("{}: {} parameters, {} tests, in {}\n", fit.title, task.parameters.size(), task.tests.size(),
             directory.string());
  task.on_iteration = [](int iteration, double misfit) {
    fmt::print("  iteration {:3d}   rms of the weighted residuals {:.6g}\n", iteration, misfit);
    std::fflush(stdout);
    return !interrupted();
  };
  FitOutcome outcome = solve_fit(task);
  const FitResults results(fit, std::move(task), std::move(outcome));

  post::replace_file(directory / "fit.json", fit_json(results).dump(2) + "\n");
  post::replace_file(directory / "fit.csv", fit_table(results));
  post::replace_file(directory / "material.toml", material_toml(results));
  fit_report(results).write(directory / "report.html");

  fmt::print("{}\n{}", results.ending(), fit_summary(results));
  for (const std::string& warning : results.warnings()) fmt::print("warning: {}\n", warning);
  std::fflush(stdout);
  switch (results.outcome.ending) {
  case FitEnding::converged:
    return ExitCode::ok;
  case FitEnding::gave_up:
    fmt::print(stderr, "error: {}\n", results.ending());
    return ExitCode::not_converged;
  case FitEnding::interrupted:
    break;
  }
  return ExitCode::interrupted;
}

} // namespace dielast::cases
