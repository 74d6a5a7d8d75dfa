// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/parts/part_kinds.hpp"

#include "cases/case/quantity_kind.hpp"
#include "cases/language/schema.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {

std::span<const PartKind> part_kinds() {
  static const std::vector<PartKind> kinds{rod_kind(),   membrane_kind(), shell_kind(),
                                           solid_kind(), beam_kind(),     cable_kind()};
  return kinds;
}

const PartKind* kind_of(const Part& part) {
  const auto found = std::ranges::find_if(part_kinds(), [&](const PartKind& kind) { return kind.is(part); });
  return found == part_kinds().end() ? nullptr : &*found;
}

bool is_one_element(const Part& part) {
  const PartKind* kind = kind_of(part);
  return kind && kind->one_element && std::holds_alternative<Line>(part.geometry);
}

const Node& WrittenPart::top() const {
  return part.name.empty() ? tree : *tree.find("part")->find(part.name);
}

std::string WrittenPart::path(const std::string& key) const {
  if (part.name.empty()) return key;
  return fmt::format("part.{}{}{}", part.name, key.empty() ? "" : ".", key);
}

void WrittenPart::report(const std::string& table, const std::string& message) const {
  const Node* blamed = top().find(table);
  reader.report(blamed ? blamed->key_source : top().source, path(blamed ? table : ""), message);
}

void WrittenPart::report_film(const char* key, const std::string& message) const {
  const Node& film = *top().find("film");
  const Node* there = film.find(key);
  const bool written = there && there->source.is_written(); // otherwise the geometry has brought it
  const Key* known = there ? nullptr : case_schema().find_section("film")->find_key(key, "");
  const std::string value = there ? text_of(*there) : known && known->fallback ? *known->fallback : "";
  reader.report(written ? there->source : film.source, path(fmt::format("film.{}", key)),
                written         ? fmt::format("found {}: {}", value, message)
                : value.empty() ? message
                                : fmt::format("{} by default: {}", value, message));
}

void WrittenPart::refuse_quantities(bool QuantityKind::*has, const char* kind) const {
  const Node* list = tree.find("quantity");
  int number = 0; // of the user's own
  for (std::size_t q = 0; q < one.quantities.size(); ++q) {
    const Quantity& quantity = one.quantities[q];
    const Node* own = list && q < list->items.size() ? &list->items[q] : nullptr;
    const Node* word = own ? own->find("kind") : nullptr;
    const bool is_written = word && word->source.is_written();
    number += is_written;
    if (quantity.kind->*has) continue;
    const std::string have =
        fmt::format("of films that are membranes{}{}", quantity.kind->of_shells ? " or shells" : "",
                    quantity.kind->of_solids ? " or solids" : "");
    if (is_written)
      reader.report(word->source, fmt::format("quantity[{}].kind", number),
                    fmt::format("found \"{}\": {}, and this one is a {}{}", quantity.kind->word, have, kind,
                                quantity.kind->word == "stretch" ? "; ask for \"elongation\"" : ""));
    else
      report_film("section", fmt::format("quantity \"{}\" is {}", quantity.name, have));
  }
}

const Part* WrittenPart::meshed() const { return part.has_mesh() ? &part : one.unnamed(); }

bool has_axes(const Part& part) {
  const auto flows_along_axes = [](const materials::Branch& branch) {
    return branch.dashpot == materials::Dashpot::nominal;
  };
  const auto in = [&](const auto& film) {
    return std::ranges::any_of(film.material.branches, flows_along_axes);
  };
  return in(*part.film) || std::ranges::any_of(part.film->further_layers, in);
}

bool knows_x_from_y(const Part& part) {
  const auto unlike = [](const auto& film) { return film.prestretch[0] != film.prestretch[1]; };
  return part.film &&
         (unlike(*part.film) || std::ranges::any_of(part.film->further_layers, unlike) || has_axes(part));
}

double cover_of(const Part& part) {
  const auto* strip = std::get_if<Strip>(&part.geometry);
  return strip ? strip->cover_thickness : 0;
}

} // namespace dielast::cases
