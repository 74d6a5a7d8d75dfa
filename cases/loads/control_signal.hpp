// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/loads/signals.hpp"

namespace dielast::cases {

/// What a [[controller]] makes of the states that are reached: sampled, and held, in addition to
/// what the case says of the load.
std::unique_ptr<Signal> control_signal(const Case& one, const Controller& controller);

} // namespace dielast::cases
