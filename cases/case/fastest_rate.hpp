// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

namespace dielast::cases {

/// The fastest rate at which the case asks something of its films, 1/s: that of the shortest step with a
/// duration, and the angular frequencies of waves in these and of sweeps; 0 where nothing takes time.
double fastest_rate(const Case& one);

} // namespace dielast::cases
