// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case.hpp"

#include <string>

namespace dielast::cases {

/// SI unit of a quantity's values; "1" for a pure number.
/// `all`: the quantities of the case, of which a peak needs another.
std::string unit_of(const Quantity& quantity, const std::vector<Quantity>& all);

} // namespace dielast::cases
