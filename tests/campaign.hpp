// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <string>

namespace dielast::test {

/// How many random cases a test draws: `usual`, or as many as the environment of its campaign says.
inline int drawn_cases(const char* variable, int usual) {
  const char* number = std::getenv(variable);
  return number ? std::stoi(number) : usual;
}

} // namespace dielast::test
