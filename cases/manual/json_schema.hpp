// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace dielast::cases {

/// JSON Schema (draft 2020-12) of the case language, for the completion of TOML in an editor.
std::string json_schema();

} // namespace dielast::cases
