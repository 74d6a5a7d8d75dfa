#pragma once

#include "cases/case.hpp"

#include <string>

namespace dielast::cases {

/// The case as a case file with every default explicit, in SI; in comments the program's version and the
/// checksums of the files that the case names. Reading it gives the same case.
std::string resolved_text(const Case& one);

/// What differs between two resolved texts, key by key, in words; empty where nothing does.
std::string resolved_changes(const std::string& before, const std::string& now);

/// Name of the geometry's section; "file" for a user's own mesh.
std::string geometry_name(const Case& one);

} // namespace dielast::cases
