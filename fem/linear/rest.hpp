// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"

#include <string>

namespace dielast::fem {

/// What goes on in a state that is not at rest, so that no small vibration goes about it: dashpots that flow,
/// by more than 1e-4 of their internal variables, which are of order one, until they rest at this shape, or
/// so that the device would move by more than 1e-3 of its displacements so far (and 1e-6 of its extent) or
/// a stiffness of it, in any direction, change by more than 2e-3 until they rest; current along a sheet or
/// through a circuit that will change voltages by more than 1e-4 of the largest; charge on an isolated
/// electrode that leaks, above 1e-4 of its scale; what has a mass, which would go on by more than 1e-4 of the
/// model's extent. Empty at rest.
std::string unrest(Equilibrium& equilibrium, const State& state);

/// Whether what has a mass would go on by more than that.
bool moves_on(Equilibrium& equilibrium, const State& state);

/// The tangent of what turns about several axes in space is a derivative of an energy only where no moment
/// acts about the axis across: there it has a skew part of half the moment (Simo & Vu-Quoc 1986), which
/// tangents leave out. That of dead moments, and of what holds one turn alone; the largest over the
/// stiffnesses that it couples (the root of their product), of a state at rest. Newton's method needs more
/// steps for it; small vibrations, stiffnesses and linear models know nothing of it.
double skew_stiffness(Equilibrium& equilibrium, const State& state);
constexpr double negligible_skew = 1e-4; ///< of it

/// The same state as its branches let it move slowly.
State relaxed(State state);

} // namespace dielast::fem
