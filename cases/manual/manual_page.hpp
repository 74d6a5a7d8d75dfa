// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace dielast::cases {

/// docs/manual.md: every section, key, device, wave and field of the language, made from the schema table.
std::string manual_page();

} // namespace dielast::cases
