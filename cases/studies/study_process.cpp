// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study_process.hpp"

#include "cases/console/terminal.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/resolved.hpp"
#include "cases/runs/run.hpp"
#include "meshing/mesh_error.hpp"
#include "post/files/results_folder.hpp"

#include <cerrno>
#include <csignal>
#include <fstream>
#include <sstream>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dielast::cases {

namespace {

/// In the child: runs one point and ends the process. Why it failed is left in the point's mark.
[[noreturn]] void run_point(const Study& study, const StudyPoint& point, bool resume) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  int code = static_cast<int>(ExitCode::usage_or_file);
  std::string message;
  try {
    code = static_cast<int>(run_case(read_case(study.base, point.overrides),
                                     {.directory = point.directory,
                                      .threads = 1,
                                      .resume = resume,
                                      .quiet = true,
                                      .part_of = post::Link{study.title, "../report.html"}}));
  } catch (const post::FolderInUse&) { // another job runs it
    code = static_cast<int>(ExitCode::interrupted);
  } catch (const CaseError& error) {
    code = static_cast<int>(ExitCode::invalid_case);
    message = error.what();
  } catch (const meshing::MeshError& error) {
    code = static_cast<int>(ExitCode::mesh);
    message = error.what();
  } catch (const std::exception& error) {
    message = error.what();
  }
  try {
    if (code != static_cast<int>(ExitCode::interrupted)) mark_done(point, code, message);
  } catch (const std::exception&) {
    code = static_cast<int>(ExitCode::usage_or_file);
  }
  std::fflush(nullptr);
  _exit(code);
}

} // namespace

bool is_current(const Study& study, const StudyPoint& point) {
  std::ostringstream resolved;
  resolved << std::ifstream(point.directory / resolved_name).rdbuf();
  try {
    return resolved.str() == resolved_text(read_case(study.base, point.overrides));
  } catch (const CaseError&) {
    return false; // it fails again as quickly
  }
}

int exit_code_of(const StudyPoint& point, int status) {
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  if (code < 0 && !interrupted()) mark_done(point, code, fmt::format("crashed (signal {})", -code));
  return code;
}

pid_t start(const Study& study, const StudyPoint& point, bool resume) {
  std::fflush(nullptr); // or every child would print it again
  const pid_t child = fork();
  if (child == 0) run_point(study, point, resume);
  if (child < 0) throw FileError("cannot start another process for the study's points");
  return child;
}

Kept kept_of(const Study& study, const StudyPoint& point, bool resume) {
  const bool current = resume && is_current(study, point);
  auto result = current ? result_of(study, point) : std::nullopt;
  if (result && result->exit_code >= 0 && result->exit_code != static_cast<int>(ExitCode::usage_or_file))
    return {std::move(result)};
  if (!current) std::filesystem::remove(point.directory / "point.json");
  return {std::nullopt, current && !std::filesystem::exists(point.directory / "summary.json")};
}

int run_and_wait(const Study& study, const StudyPoint& point, bool resume) {
  int status = 0;
  const pid_t child = start(study, point, resume);
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return exit_code_of(point, status);
}

} // namespace dielast::cases
