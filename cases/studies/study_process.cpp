// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study_process.hpp"

#include "cases/console/terminal.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/resolved.hpp"
#include "cases/results/run.hpp"
#include "cases/studies/study_targets.hpp"
#include "meshing/mesh_error.hpp"
#include "post/files/results_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <map>
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
                                      .called = label(study, point),
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

/// The case of a folder of a point, with every default; empty where there is none.
std::string case_in(const std::filesystem::path& folder) {
  std::ostringstream resolved;
  resolved << std::ifstream(folder / resolved_name).rdbuf();
  return resolved.str();
}

/// Empty where the point has no valid case: it fails again as quickly.
std::string case_of(const Study& study, const StudyPoint& point) {
  try {
    return resolved_text(read_case(study.base, point.overrides));
  } catch (const CaseError&) {
    return "";
  }
}

} // namespace

bool is_current(const Study& study, const StudyPoint& point) {
  const std::string now = case_of(study, point);
  return !now.empty() && case_in(point.directory) == now;
}

void begin_again(post::ResultsFolder& folder, const Study& study, const std::vector<StudyPoint>& points) {
  const std::string on_its_way = "moving-";
  std::multimap<std::string, std::string> there; // by the case, names of folders
  std::vector<std::string> kept{resolved_name};
  for (const std::string& name : folder.names()) {
    if (name.starts_with(target_folder)) kept.push_back(name);
    if (name.starts_with(point_folder) || name.starts_with(on_its_way))
      if (std::string found = case_in(folder / name); !found.empty()) there.emplace(std::move(found), name);
  }
  std::vector<std::pair<std::string, std::string>> moves; // from, to
  for (const StudyPoint& point : points) {
    const std::string name = point.directory.filename();
    const auto [begin, end] = there.equal_range(case_of(study, point));
    auto own =
        std::find_if(begin, end, [&](const auto& folder_there) { return folder_there.second == name; });
    if (own != end)
      kept.push_back(name);
    else if (begin != end)
      moves.emplace_back((own = begin)->second, name);
    if (own != end) there.erase(own);
  }
  if (!there.empty())
    say("{}: results of {} that {} in this study no more are removed\n", folder.path().string(),
        there.size() == 1 ? "a point" : fmt::format("{} points", there.size()),
        there.size() == 1 ? "is" : "are");
  for (auto& [from, to] : moves) {
    const post::ResultsFolder owned(folder / from, "run"); // no other job is in it
    const std::string between = on_its_way + to;
    folder.add(between);
    std::filesystem::rename(folder / from, folder / between);
    kept.push_back(from = between);
  }
  folder.begin(kept);
  for (const auto& [from, to] : moves) {
    folder.add(to);
    std::filesystem::rename(folder / from, folder / to);
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
