// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/schema.hpp"

#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace dielast::cases {
namespace {

Key key(Type type, std::string name, Binding binding, std::string meaning) {
  Key made;
  made.type = type;
  made.name = std::move(name);
  made.binding = std::move(binding);
  made.meaning = std::move(meaning);
  return made;
}

} // namespace

bool Key::applies_to(const std::string& selected) const {
  return only_for.empty() || std::find(only_for.begin(), only_for.end(), selected) != only_for.end();
}

const std::string& Key::word_of(const Scalar& value) const {
  if (!value.text.empty()) return value.text;
  const auto found = std::ranges::find(choices, std::optional(value.number), &Choice::value);
  if (found == choices.end()) throw std::logic_error("key " + name + ": no word stands for the value");
  return found->word;
}

Key Key::above(double low) && {
  range.low = low, range.low_open = true;
  return std::move(*this);
}
Key Key::at_least(double low) && {
  range.low = low, range.low_open = false;
  return std::move(*this);
}
Key Key::below(double high) && {
  range.high = high, range.high_open = true;
  return std::move(*this);
}
Key Key::at_most(double high) && {
  range.high = high, range.high_open = false;
  return std::move(*this);
}
Key Key::because(std::string reason) && {
  hint = std::move(reason);
  return std::move(*this);
}
Key Key::otherwise(std::string value) && {
  fallback = std::move(value);
  return std::move(*this);
}
Key Key::otherwise_as(std::string other_key) && {
  fallback_key = std::move(other_key);
  return std::move(*this);
}
Key Key::optional() && {
  required = false;
  return std::move(*this);
}
Key Key::values(std::size_t fewest, std::size_t largest) && {
  least = fewest, most = largest;
  return std::move(*this);
}
Key Key::or_one_for_all() && {
  spreads = true;
  return std::move(*this);
}
Key Key::of_stretch() && {
  is_stretch = true;
  return std::move(*this);
}
Key Key::only(std::vector<std::string> selected) && {
  only_for = std::move(selected);
  return std::move(*this);
}
Key Key::replacing(std::string other_key) && {
  instead_of = std::move(other_key), required = false;
  return std::move(*this);
}
Key Key::distinct() && {
  unique = true;
  type = Type::name;
  return std::move(*this);
}
Key Key::refers_to(Reference what) && {
  refers = what;
  return std::move(*this);
}
Key Key::only_with(Condition condition) && {
  acts = std::move(condition);
  return std::move(*this);
}
Key Key::checked(std::function<std::string(const Value&)> rule) && {
  check = std::move(rule);
  return std::move(*this);
}

namespace {

bool say_the_same(const Key& one, const Key& other) {
  return one.name == other.name && one.meaning == other.meaning && one.required == other.required &&
         one.fallback == other.fallback &&
         std::ranges::equal(one.choices, other.choices, {}, &Choice::word, &Choice::word);
}

} // namespace

void add_keys_of(const std::string& selected, std::vector<Key> more, std::vector<Key>& keys) {
  for (Key& key : more) {
    const auto same = std::ranges::find_if(keys, [&](const Key& known) { return say_the_same(known, key); });
    if (same != keys.end()) {
      same->only_for.push_back(selected);
      continue;
    }
    const auto last =
        std::find_if(keys.rbegin(), keys.rend(), [&](const Key& known) { return known.name == key.name; });
    key.only_for = {selected};
    keys.insert(last == keys.rend() ? keys.end() : last.base(), std::move(key));
  }
}

std::string Section::heading(const std::string& path) const {
  return shape == Shape::list ? fmt::format("[[{}]]", path) : fmt::format("[{}]", path);
}

std::string Section::selected_in(const void* object) const {
  const Key* key = find_key(selector, "");
  const auto value = key ? key->binding.get(object) : std::nullopt;
  return value ? key->word_of(value->at(0)) : "";
}

const Section* Section::find_section(std::string_view wanted) const {
  const auto found =
      std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.name == wanted; });
  return found == sections.end() ? nullptr : &*found;
}

