// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/manual/json_schema.hpp"

#include "cases/language/convert.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

namespace dielast::cases {
namespace {

using Json = nlohmann::ordered_json;

Json number_schema(const Key& key, const char* type) {
  Json schema{{"type", type}};
  if (std::isfinite(key.range.low))
    schema[key.range.low_open ? "exclusiveMinimum" : "minimum"] = key.range.low;
  if (std::isfinite(key.range.high))
    schema[key.range.high_open ? "exclusiveMaximum" : "maximum"] = key.range.high;
  return schema;
}

Json section_schema(const Section& section);

constexpr const char* any_number = "^\\s*[+-]?[0-9.]";

/// A number with its unit, but not with one that is known to be wrong: one of another dimension, or one that
/// is spelt in letters of the wrong size. All others are left to the program, which knows more units.
std::string measure_pattern(std::string_view si_unit) {
  std::vector<std::string> wrong;
  const auto add = [&](const std::string& unit) {
    try {
      parse_measure("1 " + unit, si_unit);
    } catch (const UnitError&) {
      if (std::ranges::find(wrong, unit) == wrong.end()) wrong.push_back(unit);
    }
  };
  for (const Dimension& other : dimensions()) {
    std::istringstream units{std::string(other.usual)};
    for (std::string unit; units >> unit;)
      if (std::ranges::all_of(unit, [](unsigned char c) { return std::isalpha(c) != 0; })) add(unit);
  }
  for (const char* unit : {"v", "kv", "KV", "pa", "kpa", "KPa", "mpa", "hz", "khz", "KHz", "MM", "Kg"})
    add(unit);
  return fmt::format("^(?!\\s*[+-]?[0-9.eE+-]+\\s*(?:{})\\s*$)\\s*[+-]?[0-9.]", fmt::join(wrong, "|"));
}

/// `one_unit`: the unit of the key is the same wherever its section has it.
Json item_schema(const Key& key, bool one_unit) {
  const std::string pattern =
      one_unit && !key.unit.empty() ? measure_pattern(key.unit) : std::string(any_number);
  switch (key.type) {
  case Type::wave:
    return {{"anyOf",
             {number_schema(key, "number"),
              {{"type", "string"}, {"pattern", pattern}},
              section_schema(wave_section(key.unit))}}};
  case Type::measure:
  case Type::tolerance:
    return {{"anyOf", {number_schema(key, "number"), {{"type", "string"}, {"pattern", pattern}}}}};
  case Type::integer:
    return number_schema(key, "integer");
  case Type::flag:
    return {{"type", "boolean"}};
  case Type::word: {
    Json words = Json::array();
    for (const Choice& choice : key.choices) words.push_back(choice.word);
    return {{"enum", words}};
  }
  case Type::name:
    return {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-]+$"}};
  case Type::text:
    break;
  }
  return {{"type", "string"}, {"minLength", 1}};
}

Json key_schema(const Key& key, bool one_unit) {
  Json schema = item_schema(key, one_unit);
  if (key.is_list()) {
    Json list{{"type", "array"}, {"items", schema}, {"minItems", key.least}, {"maxItems", key.most}};
    schema = key.spreads ? Json{{"anyOf", {schema, list}}} : list;
  }
  std::string description = key.meaning;
  const bool is_measure = key.type == Type::measure || key.type == Type::wave;
  if (is_measure && !key.unit.empty() && key.unit != "1")
    description += fmt::format(" ({} such as \"{}\")", dimension(key.unit).noun, dimension(key.unit).example);
  schema["description"] = description;
  if (key.fallback) schema["default"] = Json::parse(text_of(parse_value(*key.fallback, {})));
  return schema;
}

Json shaped_schema(const Section& section) {
  Json schema = section_schema(section);
  if (section.shape == Section::Shape::list) return {{"type", "array"}, {"minItems", 1}, {"items", schema}};
  if (section.shape == Section::Shape::named)
    return {{"type", "object"}, {"description", section.meaning}, {"additionalProperties", schema}};
  if (section.shape == Section::Shape::by_electrode) {
    schema.erase("required"); // here or in what follows it, for each electrode
    schema["additionalProperties"] = section_schema(section);
  }
  if (section.names)
    return {{"anyOf", {{{"enum", section.names()}}, schema}}, {"description", section.meaning}};
  return schema;
}

Json section_schema(const Section& section) {
  Json properties = Json::object(), required = Json::array();
  for (const Key& key : section.keys) {
    const bool one_unit = std::ranges::all_of(
        section.keys, [&](const Key& other) { return other.name != key.name || other.unit == key.unit; });
    if (!properties.contains(key.name)) {
      properties[key.name] = key_schema(key, one_unit);
    } else { // another kind of step or quantity has the key with a default or meaning of its own
      Json& known = properties[key.name];
      Json other = key_schema(key, one_unit);
      if (known.value("default", Json()) != other.value("default", Json())) known.erase("default");
      if (key.type == Type::word || !known.contains("pattern")) {
        known.erase("enum");
        if (key.type == Type::word) known = {{"type", "string"}, {"description", known["description"]}};
      }
    }
    const bool replaceable = std::any_of(section.keys.begin(), section.keys.end(),
                                         [&](const Key& other) { return other.instead_of == key.name; });
    if (key.required && !key.fallback && key.fallback_key.empty() && key.only_for.empty() && !replaceable &&
        !section.start)
      required.push_back(key.name);
  }
  for (const Section& inner : section.sections) {
    properties[inner.name] = shaped_schema(inner);
    if (inner.presence == Section::Presence::required) required.push_back(inner.name);
  }
  Json schema{{"type", "object"}, {"description", section.meaning}, {"properties", properties}};
  if (!required.empty()) schema["required"] = required;
  schema["additionalProperties"] =
      section.keys.empty() && section.sections.empty(); // the user names its keys
  return schema;
}

} // namespace

std::string json_schema() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "dielast case"}};
  schema.update(section_schema(case_schema()));
  schema.erase("required"); // a study file has none of the sections
  // The film of a fit is its material alone.
  Json& film = schema["properties"]["film"];
  schema["if"] = {{"required", {"fit"}}};
  schema["else"] = {{"properties", {{"film", {{"required", film["required"]}}}}}};
  film.erase("required");
  return schema.dump(2);
}

} // namespace dielast::cases
