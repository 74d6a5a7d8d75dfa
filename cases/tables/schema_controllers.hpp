// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/schema.hpp"

namespace dielast::cases {

Section controller_section();

} // namespace dielast::cases
