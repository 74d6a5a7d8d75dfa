// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/text/tree.hpp"

namespace dielast::cases {

/// The tree of a case file with its template's electrodes, supports and steps, so that overrides can reach
/// them. Throws FileError or CaseError.
Node read_case_file(const std::filesystem::path& path);

/// Makes a validated case of a tree. `path` is the case file's: relative names start there. Throws CaseError.
Case interpret(Node tree, const std::filesystem::path& path);

} // namespace dielast::cases
