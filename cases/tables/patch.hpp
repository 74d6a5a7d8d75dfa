// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

namespace dielast::cases {

/// Says what the sides of a [patch] do in the words of every device, as supports and loads: left and bottom
/// are held, right and top follow stretches or carry stresses. Nothing for another geometry.
void add_patch_sides(Case& one);

} // namespace dielast::cases
