// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// Which supports of the case hold in this step (its number). An analysis is about the state as the step
/// before has left it: no support lets go or takes hold in it.
std::vector<char> holding_in(const Case& one, const std::vector<Step>& steps, int step);

/// Whether nothing but pins against rigid motion holds the device while these supports do. They bear nothing
/// where all forces balance: no weight, and inertia of motions alone that leave the pins at rest by symmetry.
bool is_free(const Case& one, const std::vector<char>& holding);

/// What to say of a free device whose pins would have to bear something, such as "weight".
std::string borne_by_pins(std::string_view what);

} // namespace dielast::cases
