// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/readers/case_tree.hpp"
#include "cases/readers/resolved.hpp"
#include "tests/fuzz/target.hpp"

namespace dielast::fuzz {

/// What resolved.toml says of a case must be read back, and to the same case.
inline void require_round_trip(const cases::Case& one) {
  const std::string written = cases::resolved_text(one);
  try {
    const std::string again =
        cases::resolved_text(cases::interpret(cases::parse_tree(written, "resolved"), one.source));
    if (again != written) fail("resolved.toml is read as another case:\n" + written + "\n----\n" + again);
  } catch (const cases::CaseError& error) {
    fail("resolved.toml is refused: " + std::string(error.what()) + "\n" + written);
  }
}

} // namespace dielast::fuzz
