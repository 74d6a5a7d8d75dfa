// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/fits/fit_results.hpp"
#include "post/pictures/report.hpp"

namespace dielast::cases {

/// Parameters and errors of the tests as lines of text.
std::string fit_summary(const FitResults& results);

/// The fit's report: parameters, correlations, errors, and each test as measured and as modelled.
post::Report fit_report(const FitResults& results);

} // namespace dielast::cases
