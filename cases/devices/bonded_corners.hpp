// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/device.hpp"

#include <vector>

namespace dielast::cases {

/// Nodes, ascending, where sides of solids (faces in space) or of shells that are held in every direction, or
/// tied to a body, meet sides that are free. Stresses are singular there: next to a right angle of an
/// incompressible solid displacements go as r^0.595 (Williams, J. Appl. Mech. 19, 526, 1952), so that
/// elements of any order converge slowly. Shells have that in their plane, and along their free sides a layer
/// of their thickness. Sides that are held across themselves only, as planes of symmetry are, are neither.
/// Membranes have none.
std::vector<int> bonded_corners(const Device& device);

} // namespace dielast::cases
