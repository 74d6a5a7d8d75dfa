// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/rational_spec.hpp"

namespace dielast::cases {

/// Whether the file is the identification of a device: it has a section [identify].
bool is_identification(const std::filesystem::path& path);

/// Reads and validates an identification, its case and the tables that it names. Throws FileError or
/// CaseError.
Identification read_identification(const std::filesystem::path& path);

/// Whether the file has sections [[rational]].
bool is_rational_fit(const std::filesystem::path& path);
RationalFits read_rational_fits(const std::filesystem::path& path); ///< likewise

} // namespace dielast::cases
