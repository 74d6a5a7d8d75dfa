// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study.hpp"

#include "cases/console/terminal.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/resolved.hpp"
#include "cases/studies/study_best.hpp"
#include "cases/studies/study_cluster.hpp"
#include "cases/studies/study_process.hpp"
#include "cases/studies/study_report.hpp"
#include "cases/studies/study_targets.hpp"
#include "post/files/report_files.hpp"
#include "post/files/results_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <map>
#include <set>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace dielast::cases {

namespace {

/// One line that says how far the study is: rewritten in place on a terminal, one per point in a pipe.
class ProgressLine {
 public:
  ProgressLine(const Study& study, std::size_t total) : study_(study), total_(total) {}

  void done(const StudyPoint& point, int exit_code) {
    ++done_;
    ++ran_;
    failed_ += exit_code != 0;
    if (!terminal_) {
      say("{}/{}  {}  exit {}\n", done_, total_, label(study_, point), exit_code);
      std::fflush(stdout);
    }
    show();
  }
  void skipped() { ++done_; }
  void show() const {
    if (!terminal_) return;
    constexpr std::size_t width = 30;
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const std::size_t filled = total_ ? width * done_ / total_ : width;
    const std::string left = ran_
                                 ? fmt::format("about {:.0f} s left", elapsed / static_cast<double>(ran_) *
                                                                          static_cast<double>(total_ - done_))
                                 : "";
    say("\r[{:#>{}}{:->{}}] {}/{}  {} failed  {:.0f} s  {}\033[K", "", filled, "", width - filled, done_,
        total_, failed_, elapsed, left);
    std::fflush(stdout);
  }
  void end() const {
    if (terminal_) say("\n");
  }

