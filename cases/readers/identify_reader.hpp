// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/identify_spec.hpp"

namespace dielast::cases {

/// Whether the file is the identification of a device: it has a section [identify].
bool is_identification(const std::filesystem::path& path);

/// Reads and validates an identification, its case and the tables that it names. Throws FileError or
/// CaseError.
Identification read_identification(const std::filesystem::path& path);

} // namespace dielast::cases
