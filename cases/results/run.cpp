// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/results/run.hpp"

#include "cases/case/quantities.hpp"
#include "cases/console/as_warning.hpp"
#include "cases/console/forecast.hpp"
#include "cases/console/terminal.hpp"
#include "cases/language/conditions.hpp"
#include "cases/readers/resolved.hpp"
#include "cases/results/results.hpp"
#include "meshing/quality.hpp"
#include "post/files/report_files.hpp"
#include "post/files/results_folder.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <sstream>

namespace dielast::cases {

namespace {

std::string read_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// run.log gets everything, the terminal what a person wants to follow.
spdlog::logger make_logger(const RunSettings& settings, post::ResultsFolder& folder) {
  // A file of its own, whatever stood there under its name.
  folder.write("run.log", settings.resume ? read_text(folder / "run.log") : "");
  auto file = std::make_shared<spdlog::sinks::basic_file_sink_st>((folder / "run.log").string());
  spdlog::sink_ptr terminal = std::make_shared<spdlog::sinks::stdout_sink_st>();
  if (settings.quiet) terminal = std::make_shared<spdlog::sinks::stderr_sink_st>();
  terminal->set_level(settings.quiet ? spdlog::level::err : spdlog::level::info);
  spdlog::logger logger(settings.called, {file, terminal});
  logger.set_pattern("%v");
  if (!settings.called.empty()) terminal->set_pattern("%n: %v");
  logger.set_level(spdlog::level::debug);
  logger.flush_on(spdlog::level::info);
  logger.set_error_handler([](const std::string&) {}); // a full disk is told by the results' own files
  return logger;
}

/// Logs a simulation, records it, and stops it on an interrupt.
SimulationObserver observe(const Case& one, Recorder& recorder, spdlog::logger& log) {
  SimulationObserver observer;
  struct Pace {
    std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
    Forecast forecast{};
  };
  const auto pace = std::make_shared<Pace>();
  observer.on_step = [&log, pace](const Step& step) {
    *pace = {};
    log.info("step \"{}\"", step.name);
  };
  observer.on_try = [&log, pace](double s) {
    log.debug("    load factor {:.6f}", s);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - pace->begin;
    if (const std::string text = pace->forecast.at(s, elapsed.count()); !text.empty())
      log.info("    {}", text);
  };
  observer.on_iteration = [&log](const fem::Iteration& i) {
    log.debug("      iteration {:2d}   residual {:9.3e}   step length {:6.4f}   negative pivots {}", i.number,
              i.residual, i.step_length, i.negative_pivots);
  };
  observer.on_cutback = [&log](double s, const fem::NewtonResult& newton) {
    log.info("    {:8.6f}  not reached ({} iterations, residual {:.1e}): smaller increment", s,
             newton.iterations, newton.residual);
  };
  observer.on_critical = [&recorder, &log](const fem::CriticalPoint& critical, const post::Event& event) {
    log.warn("    {}", event.message);
    recorder.record_mode(critical, event);
  };
  observer.on_analysis = [&one, &recorder, &log](const Analysis& analysis, const fem::State& state) {
    if (analysis.kind == StepKind::modes) {
      for (const auto& row : analysis.rows)
        log.info("    mode {:.0f}  {:>10.6g} Hz  {:>10.6g} rad/s{}", row[0], row[1], row[2],
                 row[3] < 0 ? "  unstable" : "");
      const auto step = std::ranges::find(one.steps, analysis.step, &Step::name);
      if (static_cast<int>(analysis.rows.size()) < step->count)
        log.info("    there are no others ({} were asked for)", step->count);
    } else
      log.info("    {} frequencies, source of {}: {} {:.5g} to {:.5g}", analysis.rows.size(),
               fmt::join(analysis.driven, ", "), analysis.columns[1], analysis.rows.front()[1],
               analysis.rows.back()[1]);
    if (analysis.kind == StepKind::harmonic &&
        std::ranges::all_of(analysis.rows, [](const auto& row) { return row[1] == 0; })) {
      const bool moves = std::ranges::any_of(analysis.shapes, [](const Analysis::Shape& shape) {
        return std::ranges::any_of(shape.displacement, [](const auto& u) { return !u.isZero(0); });
      });
      log.warn("    {}", no_response(analysis.of, "response_of", moves));
    }
    recorder.record_analysis(analysis, state);
  };
  observer.goes_on = [] { return !interrupted(); };
  observer.on_accept = [&one, &recorder, &log](const Frame& frame) {
    std::string line = fmt::format("    {:8.6f}  {:>9}  {:2d} iteration{}", frame.record.load_factor,
                                   post::engineering(frame.record.largest_voltage(), "V"),
                                   frame.record.iterations, frame.record.iterations == 1 ? " " : "s");
    for (std::size_t q = 0; q < std::min<std::size_t>(frame.values.size(), 2); ++q)
      if (std::isfinite(frame.values[q]))
        line +=
            fmt::format("   {} {}", one.quantities[q].name,
                        post::engineering(
                            frame.values[q], unit_of(one.quantities[q], one.quantities),
                            one.quantities[q].kind->relative ? post::Ratio::percent : post::Ratio::plain, 5));
    log.info(line);
    for (const post::Event& event : frame.record.events)
      if (!is_critical(event.kind)) // told when they were located
        log.warn("    {}{}{}: {}", event.kind, event.place.empty() ? "" : " in ", event.place, event.message);
    recorder.record(frame);
    return !interrupted();
  };
  return observer;
}

/// How the run ended whose results the folder holds; nothing when there is something left to do. Throws
/// FileError when they are of another case.
std::optional<ExitCode> finished(const Case& one, const post::ResultsFolder& folder) {
  if (read_text(folder / resolved_name).empty()) return std::nullopt;
  require_unchanged(folder.path(), resolved_text(one));
  const auto summary = nlohmann::json::parse(read_text(folder / "summary.json"), nullptr, false);
  if (!summary.contains("status") || !std::filesystem::exists(folder / "report.html")) return std::nullopt;
  return folder.complete() ? std::optional(static_cast<ExitCode>(*folder.complete())) : std::nullopt;
}

} // namespace

ExitCode run_case(const Case& one, const RunSettings& settings) {
  post::ResultsFolder folder(settings.directory, "run");
  if (const auto ended = settings.resume ? finished(one, folder) : std::nullopt) {
    std::filesystem::remove(folder / checkpoint_name); // a kill may have left it
    if (!settings.quiet) say("{}: has run to its end, nothing to resume\n", folder.path().string());
    return *ended;
  }
  if (!settings.resume) folder.begin();
  if (settings.resume && folder.names().empty() && read_text(folder / resolved_name) == resolved_text(one))
    folder.adopt();
  Simulation simulation(one, settings.threads);
  Recorder recorder(one, simulation, folder, settings.resume);
  spdlog::logger log = make_logger(settings, folder);
  const Device& device = simulation.device();
  const meshing::QualityReport quality = meshing::quality(device.mesh);
  log.info("dielast " DIELAST_VERSION "  {}", one.title);
  if (const int unknowns = device.model.dofs.free_count(); one.dimension == fem::Dimension::axisymmetric)
    log.info("{} elements along the meridian, {} unknowns", device.mesh.film()->size(), unknowns);
  else
    log.info("{} {}, {} beams, {} unknowns{}", device.mesh.film()->size(),
             quality.rods > 0         ? "rods"
             : quality.tetrahedra > 0 ? "tetrahedra"
                                      : "triangles",
             quality.lines, unknowns,
             quality.triangles + quality.tetrahedra > 0
                 ? fmt::format("; smallest angle {:.1f} deg", quality.smallest_angle)
                 : "");
  for (const std::string& warning : simulation.warnings()) log.warn("{}", as_warning(warning));
  if (!recorder.journal().records.empty())
    log.info("resumed behind {} recorded states", recorder.journal().records.size());
  else if (settings.resume)
    log.info("no recorded states to resume behind: it begins anew");

  const Outcome outcome = simulation.run(observe(one, recorder, log));
  if (outcome.ending == Ending::interrupted) {
    if (outcome.kind != between_states) recorder.save_checkpoint();
    log.warn("interrupted: {} recorded states kept in {}; go on with --resume", recorder.kept(),
             settings.directory.string());
    return ExitCode::interrupted;
  }
  recorder.write_waiting();
  if (one.margins_up_to > 1 && outcome.ending == Ending::complete && !takes_time(one))
    log.info("margins: up to {:.6g} times the voltages of the end", one.margins_up_to);
  std::vector<Margin> margins = margins_of(one, simulation, recorder.journal(), outcome, settings.threads);
  Estimates estimates{.reason = "left out: output.error_estimate = false"};
  if (one.error_estimate && interrupted())
    estimates.reason = "interrupted";
  else if (one.error_estimate) {
    if (outcome.ending == Ending::complete || outcome.kind == "limit point")
      log.info("error estimate: the case once more with other elements and time steps");
    estimates =
        estimate_errors(one, simulation, outcome, recorder.journal().records, margins, settings.threads);
  }
  const bool left_out = interrupted() && outcome.ending == Ending::complete;
  if (left_out) recorder.save_checkpoint();
  Results results =
      collect_results(one, simulation, outcome, recorder.journal(), estimates, std::move(margins));
  results.profiles = profiles_of(one, device, outcome, recorder.journal());

  log.info("results");
  for (const post::QuantityRow& row : results.quantities)
    log.info("  {:<24} {}{}{}", row.name, post::with_error(row), row.peak ? ", " : "", post::peak_note(row));
  if (one.error_estimate && outcome.ending == Ending::complete && !estimates.reason.empty())
    log.warn("  no error estimate: {}", estimates.reason);
  for (const EventRemark& event : estimates.events) log.warn("  {}: {}", event.kind, event.remark);
  for (const post::CheckRow& check : results.checks)
    log.log(check.passed ? spdlog::level::info : spdlog::level::err, "  check {:<18} {}: {} expected {} ± {}",
            check.quantity, check.passed ? "passed" : "FAILED",
            post::engineering(check.value, check.unit, check.ratio, 6),
            post::engineering(check.expected, check.unit, check.ratio, 6),
            post::engineering(check.tolerance, check.unit, check.ratio, 2));
  if (one.skipped_checks > 0)
    log.info("  {} check{} left out: --set changed the device that they are for", one.skipped_checks,
             one.skipped_checks == 1 ? "" : "s");
  if (results.time_error > 0)
    log.info(
        "time steps: their errors of dashpots' stretches, and of motion over a hundredth of the device, add "
        "up to {:.1e}",
        results.time_error);
  for (std::size_t w = simulation.warnings().size(); w < results.warnings.size(); ++w)
    log.warn("{}", as_warning(results.warnings[w]));
  const fem::Timings& t = simulation.timings();
  log.info("{} Newton iterations; CPU {:.2f} s: residual {:.2f}, tangent {:.2f}, factor {:.2f}, solve {:.2f}",
           t.iterations, static_cast<double>(std::clock()) / CLOCKS_PER_SEC, t.residual, t.tangent, t.factor,
           t.solve);
  if (!outcome.message.empty()) log.error(outcome.message);
  if (left_out)
    log.warn("interrupted: every step is done, margins and error estimates are not; go on with --resume");
  log.flush();

  const ExitCode code = left_out                            ? ExitCode::interrupted
                        : outcome.ending == Ending::gave_up ? ExitCode::not_converged
                        : results.checks_passed()           ? ExitCode::ok
                                                            : ExitCode::check_failed;
  const Journal told = with_remarks(recorder.journal(), results.event_remarks);
  post::Report report = run_report(one, device, results, told, read_text(folder / "run.log"));
  report.part_of = settings.part_of;
  if (one.all_states)
    post::write_report(folder, report);
  else
    folder.write("report.html", report.html());
  for (std::size_t p = 0; p < one.profiles.size(); ++p)
    if (results.profiles[p])
      folder.write(profile_name(one.profiles[p]) + ".csv", results.profiles[p]->csv(one.profiles[p]));
  folder.write("summary.json", summary_json(one, device, results, told).dump(2) + "\n");
  if (!left_out) {
    folder.set_complete(static_cast<int>(code));
    std::filesystem::remove(folder / checkpoint_name);
  }
  if (!settings.quiet)
    say("results in {}: report.html, history.csv, summary.json{}\n", folder.path().string(),
        one.fields ? fmt::format(", {}.pvd for ParaView", one.source.stem().string()) : "");
  return code;
}

} // namespace dielast::cases
