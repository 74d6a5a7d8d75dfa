// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/study_spec.hpp"
#include "cases/text/diagnostics.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace dielast::cases {

/// Reads and validates a study: the [study] section of a case file, or a file of its own that names the case
/// with case = "...". Every value of every axis is tried on the case. `overrides` are "key=value" for all
/// points. Throws FileError or CaseError.
Study read_study(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// What a run of the file is told: that its section [study] takes no part. Nothing where there is none.
std::optional<Diagnostic> study_of_one_run(const std::filesystem::path& path);

} // namespace dielast::cases
