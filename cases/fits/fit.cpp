// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/fit.hpp"

#include "cases/console/terminal.hpp"
#include "cases/fits/fit_files.hpp"
#include "cases/fits/fit_report.hpp"
#include "cases/readers/fit_reader.hpp"
#include "cases/readers/resolved.hpp"
#include "post/files/report_files.hpp"
#include "post/files/results_folder.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace dielast::cases {

namespace {

/// Nothing that was written has been removed since.
bool is_whole(const post::ResultsFolder& folder) {
  return std::ranges::all_of(folder.names(),
                             [&](const std::string& name) { return std::filesystem::exists(folder / name); });
}

} // namespace

ExitCode run_fit(const Fit& fit, const FitSettings& settings) {
  const auto& directory = settings.directory;
  post::ResultsFolder folder(directory, "fit");
  const std::string resolved = resolved_text(fit);
  if (settings.resume) {
    require_unchanged(directory, resolved);
    if (const auto ended = folder.complete(); ended && is_whole(folder)) {
      say("{}: has run to its end, nothing to resume\n", directory.string());
      return static_cast<ExitCode>(*ended);
    }
  }
  folder.begin();
  folder.write(resolved_name, resolved);
  FitTask task = fit_task(fit);
  say("{}: {} parameters, {} tests, in {}\n", fit.title, task.parameters.size(), task.tests.size(),
      directory.string());
  task.on_iteration = [](int iteration, double misfit) {
    say("  iteration {:3d}   rms of the weighted residuals {:.6g}\n", iteration, misfit);
    std::fflush(stdout);
    return !interrupted();
  };
  FitOutcome outcome = solve_fit(task);
  const FitResults results(fit, std::move(task), std::move(outcome));

  folder.write("fit.csv", fit_table(results));
  folder.write("material.toml", material_toml(results));
  post::write_report(folder, fit_report(results));
  folder.write("fit.json", fit_json(results).dump(2) + "\n");

  say("{}\n{}", results.ending(), fit_summary(results));
  for (const std::string& warning : results.warnings()) say(stderr, "warning: {}\n", warning);
  say("results in {}: report.html, material.toml, fit.csv, fit.json\n", directory.string());
  std::fflush(stdout);
  const FitEnding ending = results.outcome.ending;
  if (ending == FitEnding::interrupted) return ExitCode::interrupted;
  if (ending == FitEnding::gave_up) say(stderr, "error: {}\n", results.ending());
  const ExitCode code = ending == FitEnding::converged ? ExitCode::ok : ExitCode::not_converged;
  folder.set_complete(static_cast<int>(code));
  return code;
}

} // namespace dielast::cases
