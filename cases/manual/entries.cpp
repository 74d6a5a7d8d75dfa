// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/manual/entries.hpp"

#include "cases/language/convert.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <array>

namespace dielast::cases {
namespace {

/// Without the round-off of a product of two parameters, which nobody has written.
std::string shown_value(const Key& key, Value value) {
  for (Scalar& one : value) one.number = std::strtod(fmt::format("{:.12g}", one.number).c_str(), nullptr);
  return toml_text(key, value);
}

/// The values of a material's keys.
std::string values_text(const Section& section, const void* object) {
  const std::string selected = section.selected_in(object);
  std::string text;
  for (const Key& key : section.keys)
    if (key.applies_to(selected))
      if (const auto value = key.binding.get(object))
        text += fmt::format("    {:<23} {}\n", key.name, shown_value(key, *value));
  for (const Section& inner : section.sections)
    for (const Access::Entry& entry : inner.access.entries(object))
      text += fmt::format("    {}\n", inner.name) + values_text(inner, entry.object);
  return text;
}

} // namespace

std::span<const Term> terms() {
  static constexpr std::array all{
      Term{"limit point",
           "a state on a path of equilibria at which the load turns: no equilibrium is near for "
           "a larger load (pull-in, snap-through), and the stiffness along the path vanishes"},
      Term{"bifurcation",
           "a state at which another path of equilibria crosses: a mode on which the load does "
           "no work loses its stiffness (buckling, a film that leaves its plane)"},
      Term{"branches meet",
           "a bifurcation that the device reaches along the branch, not along the path that it "
           "left there: nothing is lost, and the path goes on (a bow that opens until it is "
           "straight)"},
      Term{"critical point", "a limit point or a bifurcation: the tangent is singular, and beyond it a "
                             "device is stable on another path or not at all"},
      Term{"arclength", "how a path is followed past a limit point: each increment goes a given length along "
                        "the path in displacements and load together, so that the load may fall "
                        "(on_instability = \"follow\")"},
      Term{"at rest", "what vibrations and stiffnesses need of a state: nothing has a speed, no charge "
                      "flows, and dashpots "
                      "either are done (1e-4 of their strains), or what is left neither moves the device by "
                      "more than 1e-3 "
                      "of its largest displacement (1e-6 of its size), nor changes its lowest stiffness by "
                      "more than 2e-3"},
      Term{"meridian", "the curve that makes a film of revolution when it is turned about the z axis; with "
                       "model = \"axisymmetric\" it alone is meshed, x the radius"},
  };
  return all;
}

std::string actuator_text(const Actuator& actuator) {
  return fmt::format("{}: {}{}\n", fmt::join(actuator.names, ", "), actuator.how,
                     actuator.example.empty() ? "" : fmt::format("; gallery/{}", actuator.example));
}

namespace {

/// Whether two keys may stand in one table.
bool meet(const Key& key, const Key& other) {
  return key.only_for.empty() || other.only_for.empty() ||
         std::ranges::any_of(key.only_for, [&](const std::string& name) { return other.applies_to(name); });
}

/// Names of the keys of which one stands for this one, in its place.
std::vector<std::string> instead_of(const Key& key, const Section& section) {
  std::vector<std::string> names;
  for (const Key& other : section.keys) {
    const bool stands_for_it = other.instead_of == key.name || other.name == key.instead_of ||
                               (!key.instead_of.empty() && other.instead_of == key.instead_of);
    if (stands_for_it && other.name != key.name && meet(key, other) &&
        std::ranges::count(names, other.name) == 0)
      names.push_back(other.name);
  }
  return names;
}

/// Whether a key, or what stands for it, must be there.
bool is_needed(const Key& key, const Section& section) {
  return key.required || std::ranges::any_of(section.keys, [&](const Key& other) {
           return other.name == key.instead_of && other.required && meet(key, other);
         });
}

} // namespace

std::string rules_text(const Key& key, const Section& section) {
  std::string rules = expectation(key, key.unit);
  const std::string range = range_text(key, key.unit.empty() ? "" : std::string(dimension(key.unit).shown));
  if (!range.empty()) rules += ", " + range;
  if (key.fallback)
    rules += "; default " + *key.fallback;
  else if (!key.fallback_key.empty())
    rules += "; default: its " + key.fallback_key;
  else
    rules += is_needed(key, section) ? "; required" : "; optional";
  if (const auto others = instead_of(key, section); !others.empty())
    rules += fmt::format(", or {} instead", fmt::join(others, " or "));
  if (!key.acts.needs.empty()) rules += "; acts only with " + key.acts.needs;
  return rules;
}

std::string key_text(const Key& key, const Section& section) {
  std::string text =
      fmt::format("  {:<21} {}\n{:24}{}\n", key.name, key.meaning, "", rules_text(key, section));
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
      text += key_text(key, section);
      continue;
    }
    text += fmt::format("  ({} {})\n", section.selector.empty() ? "only in a" : "for " + section.selector,
                        fmt::join(key.only_for, ", ")) +
            key_text(key, section);
  }
  for (const Section& inner : section.sections) text += section_text(inner, joined(path, inner.name));
  return text;
}

std::string keys_for(const Section& section, const std::string& selected) {
  std::string text;
  for (const Key& key : section.keys)
    if (!key.only_for.empty() && key.applies_to(selected)) text += key_text(key, section);
  return text;
}

std::string material_text(const materials::NamedFilm& named) {
  Film film;
  film.material = named.material;
  return fmt::format("  \"{}\"\n    from: {}\n    for: {}\n{}", named.name, named.source, named.validity,
                     values_text(*case_schema().find_section("film")->find_section("material"), &film));
}

std::string material_text(const materials::NamedSolid& named) {
  Honeycomb honeycomb;
  honeycomb.wall.material = named.solid;
  return fmt::format(
      "  \"{}\"\n    from: {}\n    for: {}\n{}", named.name, named.source, named.validity,
      values_text(*case_schema().find_section("honeycomb")->find_section("wall_material"), &honeycomb));
}

std::string device_text(const Template& device) {
  const Section& mesh = *case_schema().find_section("mesh");
  std::string text;
  const std::string name(device.name);
  const Section* section = case_schema().find_section(name);
  const std::string with = device.with.empty() ? "" : fmt::format(" with [{}]", device.with);
  text += fmt::format("{}{}: {}\n", name, with, device.meaning);
  if (section) text += section_text(*section, name);
  text += "\n[mesh]\n";
  for (const Key& key : mesh.keys)
    if (key.applies_to(name)) text += key_text(key, mesh);
  if (!device.places.empty()) text += "\nplaces\n";
  for (const PlaceName& place : device.places)
    text += fmt::format("  {:<21} {}\n", place.name, place.meaning);
  text += "\nunless the case has its own\n";
  const Node defaults = parse_tree(device.defaults, "");
  text += defaults_text(defaults, "  ");
  text += "\nstandard quantities\n";
  for (const Node& quantity : standard_quantities(defaults, &device))
    text += fmt::format("  {}\n", text_of(quantity));
  return text + "\n";
}

std::string defaults_text(const Node& defaults, std::string_view indent) {
  std::string text;
  for (std::size_t i = 0; i < defaults.items.size(); ++i)
    text += fmt::format(
        "{}{} = {}{}\n", indent, defaults.keys[i], text_of(defaults.items[i]),
        defaults.keys[i] == "support" ? " # of a shell \"turn_x\", \"turn_y\", \"turn_z\", too" : "");
  return text;
}

} // namespace dielast::cases
