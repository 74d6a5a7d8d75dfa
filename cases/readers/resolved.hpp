// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/fit_spec.hpp"

#include <filesystem>
#include <string>

namespace dielast::cases {

/// The case as a case file with every default explicit, in SI; in comments the program's version and the
/// checksums of the files that the case names. Reading it gives the same case.
std::string resolved_text(const Case& one);
/// A fit file in the same way, its tests' tables as checksums.
std::string resolved_text(const Fit& fit);

/// Name of the file in a folder of results that says what they are results of.
inline constexpr const char* resolved_name = "resolved.toml";

/// What differs between two resolved texts, key by key, in words; empty where nothing does.
std::string resolved_changes(const std::string& before, const std::string& now);

/// Throws FileError that says what has changed when the folder's results are of something else than
/// `resolved`. They may be of nothing yet.
void require_unchanged(const std::filesystem::path& folder, const std::string& resolved);

/// Name of the section of a part's geometry; "file" for a user's own mesh, empty for a place of another's.
std::string geometry_name(const Part& part);

} // namespace dielast::cases
