// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace dielast::cases {

/// docs/materials.md, made from the parameter tables of the laws, the dielectric and the named materials.
std::string materials_page();

} // namespace dielast::cases
