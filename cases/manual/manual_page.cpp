// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/manual/manual_page.hpp"

#include "cases/manual/entries.hpp"
#include "cases/text/units.hpp"
#include "post/fields.hpp"

#include <fmt/format.h>

namespace dielast::cases {
namespace {

/// A bar would end the cell of a table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
  return escaped;
}

std::string row(const Key& key, const Section& section) {
  std::string meaning = key.meaning;
  if (key.type == Type::word)
    for (const Choice& choice : key.choices)
      if (!choice.meaning.empty()) meaning += fmt::format("<br>`{}`: {}", choice.word, choice.meaning);
  return fmt::format("| `{}` | {} | {} |\n", key.name, cell(meaning), cell(rules_text(key, section)));
}

constexpr const char* head = "| key | meaning | what may be written |\n|---|---|---|\n";

/// The keys of a section; those that one value of its selector has stand under it.
std::string keys_of(const Section& section) {
  std::string all, text;
  for (const Key& key : section.keys)
    if (key.only_for.empty()) all += row(key, section);
  if (!all.empty()) text += head + all + "\n";
  std::vector<std::vector<std::string>> groups;
  for (const Key& key : section.keys)
    if (!key.only_for.empty() && std::ranges::find(groups, key.only_for) == groups.end())
      groups.push_back(key.only_for);
  for (const auto& group : groups) {
    text += fmt::format("{} `{}`:\n\n{}", section.selector.empty() ? "Only in a" : "With " + section.selector,
                        fmt::join(group, "`, `"), head);
    for (const Key& key : section.keys)
      if (key.only_for == group) text += row(key, section);
    text += "\n";
  }
  return text;
}

std::string section_of(const Section& section, const std::string& path) {
  std::string text = fmt::format("### `{}`\n\n{}{}.\n\n", section.heading(path), section.meaning,
                                 section.acts.needs.empty() ? "" : "; acts only with " + section.acts.needs) +
                     keys_of(section);
  for (const Section& inner : section.sections) text += section_of(inner, path + "." + inner.name);
  return text;
}

std::string device_of(const Template& device) {
  const std::string name(device.name);
  std::string text =
      fmt::format("### {}{}\n\n{}.\n\n", name,
                  device.with.empty() ? "" : fmt::format(" with [{}]", device.with), device.meaning);
  if (!device.places.empty()) text += "| place | meaning |\n|---|---|\n";
  for (const PlaceName& place : device.places)
    text += fmt::format("| `{}` | {} |\n", place.name, cell(place.meaning));
  text += "\nUnless the case has its own:\n\n```toml\n";
  const Node defaults = parse_tree(device.defaults, "");
  text += defaults_text(defaults, "");
  text += "```\n\nStandard quantities:";
  for (const Node& quantity : standard_quantities(defaults, &device))
    text += fmt::format(" `{}`,", quantity.find("name")->text);
  text.back() = '.';
  return text + "\n\n";
}

} // namespace

std::string manual_page() {
  const Section& schema = case_schema();
  std::string text =
      "# Manual of the case language\n\nMade by `dielast info manual.md` from the table that the program "
      "itself "
      "reads by. On the terminal: `dielast info NAME` for any section, key, device, law or word. Laws and "
      "named "
      "materials are in [materials.md](materials.md), commands in `dielast man`; a tutorial is "
      "[guide.md](guide.md).\n\n"
      "A case file is TOML. Quantities are texts with units, `\"0.8 mm\"`; a bare number is in SI units. "
      "`[name]` is a "
      "section, `[[name]]` one of a list.\n\n## At the top of the file\n\n" +
      keys_of(schema) + "## Sections\n\n";
  for (const Section& section : schema.sections) text += section_of(section, section.name);
  text += "## Devices\n\nWhat a geometry brings: places that the other sections may name, and sections that "
          "stand "
          "unless the case has its own.\n\n";
  for (const Template& device : templates()) text += device_of(device);
  text += "## Actuators\n\nDevices of the literature, and how a case says them.\n\n| device | case | example "
          "in the "
          "gallery |\n|---|---|---|\n";
  for (const Actuator& actuator : actuators())
    text += fmt::format("| {} | {} | {} |\n", fmt::join(actuator.names, ", "), cell(actuator.how),
                        actuator.example);
  text +=
      "\n## Waves\n\nFor every quantity that may change with time, here of a voltage: `voltage = { wave = "
      "\"sine\", amplitude = \"4 kV\", frequency = \"0.5 Hz\" }`. Its time counts from the start of each "
      "step. More in `dielast info waves`.\n\n" +
      keys_of(wave_section("V")) + "## Fields\n\n| field | unit | meaning |\n|---|---|---|\n";
  for (const post::Scalar& field : post::scalars())
    text += fmt::format("| `{}` | {} | {} |\n", field.name, field.unit, cell(field.meaning));
  text += "\n## Units\n\n| quantity | usual units |\n|---|---|\n";
  for (const Dimension& one : dimensions()) text += fmt::format("| {} | {} |\n", one.noun, one.usual);
  text += "\n## Terms\n\n";
  for (const Term& term : terms()) text += fmt::format("- **{}**: {}.\n", term.name, term.meaning);
  return text;
}

} // namespace dielast::cases
