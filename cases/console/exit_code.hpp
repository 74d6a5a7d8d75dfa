// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace dielast::cases {

/// What the command's exit code tells a script.
enum class ExitCode {
  ok = 0,
  usage_or_file = 1,
  invalid_case = 2,
  mesh = 3,
  not_converged = 4, ///< every accepted step is kept
  check_failed = 5,  ///< or a study's question has no answer, or works and heat are not resolved to 1 %
  interrupted = 130, ///< after a checkpoint
};

} // namespace dielast::cases
