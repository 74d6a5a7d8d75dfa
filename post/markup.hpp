// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace dielast::post {

/// Text made safe inside XML and HTML elements and quoted attributes; control characters that XML forbids are
/// dropped.
std::string escape_markup(std::string_view text);

} // namespace dielast::post
