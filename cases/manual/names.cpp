// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/manual/names.hpp"

#include "cases/manual/entries.hpp"
#include "post/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

namespace dielast::cases {
namespace {

/// Something with a name, and how to explain it.
struct Entry {
  std::string name; ///< of a section or key its path
  std::function<std::string()> text;
  bool again = false; ///< of a part, and the same stands at the top of the file
};

std::string key_entry(const Section& section, const Key& key, const std::string& path) {
  std::string text = fmt::format("{}  {}\n", path.empty() ? "at the top of the file" : section.heading(path),
                                 section.meaning);
  if (!key.only_for.empty())
    text += fmt::format("  (for {} {})\n", section.selector, fmt::join(key.only_for, ", "));
  return text + key_text(key, section);
}

std::string word_entry(const Section& section, const Key& key, const Choice& choice,
                       const std::string& path) {
  std::string text = fmt::format("{}.{} = \"{}\"  {}\n", path, key.name, choice.word, choice.meaning);
  if (key.name == section.selector) text += keys_for(section, choice.word);
  return text;
}

void add_section(std::vector<Entry>& entries, const Section& section, const std::string& path) {
  constexpr std::string_view part = "part.";
  const bool again =
      path.starts_with(part) &&
      case_schema().find_section(path.substr(part.size(), path.find('.', part.size()) - part.size()));
  if (!path.empty())
    entries.push_back({path, [&section, path] { return section_text(section, path).substr(1); }, again});
  for (const Key& key : section.keys) {
    entries.push_back(
        {joined(path, key.name), [&section, &key, path] { return key_entry(section, key, path); }, again});
    for (const Choice& choice : key.choices)
      entries.push_back({choice.word,
                         [&section, &key, &choice, path] { return word_entry(section, key, choice, path); },
                         again});
  }
  for (const Section& inner : section.sections) add_section(entries, inner, joined(path, inner.name));
}

void add_device(std::vector<Entry>& entries, const Template& device) {
  entries.push_back({std::string(device.name), [&device] { return device_text(device); }});
  for (const PlaceName& place : device.places)
    entries.push_back({std::string(place.name), [&device, place] {
                         return fmt::format("place of [{}]: {}: {}\n", device.name, place.name,
                                            place.meaning);
                       }});
  for (const Node& quantity : standard_quantities(parse_tree(device.defaults, ""), &device))
    entries.push_back({quantity.find("name")->text, [&device, quantity] {
                         return fmt::format("standard quantity of [{}]: {}\n", device.name,
                                            text_of(quantity));
                       }});
}

void add_waves(std::vector<Entry>& entries) {
  static const Section waves = wave_section("V");
  for (const Key& key : waves.keys) {
    entries.push_back(
        {key.name, [&key] {
           return fmt::format(
               "of what goes with time, {{ wave = ... }}, here of a voltage{}\n{}",
               key.only_for.empty() ? "" : fmt::format("; for wave {}", fmt::join(key.only_for, ", ")),
               key_text(key, waves));
         }});
    for (const Choice& choice : key.choices)
      entries.push_back({choice.word, [&key, &choice] {
                           return fmt::format("{} = \"{}\"  {}; of a voltage with\n{}", key.name, choice.word,
                                              choice.meaning, keys_for(waves, choice.word));
                         }});
  }
}

const std::vector<Entry>& all_entries() {
  static const std::vector<Entry> entries = [] {
    std::vector<Entry> made;
    for (const Template& device : templates()) add_device(made, device);
    add_waves(made);
    for (const auto& named : materials::named_films())
      made.push_back({std::string(named.name), [&named] { return material_text(named); }});
    for (const auto& named : materials::named_solids())
      made.push_back({std::string(named.name), [&named] { return material_text(named); }});
    for (const post::Scalar& field : post::scalars())
      made.push_back({std::string(field.name), [field] {
                        return fmt::format("field {}: {} ({})\n", field.name, field.meaning, field.unit);
                      }});
    for (const Actuator& actuator : actuators())
      for (const std::string_view name : actuator.names)
        made.push_back({std::string(name), [&actuator] { return actuator_text(actuator); }});
    for (const Term& term : terms())
      made.push_back(
          {std::string(term.name), [term] { return fmt::format("{}: {}\n", term.name, term.meaning); }});
    add_section(made, case_schema(), "");
    return made;
  }();
  return entries;
}

std::string last_part(const std::string& path) { return path.substr(path.rfind('.') + 1); }

/// A device that has a section of its name.
bool has_device(const std::string& name) {
  return case_schema().find_section(name) &&
         std::ranges::any_of(templates(), [&](const Template& device) { return device.name == name; });
}

} // namespace

std::string explain_name(const std::string& name) {
  std::string text;
  std::set<std::string> told;
  const auto add = [&](const Entry& entry) {
    if (std::string one = entry.text(); told.insert(one).second) text += (text.empty() ? "" : "\n") + one;
  };
  if (has_device(name)) { // with its section
    for (const Entry& entry : all_entries())
      if (entry.name == name) {
        add(entry);
        return text;
      }
  }
  for (const Entry& entry : all_entries())
    if (entry.name == name && (!entry.again || name.find('.') != std::string::npos)) add(entry);
  if (name.find('.') == std::string::npos)
    for (const Entry& entry : all_entries())
      if (!entry.again && entry.name != name && last_part(entry.name) == name) add(entry);
  return text;
}

std::vector<std::string> explained_names() {
  std::set<std::string> names;
  for (const Entry& entry : all_entries()) {
    names.insert(entry.name);
    names.insert(last_part(entry.name));
  }
  return {names.begin(), names.end()};
}

} // namespace dielast::cases
