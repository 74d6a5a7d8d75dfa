// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// A device as the literature calls it, and how a case says it.
struct Actuator {
  std::vector<std::string_view> names;
  std::string_view how, example; ///< a file of the gallery; empty: none
};
std::span<const Actuator> actuators();

} // namespace dielast::cases
