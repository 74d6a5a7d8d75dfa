// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

#include <span>
#include <string>

namespace dielast::cases {

/// What the last of these steps, where it is a transient with inertia, asks of a support that masses cannot
/// do: to be elsewhere at once, or to have another speed, as a sine has that sets out from rest. The shorter
/// the time steps are, the larger are the forces there, and the works that they do are not known any better.
/// Empty: nothing.
std::string sudden_motion(const Case& one, std::span<const Step> steps);

} // namespace dielast::cases
