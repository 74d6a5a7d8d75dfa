// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/schema.hpp"
#include "cases/text/units.hpp"
#include "materials/laws/elastic_law.hpp"

#include <cmath>

namespace dielast::cases {

/// Adds one key for each row of S::parameters. `part(object)` returns a pointer to the S in the object, null
/// when it holds another law.
template<class T, class S, class Part>
void add_parameter_keys(std::vector<Key>& keys, Part part, const std::vector<std::string>& only_for = {}) {
  constexpr std::size_t longest_list = 20;
  const auto bound = [part](auto member) {
    return Binding{[part, member](void* object, const Value& value) {
                     assign(part(*static_cast<T*>(object))->*member, value);
                   },
                   [part, member](const void* object) {
                     const S* source = part(*static_cast<const T*>(object));
                     return source ? value_of(source->*member) : std::nullopt;
                   }};
  };
  for (const auto& row : S::parameters) {
    Key made = measure(std::string(row.name), row.unit, row.list ? bound(row.list) : bound(row.number),
                       std::string(row.meaning));
    if (std::isfinite(row.above)) made = std::move(made).above(row.above);
    if (row.below < made.range.high) made = std::move(made).below(row.below);
    if (row.fallback) made = std::move(made).otherwise(format_measure(*row.fallback, row.unit));
    if (row.list) made = std::move(made).values(1, longest_list);
    keys.push_back(std::move(made).only(only_for));
  }
}

/// Adds the key "law" and the keys of every law of the registry; `law(object)` returns a reference to the
/// ElasticLaw in the object.
template<class T, class Law>
void add_law_keys(std::vector<Key>& keys, Law law, std::string meaning) {
  using materials::ElasticLaw;
  const Binding choose{
      [law](void* object, const Value& value) {
        ElasticLaw& chosen = law(*static_cast<T*>(object));
        const auto wanted = static_cast<std::size_t>(value.at(0).number);
        // a law that a named material has brought keeps its parameters
        if (chosen.index() == wanted) return;
        [&]<std::size_t... I>(std::index_sequence<I...>) {
          ((I == wanted ? void(chosen.emplace<I>()) : void()), ...);
        }
        (std::make_index_sequence<std::variant_size_v<ElasticLaw>>());
      },
      [law](const void* object) { return value_of(law(*static_cast<const T*>(object)).index()); }};
  const auto add = [&]<std::size_t... I>(std::index_sequence<I...>) {
    const std::vector<Choice> laws{{std::string(std::variant_alternative_t<I, ElasticLaw>::name),
                                    std::string(std::variant_alternative_t<I, ElasticLaw>::formula), I}...};
    keys.push_back(word("law", laws, choose, std::move(meaning)).otherwise(laws.front().word));
    (add_parameter_keys<T, std::variant_alternative_t<I, ElasticLaw>>(
         keys, [law](auto& object) { return std::get_if<I>(&law(object)); }, {laws[I].word}),
     ...);
  };
  add(std::make_index_sequence<std::variant_size_v<ElasticLaw>>());
}

} // namespace dielast::cases
