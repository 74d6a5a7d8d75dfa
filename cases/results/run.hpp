// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/console/exit_code.hpp"
#include "post/pictures/report.hpp"

#include <filesystem>
#include <optional>

namespace dielast::cases {

struct RunSettings {
  std::filesystem::path directory;     ///< of all outputs; made when it does not exist
  int threads = 0;                     ///< 0: every core
  bool resume = false;                 ///< go on from the directory's checkpoint, if the case is as it was
  bool quiet = false;                  ///< only errors on the terminal; run.log is written all the same
  std::string called{};                ///< before its errors, where others run beside it
  std::optional<post::Link> part_of{}; ///< the page of the study whose point this is
};

/// Runs a case and writes everything into one directory: history.csv, the ParaView series, resolved.toml,
/// run.log, summary.json and report.html. Stops after the next accepted state when interrupted() says so;
/// behind the last step without what margins and error estimates are solved for. Throws FileError, also for a
/// case that has changed since the run to resume, post::WriteError, and what post::ResultsFolder,
/// build_device() throw.
ExitCode run_case(const Case& one, const RunSettings& settings);

} // namespace dielast::cases
