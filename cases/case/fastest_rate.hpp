// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

namespace dielast::cases {

/// Tells all films the fastest rate at which the case asks something of them, 1/s, which the dashpot beside a
/// law must follow: that of the shortest step with a duration, and the angular frequencies of waves in these
/// and of sweeps; 0 where nothing takes time. To be called again when steps have changed.
void tell_fastest_rate(Case& one);

} // namespace dielast::cases
