// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/loads/signals.hpp"

namespace dielast::cases {

/// What a [[controller]] makes of the states that are reached: sampled, and held. `drive`: what it is added
/// to; null: nothing. Throws CaseError where its quantity is none of a state.
std::unique_ptr<Signal> control_signal(const Case& one, const Controller& controller, const Waveform* drive);

} // namespace dielast::cases
