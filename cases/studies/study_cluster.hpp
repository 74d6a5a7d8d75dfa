// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/studies/study_process.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace dielast::cases {

/// Folder of job scripts and logs in a study's folder of results.
inline constexpr const char* cluster_folder = "slurm";

/// A Slurm cluster that sees the study's folder as this machine does.
struct Cluster {
  std::string options;              ///< of sbatch, as a user writes them
  int batch = 1;                    ///< points of one task of the job array
  std::vector<std::string> command; ///< runs points of the study when ` --points 1-20,25` is added
};

/// "1-20,25" and back; throws std::invalid_argument for what is no such list, or has a number below 1.
std::string list_text(std::span<const int> numbers);
std::vector<int> list_of(const std::string& text);

/// Submits the points as a job array and waits until all have run, whoever runs them. Points that are left
/// when the array has ended (pre-empted, out of time, on a failed node) are submitted again, to go on where
/// they stopped, until three arrays in a row have ended none. An array that is still there from before is
/// waited for first. While the cluster does not answer, the points' folders are watched. Returns early when
/// interrupted: the jobs go on. Throws FileError where sbatch refuses.
void run_on_cluster(const Study& study, std::span<const WaitingPoint> waiting,
                    const std::filesystem::path& directory, const Cluster& cluster, const PointEnded& ended);

} // namespace dielast::cases
