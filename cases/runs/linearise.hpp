// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/console/exit_code.hpp"

#include <filesystem>

namespace dielast::cases {

struct LineariseSettings {
  std::filesystem::path directory; ///< of all outputs; made when it does not exist
  int threads = 0;                 ///< 0: every core
};

/// Takes a case through its steps and makes a linear model x' = A x + B u, y = C x + D u of [linearise] order
/// about the state that they end in, from the voltage of the first electrode's source (V) to a displacement
/// (m) or an angle (rad): linear_model.json, linear_model.m and report.html, with its error against the full
/// harmonic response. The case is one of read_case_to_linearise(). Throws as run_case().
ExitCode linearise_case(const Case& one, const LineariseSettings& settings);

} // namespace dielast::cases
