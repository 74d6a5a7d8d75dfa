// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/text/tree.hpp"

#include <vector>

namespace dielast::cases {

/// Standard quantities of a part that is turned about z (key `turned`): distances, sizes and stiffnesses
/// along x and y are meant along the part's own axes. After quarter turns these are axes, too; else
/// distances are those along the straight line, which as drawn lies along the part's axis, and what only
/// an axis defines is left out.
void turn_standard_quantities(std::vector<Node>& quantities, const Node& part);

} // namespace dielast::cases
