// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/study_spec.hpp"

#include <filesystem>

namespace dielast::cases {

/// Reads and validates a study: the [study] section of a case file, or a file of its own that names the case
/// with case = "...". Every value of every axis is tried on the case. `overrides` are "key=value" for all
/// points. Throws FileError or CaseError.
Study read_study(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

} // namespace dielast::cases