 private:
  const Study& study_;
  bool terminal_ = isatty(STDOUT_FILENO);
  std::size_t total_, done_ = 0, ran_ = 0, failed_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace

namespace {

/// Every point in a process of its own, so many at a time.
void run_here(const Study& study, std::span<const WaitingPoint> waiting, std::size_t processes,
              const PointEnded& ended) {
  std::map<pid_t, const StudyPoint*> running;
  for (std::size_t next = 0; next < waiting.size() || !running.empty();) {
    while (next < waiting.size() && running.size() < processes && !interrupted()) {
      const auto& [point, resume] = waiting[next++];
      running[start(study, *point, resume)] = point;
    }
    if (running.empty()) break; // interrupted
    int status = 0;
    const auto found = running.find(waitpid(-1, &status, 0));
    if (found == running.end()) continue;
    const StudyPoint& point = *found->second;
    running.erase(found);
    const int code = exit_code_of(point, status);
    if (code != static_cast<int>(ExitCode::interrupted)) ended(point, code);
  }
}

} // namespace

ExitCode run_points(const Study& study, const StudySettings& settings, std::span<const int> numbers) {
  const std::vector<StudyPoint> points = study_points(study, settings.directory);
  for (const int number : numbers)
    if (number > static_cast<int>(points.size()))
      throw std::invalid_argument(
          fmt::format("--points {}: the study has {} points only", number, points.size()));
  for (const StudyPoint& point : points) {
    if (interrupted()) return ExitCode::interrupted;
    if (std::ranges::find(numbers, point.number) == numbers.end()) continue;
    const Kept kept = kept_of(study, point, true);
    if (!kept.result)
      say("{}: {}  exit {}\n", point.number, label(study, point), run_and_wait(study, point, kept.resume));
    std::fflush(stdout);
  }
  return interrupted() ? ExitCode::interrupted : ExitCode::ok;
}

namespace {

/// Whether each target is met somewhere and each best point is one.
bool all_answered(const Study& study, const Collected& collected,
                  const std::vector<TargetSolution>& solutions) {
  for (std::size_t t = 0; t < study.targets.size(); ++t)
    if (std::ranges::find(solutions, t, &TargetSolution::target) == solutions.end()) return false;
  return std::ranges::all_of(
      study.best, [&](const StudyBest& best) { return best_point(study, best, collected).has_value(); });
}

/// Warnings of the section, of checks that no point is asked, and of varied keys that have no effect at the
/// points but those with one of their values, the default.
std::vector<std::string> warnings_of(const Study& study, const std::vector<StudyPoint>& points) {
  const std::vector<std::string> keys = study.varied();
  std::vector<std::set<std::string>> not_told(keys.size()); // values at the other points
  std::vector<std::string> reasons(keys.size());
  bool has_idle_checks = false;
  for (const StudyPoint& point : points) {
    try {
      const Case one = read_case(study.base, point.overrides);
      has_idle_checks = has_idle_checks || one.skipped_checks > 0;
      for (std::size_t k = 0; k < keys.size(); ++k) {
        const auto warning = std::ranges::find(one.warnings, keys[k], &Diagnostic::key);
        if (warning == one.warnings.end())
          not_told[k].insert(point.values[k]);
        else
          reasons[k] = warning->message;
      }
    } catch (const CaseError&) { // told where the point runs
    }
  }
  std::vector<std::string> warnings;
  for (const Diagnostic& warning : study.warnings) warnings.push_back(warning.text());
  if (has_idle_checks)
    warnings.push_back(Diagnostic{{study.source.string()},
                                  "check",
                                  "has no effect in a study of other devices than the file's",
                                  Severity::warning}
                           .text());
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (!reasons[k].empty() && not_told[k].size() <= 1)
      warnings.push_back(Diagnostic{{study.source.string()},
                                    "study.vary",
                                    fmt::format("\"{}\" {}", keys[k], reasons[k]),
                                    Severity::warning}
                             .text());
  return warnings;
}

} // namespace

ExitCode run_study(const Study& study, const StudySettings& settings) {
  post::ResultsFolder folder(settings.directory, "study");
  const Case base = read_case(study.base, study.settings);
  const std::string resolved = resolved_text(base);
  if (settings.resume) require_unchanged(settings.directory, resolved);
  const std::vector<StudyPoint> points = study_points(study, settings.directory);
  if (settings.resume)
    begin_again(folder, study, points);
  else
    folder.begin();
  folder.write(resolved_name, resolved);
  for (const StudyPoint& point : points) folder.add(point.directory.filename());
  const std::size_t processes = settings.processes > 0 ? static_cast<std::size_t>(settings.processes)
                                                       : std::max(1U, std::thread::hardware_concurrency());
  say("{}: {} points, {} at a time, in {}\n", study.title, points.size(), processes,
      settings.directory.string());
  for (const Diagnostic& warning : base.warnings) say(stderr, "{}\n", warning.text());
  for (const std::string& warning : warnings_of(study, points)) say(stderr, "{}\n", warning);
  ProgressLine progress(study, points.size());
  std::vector<WaitingPoint> waiting;
  for (const StudyPoint& point : points) {
    const Kept kept = kept_of(study, point, settings.resume);
    if (kept.result)
      progress.skipped();
    else
      waiting.push_back({&point, kept.resume});
  }
  progress.show();
  const auto ended = [&](const StudyPoint& point, int code) {
    progress.done(point, code);
    folder.write("study.csv", study_table(study, points, Collected(study, points)));
  };
  if (settings.cluster) {
    folder.add(cluster_folder);
    run_on_cluster(study, waiting, settings.directory, *settings.cluster, ended);
  } else {
    run_here(study, waiting, processes, ended);
  }
  progress.end();
  if (interrupted()) {
    say("interrupted; go on with --resume\n");
    return ExitCode::interrupted;
  }
  folder.write("study.csv", study_table(study, points, Collected(study, points)));
  const auto run = [&](const StudyPoint& point) -> std::optional<PointResult> {
    folder.add(point.directory.filename());
    const Kept kept = kept_of(study, point, settings.resume);
    if (kept.result || interrupted()) return kept.result;
    const int code = run_and_wait(study, point, kept.resume);
    if (code == static_cast<int>(ExitCode::interrupted)) return std::nullopt;
    say("target: {}  exit {}\n", label(study, point), code);
    return result_of(study, point);
  };
  const auto solutions = solve_targets(study, points, settings.directory, run);
  if (interrupted()) {
    say("interrupted; go on with --resume\n");
    return ExitCode::interrupted;
  }
  const Collected collected(study, points);
  std::vector<std::string> answers = best_lines(study, points, collected);
  for (std::string& line : target_lines(study, points, collected, solutions))
    answers.push_back(std::move(line));
  if (!answers.empty()) folder.write("study.json", study_json(study, points, collected, solutions));
  post::write_report(folder, study_report(study, points, collected, answers));

  int failed = 0;
  bool checked = true;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (const auto& result = collected.results[p]; !result || result->exit_code != 0) {
      const bool has_ended = result && result->has_ended();
      failed += !has_ended;
      checked = checked && !has_ended;
      say("failed: {}: {}\n", label(study, points[p]),
          !result                   ? "not finished"
          : result->message.empty() ? "checks failed, see its run.log"
                                    : result->message);
    }
  for (const std::string& line : answers) say("{}\n", line);
  say("{} of {} points reached their ends, all are in {}, report in {}\n",
      points.size() - static_cast<std::size_t>(failed), points.size(),
      (settings.directory / "study.csv").string(), (settings.directory / "report.html").string());
  const bool solved =
      std::ranges::all_of(solutions, [](const TargetSolution& one) { return one.problem.empty(); });
  const ExitCode code = failed || !solved                                      ? ExitCode::not_converged
                        : checked && all_answered(study, collected, solutions) ? ExitCode::ok
                                                                               : ExitCode::check_failed;
  folder.set_complete(static_cast<int>(code));
  return code;
}

namespace {

/// What a point took.
struct Trial {
  double seconds = 0, megabytes = 0;
  bool finished = false;
};

Trial try_point(const Study& study, StudyPoint point, double most_seconds) {
  using Clock = std::chrono::steady_clock;
  std::string folder = (std::filesystem::temp_directory_path() / "dielast-XXXXXX").string();
  if (!::mkdtemp(folder.data())) throw FileError("cannot make a folder for temporary files");
  point.directory = std::filesystem::path(folder) / "point";
  const auto begin = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const pid_t child = start(study, point, false);
  int status = 0;
  bool ended = false;
  while (!ended && elapsed() < most_seconds && !interrupted()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ended = waitpid(child, &status, WNOHANG) == child;
  }
  Trial trial{.seconds = elapsed(), .finished = ended};
  if (!ended) {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
  }
  std::error_code ignored;
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder, ignored))
    if (file.is_regular_file(ignored)) trial.megabytes += static_cast<double>(file.file_size(ignored)) / 1e6;
  std::filesystem::remove_all(folder, ignored);
  return trial;
}

} // namespace

