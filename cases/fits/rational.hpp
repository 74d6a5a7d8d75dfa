// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/rational_spec.hpp"
#include "cases/fits/fit.hpp"

namespace dielast::cases {

/// What was found for each fit, in their order.
std::vector<RationalOutcome> solve_rational_fits(const RationalFits& asked);

/// Writes rational.json, rational.csv (measured and model) and report.html. Throws post::WriteError.
ExitCode run_rational_fits(const RationalFits& asked, const std::filesystem::path& directory);

} // namespace dielast::cases
