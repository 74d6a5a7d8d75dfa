// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/manual/describe.hpp"

#include "cases/case/quantities.hpp"
#include "cases/language/convert.hpp"
#include "cases/manual/materials_page.hpp"
#include "cases/tables/templates.hpp"
#include "cases/text/units.hpp"
#include "materials/catalog.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

namespace dielast::cases {
namespace {

/// Two lines: the name with its meaning, then what may be written, range and default.
std::string key_text(const Key& key) {
  std::string rules = expectation(key, key.unit);
  const std::string range = range_text(key, key.unit.empty() ? "" : std::string(dimension(key.unit).shown));
  if (!range.empty()) rules += ", " + range;
  if (key.fallback)
    rules += "; default " + *key.fallback;
  else if (!key.fallback_key.empty())
    rules += "; default: its " + key.fallback_key;
  else
    rules += key.required ? "; required" : "; optional";
  if (!key.acts.needs.empty()) rules += "; acts only with " + key.acts.needs;
  std::string text = fmt::format("  {:<22}{}\n{:24}{}\n", key.name, key.meaning, "", rules);
  if (key.type == Type::word)
    for (const Choice& choice : key.choices)
      if (!choice.meaning.empty()) text += fmt::format("{:26}{}: {}\n", "", choice.word, choice.meaning);
  return text;
}

std::string section_text(const Section& section, const std::string& path) {
  std::string text = path.empty() ? "at the top of the file\n"
                                  : fmt::format("\n{}  {}\n", section.heading(path), section.meaning);
  if (!section.acts.needs.empty()) text += fmt::format("  (acts only with {})\n", section.acts.needs);
  for (const Key& key : section.keys) {
    if (key.only_for.empty()) {
      text += key_text(key);
      continue;
    }
    text += fmt::format("  ({} {})\n", section.selector.empty() ? "only in a" : "for " + section.selector,
                        fmt::join(key.only_for, ", ")) +
            key_text(key);
  }
  for (const Section& inner : section.sections)
    text += section_text(inner, path.empty() ? inner.name : path + "." + inner.name);
  return text;
}

/// The keys that only one value of the selector has.
std::string keys_for(const Section& section, const std::string& selected) {
  std::string text;
  for (const Key& key : section.keys)
    if (!key.only_for.empty() && key.applies_to(selected)) text += key_text(key);
  return text;
}

/// One entry per choice of a section's selector, with the keys that it has.
std::string choices_text(const Section& section) {
  std::string text;
  for (const Choice& choice : section.find_key(section.selector, "")->choices)
    text += fmt::format("\n{}: {}\n", choice.word, choice.meaning) + keys_for(section, choice.word);
  text += "\nall of them\n";
  for (const Key& key : section.keys)
    if (key.only_for.empty() && key.name != section.selector) text += key_text(key);
  return text;
}

/// The values of a material's keys.
std::string values_text(const Section& section, const void* object) {
  const std::string selected = section.selected_in(object);
  std::string text;
  for (const Key& key : section.keys)
    if (key.applies_to(selected))
      if (const auto value = key.binding.get(object))
        text += fmt::format("    {:<18}{}\n", key.name, toml_text(key, *value));
  for (const Section& inner : section.sections)
    for (const Access::Entry& entry : inner.access.entries(object))
      text += fmt::format("    {}\n", inner.name) + values_text(inner, entry.object);
  return text;
}

std::string overview() {
  std::string text =
      "A case file is TOML. Quantities are texts with units: \"0.8 mm\"; a bare number is SI.\n"
      "Sections:\n";
  for (const Section& section : case_schema().sections)
    text += fmt::format("  {:<14}{}\n", section.heading(section.name), section.meaning);
  text += fmt::format("Topics: {}\n", fmt::join(topics(), ", "));
  return text;
}

std::string materials_text() {
  const Section& film_keys = *case_schema().find_section("film")->find_section("material");
  const Section& wall_keys = *case_schema().find_section("honeycomb")->find_section("wall_material");
  std::string text = "Film materials (film.material)\n";
  for (const auto& named : materials::named_films()) {
    Film film;
    film.material = named.material;
    text += fmt::format("  \"{}\"\n    from: {}\n    for: {}\n{}", named.name, named.source, named.validity,
                        values_text(film_keys, &film));
  }
  text += "Wall materials (honeycomb.wall_material)\n";
  for (const auto& named : materials::named_solids()) {
    Honeycomb honeycomb;
    honeycomb.wall.material = named.solid;
    text += fmt::format("  \"{}\"\n    from: {}\n    for: {}\n{}", named.name, named.source, named.validity,
                        values_text(wall_keys, &honeycomb));
  }
  return text;
}

std::string laws_text() {
  const Section& material = *case_schema().find_section("film")->find_section("material");
  const Section& branch = *material.find_section("branch");
  std::string text = "Laws of the film (film.material.law) and of its branches\n" + choices_text(material) +
                     fmt::format("\n{}  {}, with the keys of its law and\n",
                                 branch.heading("film.material.branch"), branch.meaning);
  for (const Key& key : branch.keys)
    if (key.only_for.empty()) text += key_text(key);
  return text;
}

std::string devices_text() {
  const Section& mesh = *case_schema().find_section("mesh");
  std::string text;
  for (const Template& device : templates()) {
    const std::string name(device.name);
    const Section* section = case_schema().find_section(name);
    const std::string with = device.with.empty() ? "" : fmt::format(" with [{}]", device.with);
    text += fmt::format("{}{}: {}\n", name, with, device.meaning);
    if (section) text += section_text(*section, name);
    text += "\n[mesh]\n";
    for (const Key& key : mesh.keys)
      if (key.applies_to(name)) text += key_text(key);
    if (!device.places.empty()) text += "\nplaces\n";
    for (const PlaceName& place : device.places)
      text += fmt::format("  {:<22}{}\n", place.name, place.meaning);
    text += "\nunless the case has its own\n";
    const Node defaults = parse_tree(device.defaults, "");
    for (std::size_t i = 0; i < defaults.items.size(); ++i)
      text += fmt::format("  {} = {}\n", defaults.keys[i], text_of(defaults.items[i]));
    text += "\nstandard quantities\n";
    for (const Node& quantity : standard_quantities(defaults, &device))
      text += fmt::format("  {}\n", text_of(quantity));
    text += "\n";
  }
  return text;
}

std::string quantities_text() {
  std::string text =
      "Kinds of [[quantity]]\n" + choices_text(*case_schema().find_section("quantity")) + "\nfields\n";
  for (const post::Scalar& field : post::scalars())
    text += fmt::format("  {:<32}{} ({})\n", field.name, field.meaning, field.unit);
  return text;
}

std::string steps_text() { return "Kinds of [[step]]\n" + choices_text(*case_schema().find_section("step")); }

std::string waves_text() {
  return "Forms of waves, for every quantity that a case lets change with time: voltages, charges, forces,\n"
         "displacements, stretches and stresses; here of a voltage, such as\n"
         "  voltage = { wave = \"sine\", amplitude = \"4 kV\", frequency = \"0.5 Hz\" }\n"
         "Steps of kind \"transient\" follow them; t counts from the start of the step. Ramps lead to their "
         "value\n"
         "at t = 0; where a wave jumps there (a step or square at 0 s, a trapezoid without rise), to the "
         "value\n"
         "before the jump, `from`: the transient that follows begins with the jump. A CSV file has no jumps: "
         "a\n"
         "ramp leads to its value at 0 s. The column of a CSV file ends in its unit, as in voltage_kV.\n" +
         choices_text(wave_section("V"));
}

std::string fit_text() {
  std::string text =
      "`dielast fit FILE` fits a material to measured tests: the [film.material] of the file is the\n"
      "start. Parameters are called as in [film.material], those of branches as in\n"
      "\"branch[1].relaxation_time\"; items of lists are counted from 1.\n";
  for (const char* name : {"fit", "test"}) text += section_text(*case_schema().find_section(name), name);
  return text;
}

std::string keys_text() { return section_text(case_schema(), ""); }

std::string units_text() {
  std::string text = "Quantities and usual units (every unit of udunits is allowed)\n";
  for (const Dimension& one : dimensions()) text += fmt::format("  {:<24}{}\n", one.noun, one.usual);
  return text;
}

struct Topic {
  const char* name;
  std::string (*text)();
};

constexpr std::array all_topics{
    Topic{"overview", overview}, Topic{"materials", materials_text}, Topic{"materials.md", materials_page},
    Topic{"laws", laws_text},    Topic{"devices", devices_text},     Topic{"quantities", quantities_text},
    Topic{"steps", steps_text},  Topic{"waves", waves_text},         Topic{"fit", fit_text},
    Topic{"keys", keys_text},    Topic{"units", units_text},
};

} // namespace

std::vector<std::string> topics() {
  std::vector<std::string> names;
  for (const Topic& topic : all_topics) names.emplace_back(topic.name);
  return names;
}

std::string describe(const std::string& topic) {
  for (const Topic& candidate : all_topics)
    if (topic == candidate.name) return candidate.text();
  throw std::invalid_argument(
      fmt::format("no topic \"{}\", allowed {}{}", topic, listed(topics()), did_you_mean(topic, topics())));
}

} // namespace dielast::cases
