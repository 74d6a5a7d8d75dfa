// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/part.hpp"
#include "fem/shells/shell_section.hpp"

namespace dielast::cases {

/// Of a part that is a shell.
fem::ShellMass shell_mass(const Part& part);

} // namespace dielast::cases