ExitCode plan_study(const Study& study, const StudySettings& settings, double trial_seconds) {
  const std::vector<StudyPoint> points = study_points(study, settings.directory);
  for (const std::string& warning : warnings_of(study, points)) say(stderr, "{}\n", warning);
  const StudyPoint* first = nullptr;
  std::size_t left = 0, impossible = 0;
  for (const StudyPoint& point : points) {
    std::string remark;
    try {
      read_case(study.base, point.overrides);
    } catch (const CaseError& error) {
      remark = fmt::format("  impossible: {}", error.diagnostics().front().message);
      ++impossible;
    }
    if (remark.empty()) {
      if (is_current(study, point) && result_of(study, point))
        remark = "  done";
      else if (left++ == 0)
        first = &point;
    }
    say("{:>6}  {}{}\n", point.number, label(study, point), remark);
  }
  say("{} points in {}: {} to run, {} impossible\n", points.size(), settings.directory.string(), left,
      impossible);
  if (!first) return ExitCode::ok;
  std::fflush(stdout);
  const Trial trial = try_point(study, *first, trial_seconds);
  if (interrupted()) return ExitCode::interrupted;
  const std::size_t processes = settings.processes > 0 ? static_cast<std::size_t>(settings.processes)
                                                       : std::max(1U, std::thread::hardware_concurrency());
  const auto rounds = static_cast<double>((left + processes - 1) / processes);
  const char* about = trial.finished ? "about" : "more than";
  say("point {} takes {} {:.2g} s and {:.2g} MB: all {} {:.2g} s, {} at a time, and {:.2g} MB\n",
      first->number, about, trial.seconds, trial.megabytes, about, rounds * trial.seconds, processes,
      static_cast<double>(left) * trial.megabytes);
  return ExitCode::ok;
}

} // namespace dielast::cases
