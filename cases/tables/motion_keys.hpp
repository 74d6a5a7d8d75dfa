// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/schema.hpp"

namespace dielast::cases {

/// A key whose words are the indices at which an array of flags is set.
template<class T, class Flags>
Binding flags(Flags T::*member) {
  return {[member](void* object, const Value& value) {
            auto& set = static_cast<T*>(object)->*member;
            set = {};
            for (const Scalar& word : value) set.at(static_cast<std::size_t>(word.number)) = true;
          },
          [member](const void* object) -> std::optional<Value> {
            Value value;
            const auto& set = static_cast<const T*>(object)->*member;
            for (std::size_t i = 0; i < set.size(); ++i)
              if (set[i]) value.push_back({static_cast<double>(i), ""});
            return value.empty() ? std::nullopt : std::optional(value);
          }};
}

inline std::string each_once(const Value& words) {
  for (std::size_t i = 1; i < words.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (words[i].number == words[k].number) return "found a direction twice";
  return "";
}

inline const std::vector<Choice> motions{
    {"x", "along x", 0},      {"y", "along y", 1},      {"z", "along z, normal to flat film", 2},
    {"turn_x", "about x", 3}, {"turn_y", "about y", 4}, {"turn_z", "about z, the normal of flat film", 5}};

} // namespace dielast::cases
