// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/study_spec.hpp"
#include "cases/console/exit_code.hpp"

#include "cases/studies/study_cluster.hpp"

#include <filesystem>
#include <optional>
#include <span>

namespace dielast::cases {

struct StudySettings {
  std::filesystem::path directory;  ///< study.csv, report.html and one directory per point
  int processes = 0;                ///< points at a time; 0: one per core
  bool resume = false;              ///< keep the points that are done, go on with the others
  std::optional<Cluster> cluster{}; ///< that runs the points, instead of this machine
};

/// Runs every point of a study's grid in a process of its own, so that a point that fails, or crashes, is
/// recorded and does not stop the rest; processes die with this one. study.csv is brought up to date after
/// every point and does not depend on their order. Returns not_converged when some point did. Throws
/// FileError, on `resume` of another base case, too, CaseError and post::WriteError.
ExitCode run_study(const Study& study, const StudySettings& settings);

/// Runs some points of a study, by their numbers, one after the other, and writes nothing but these points:
/// what one job of a cluster does. Points that are done, and those that another job runs, are left alone.
ExitCode run_points(const Study& study, const StudySettings& settings, std::span<const int> numbers);

/// Lists the points of a study, which of them are done or impossible, and how long they take on how much
/// disk, as the first of those that remain does in a folder of its own for at most `trial` seconds. Writes
/// nothing else. Throws as run_study().
ExitCode plan_study(const Study& study, const StudySettings& settings, double trial = 20);

} // namespace dielast::cases
