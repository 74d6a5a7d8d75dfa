// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

#include <map>
#include <string>

namespace dielast::cases {

/// Numbers that a measurement keeps between states, by names that begin with a quantity's.
using References = std::map<std::string, double>;

/// The peak or the mean so far of a quantity, now that its subject has this value; `time`: s. A mean over
/// time is that of straight lines between the states where the subject has a value at both, and the value
/// itself where they take no time.
double value_so_far(References& references, const Quantity& quantity, double now, double time);
/// The mean begins, in a state whose value comes next.
void begin_mean(References& references, const Quantity& quantity, double time);

} // namespace dielast::cases
