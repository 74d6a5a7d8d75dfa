#pragma once

#include "cases/schema.hpp"
#include "cases/units.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace dielast::cases {

/// Adds one key for each row of S::parameters. S holds one double per row, in the order of its table (the
/// compiler checks the number); `part(object)` returns a pointer to the S in the object, null when it holds
/// another law.
template<class T, class S, class Part>
void add_parameter_keys(std::vector<Key>& keys, Part part, const std::vector<std::string>& only_for = {}) {
  using Values = std::array<double, S::parameters.size()>;
  static_assert(sizeof(S) == sizeof(Values), "a row of the table for each member, and the other way round");
  for (std::size_t i = 0; i < S::parameters.size(); ++i) {
    const auto& row = S::parameters[i];
    const Binding binding{[part, i](void* object, const Value& value) {
                            S& target = *part(*static_cast<T*>(object));
                            Values values = std::bit_cast<Values>(target);
                            values[i] = value.at(0).number;
                            target = std::bit_cast<S>(values);
                          },
                          [part, i](const void* object) -> std::optional<Value> {
                            const S* source = part(*static_cast<const T*>(object));
                            return source ? value_of(std::bit_cast<Values>(*source)[i]) : std::nullopt;
                          }};
    Key made = measure(std::string(row.name), row.unit, binding, std::string(row.meaning)).above(row.above);
    if (row.below < made.range.high) made = std::move(made).below(row.below);
    if (row.fallback) made = std::move(made).otherwise(format_measure(*row.fallback, row.unit));
    keys.push_back(std::move(made).only(only_for));
  }
}

} // namespace dielast::cases
