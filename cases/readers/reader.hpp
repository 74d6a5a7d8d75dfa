// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace dielast::cases {

/// Reads and validates a case file. `overrides` are texts "key=value" (see overrides.hpp); checks are of the
/// device as the file has it and are left out when one changes it. Every error is
/// found before any is reported. Throws FileError when the file cannot be read and CaseError when its content
/// is wrong.
Case read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});
/// The case for `dielast linearise`: has a section [linearise], that of the file or the default one.
Case read_case_to_linearise(const std::filesystem::path& path, const std::vector<std::string>& overrides);

/// Throws CaseError for every place that the case names and the mesh does not have.
void check_places(const Case& one, const std::vector<std::string>& places);

} // namespace dielast::cases
