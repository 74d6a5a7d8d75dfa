// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/analyses/analysis.hpp"
#include "post/pictures/report.hpp"

namespace dielast::cases {

/// A table of modes, or Bode plots of displacement, voltage and impedance.
post::Section analysis_section(const Analysis& analysis);

} // namespace dielast::cases
