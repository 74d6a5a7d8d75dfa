#pragma once

#include "cases/case.hpp"

#include <span>
#include <string_view>

namespace dielast::cases {

/// A field whose extreme can be a quantity.
struct FieldName {
  std::string_view name;
  std::string_view unit; ///< SI
  std::string_view meaning;
};

std::span<const FieldName> field_names();

/// SI unit of a quantity's values; "1" for a pure number.
std::string_view unit_of(const Quantity& quantity);

} // namespace dielast::cases