const Key* Section::find_key(std::string_view wanted, const std::string& selected) const {
  const Key* other = nullptr;
  for (const Key& candidate : keys) {
    if (candidate.name != wanted) continue;
    if (candidate.applies_to(selected)) return &candidate;
    other = &candidate;
  }
  return other;
}

bool Section::has_geometries() const {
  return std::ranges::any_of(sections, [](const Section& s) { return s.presence == Presence::geometry; });
}

std::vector<std::string> Section::names_for(const std::string& selected) const {
  std::vector<std::string> known;
  for (const Key& candidate : keys)
    if (candidate.applies_to(selected)) known.push_back(candidate.name);
  for (const Section& section : sections) known.push_back(section.name);
  return known;
}

Section list_section(std::string name, std::string meaning, Access access) {
  Section section;
  section.name = std::move(name);
  section.meaning = std::move(meaning);
  section.shape = Section::Shape::list;
  section.presence = Section::Presence::list;
  section.access = std::move(access);
  return section;
}

Access same_object() {
  return {[](void* parent, const std::string&) { return parent; },
          [](const void* parent) {
            return std::vector<Access::Entry>{{"", parent}};
          }};
}

Key measure(std::string name, std::string_view unit, Binding binding, std::string meaning) {
  Key made = key(Type::measure, std::move(name), std::move(binding), std::move(meaning));
  made.unit = unit;
  if (!unit.empty()) made.range.high = dimension(unit).largest, made.range.low = -made.range.high;
  return made;
}

Key number(std::string name, Binding binding, std::string meaning) {
  return measure(std::move(name), "1", std::move(binding), std::move(meaning));
}

Key wave(std::string name, std::string_view unit, Binding binding, std::string meaning) {
  Key made = measure(std::move(name), unit, std::move(binding), std::move(meaning));
  made.type = Type::wave;
  return made;
}

Key integer(std::string name, Binding binding, std::string meaning) {
  return key(Type::integer, std::move(name), std::move(binding), std::move(meaning));
}

Key flag(std::string name, Binding binding, std::string meaning) {
  return key(Type::flag, std::move(name), std::move(binding), std::move(meaning));
}

Key word(std::string name, std::vector<Choice> choices, Binding binding, std::string meaning) {
  Key made = key(Type::word, std::move(name), std::move(binding), std::move(meaning));
  made.choices = std::move(choices);
  return made;
}

Key text(std::string name, Binding binding, std::string meaning) {
  return key(Type::text, std::move(name), std::move(binding), std::move(meaning));
}

const Section& case_schema() {
  static const Section schema = [] {
    Section root;
    root.meaning = "a dielectric elastomer device and what happens to it";
    root.access = same_object();
    root.keys = {
        text("title", to(&Case::title), "title of the report").optional(),
        word("model",
             {{"planar", "in-plane displacements", fem::Dimension::planar},
              {"3d", "displacements in space", fem::Dimension::spatial},
              {"axisymmetric",
               "what is of revolution about z, by its meridian: it stays round, as do its instabilities and "
               "modes",
               fem::Dimension::axisymmetric}},
             to(&Case::dimension),
             "how the device can move; with [plate], [chamber] or [balloon] the default is "
             "\"axisymmetric\"")
            .otherwise("planar"),
        text("case", {}, "of a study file: the case file that it varies").optional().only({"study"}),
    };
    for (Section& section : unnamed_part_sections()) root.sections.push_back(std::move(section));
    for (Section& section : part_sections()) root.sections.push_back(std::move(section));
    for (Section& section : action_sections()) root.sections.push_back(std::move(section));
    root.sections.push_back(step_section());
    for (Section& section : result_sections()) root.sections.push_back(std::move(section));
    for (Section& section : fit_sections()) root.sections.push_back(std::move(section));
    root.sections.push_back(identify_section());
    root.sections.push_back(rational_section());
    return root;
  }();
  return schema;
}

} // namespace dielast::cases
