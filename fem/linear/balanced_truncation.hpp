// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/linear/state_space.hpp"

namespace dielast::fem {

/// Balanced truncation (Moore 1981; square-root form of Laub et al. 1987): the `order` states that are both
/// reached and seen best are kept; error at any frequency at most twice the sum of the singular values left
/// out, each output taken relative to its own size. The states are oriented (see orient_twins()): the first
/// output that sees a state prominently grows with it. Modes without any damping are taken to have a
/// millionth of the slowest rate. At most as many states as can be told from rounding. Throws
/// std::domain_error where the model is not stable.
StateSpace balanced_truncation(const StateSpace& model, int order);

} // namespace dielast::fem
