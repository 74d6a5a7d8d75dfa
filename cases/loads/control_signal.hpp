// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/loads/signals.hpp"

namespace dielast::cases {

/// What a [[controller]] makes of the states that are reached: sampled, and held. `said`: of the load by
/// the case, to which it is added; null: nothing.
std::unique_ptr<Signal> control_signal(const Case& one, const Controller& controller, const Waveform* said);

} // namespace dielast::cases
