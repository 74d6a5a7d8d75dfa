// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace dielast::cases {

/// A warning as the terminal shows it: what is of no line of a file has the word in front, too.
inline std::string as_warning(const std::string& text) {
  constexpr const char* word = "warning: ";
  return text.find(word) == std::string::npos ? word + text : text;
}

} // namespace dielast::cases
