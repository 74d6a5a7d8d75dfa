// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

#include <optional>
#include <span>
#include <string>

namespace dielast::cases {

/// A support that a transient moves over no time.
struct SuddenJump {
  double time = 0; ///< s, from the beginning of the step
  double by = 0;   ///< m
};

/// The first jump that the wave along an axis of a support makes in the last of these steps, a transient: in
/// it, or at its beginning from where the steps before have left the support. No mass follows it: its kinetic
/// energy would grow without bound as time steps become short.
std::optional<SuddenJump> sudden_jump(const Support& support, std::size_t axis, std::span<const Step> steps);

/// What the last of these steps, where it is a transient with inertia, asks of a support that masses cannot
/// do: to have another speed at once, as a sine has that sets out from rest. The shorter the time steps are,
/// the larger are the forces there; what they do is the work of an impulse. Empty: nothing.
std::string sudden_motion(const Case& one, std::span<const Step> steps);
/// That of the last of the steps up to number `step` which has one.
std::string sudden_motion_so_far(const Case& one, std::span<const Step> steps, int step);

} // namespace dielast::cases
