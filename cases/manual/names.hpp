// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace dielast::cases {

/// What the language means by a name: a device, a named material, a section or a key (by its path or by its
/// last part), a word that stands for a law, a step, a quantity and the like, a field, a term. Empty:
/// nothing.
std::string explain_name(const std::string& name);

/// Every name that explain_name() knows.
std::vector<std::string> explained_names();

} // namespace dielast::cases
