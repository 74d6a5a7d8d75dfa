// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace dielast::cases {

/// Topics of `dielast info`: "overview", "materials", "laws", "devices", "quantities", "steps", "keys",
/// "units".
std::vector<std::string> topics();

/// Text of a topic, ending with a line break; throws std::invalid_argument with a "did you mean" for an
/// unknown one.
std::string describe(const std::string& topic);

} // namespace dielast::cases
