// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/text/tree.hpp"

namespace dielast::cases {

/// The tree of a case file with its template's electrodes, supports and steps, so that overrides can reach
/// them. Throws FileError or CaseError.
Node read_case_file(const std::filesystem::path& path);

/// Applies an override (see apply_override()) and brings anew what the device brings, which may be another
/// one now. Throws CaseError.
void override_case(Node& tree, std::string_view key, std::string_view value, const Source& source);
void override_case(Node& tree, std::string_view assignment);

/// Makes a validated case of a tree with what the device brings. `path` is the case file's: relative names
/// start there. Throws CaseError.
Case interpret(Node tree, const std::filesystem::path& path);

} // namespace dielast::cases
