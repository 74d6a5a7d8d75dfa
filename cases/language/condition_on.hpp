// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/schema.hpp"

#include <utility>

namespace dielast::cases {

/// A condition on the case alone.
template<class Rule>
Condition on_case(std::string needs, Rule rule) {
  return {std::move(needs), [rule](const Case& one, const void*) { return rule(one); }};
}

/// A condition on the object of the key's section, too.
template<class T, class Rule>
Condition on(std::string needs, Rule rule) {
  return {std::move(needs),
          [rule](const Case& one, const void* object) { return rule(one, *static_cast<const T*>(object)); }};
}

} // namespace dielast::cases
