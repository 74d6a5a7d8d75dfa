// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/convert.hpp"
#include "cases/manual/describe.hpp"
#include "cases/manual/json_schema.hpp"
#include "cases/tables/templates.hpp"
#include "cases/text/units.hpp"
#include "materials/catalog.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <regex>
#include <set>

namespace dielast::cases::schema_test {
namespace {

void visit_sections(const Section& section, const std::string& path,
                    const std::function<void(const Section&, const std::string&)>& visit) {
  visit(section, path);
  for (const Section& inner : section.sections) visit_sections(inner, path + "." + inner.name, visit);
}

/// The sections of a case and of its waves.
void for_each_section(const std::function<void(const Section&, const std::string&)>& visit) {
  visit_sections(case_schema(), "", visit);
  for (const char* unit : {"V", "C", "N", "m", "1", "Pa"}) visit_sections(wave_section(unit), "wave", visit);
}

TEST(Schema, EverySectionAndKeyHasAMeaning) {
  for_each_section([](const Section& section, const std::string& path) {
    EXPECT_FALSE(section.meaning.empty()) << path;
    for (const Key& key : section.keys) EXPECT_FALSE(key.meaning.empty()) << path << "." << key.name;
  });
}

TEST(Schema, EveryNumberHasAUnitAndAnUpperBound) {
  for_each_section([](const Section& section, const std::string& path) {
    for (const Key& key : section.keys) {
      const std::string name = path + "." + key.name;
      if (key.type == Type::integer) {
        EXPECT_TRUE(std::isfinite(key.range.high)) << name;
      }
      if (key.type != Type::measure || key.unit.empty()) continue;
      EXPECT_NO_THROW(dimension(key.unit)) << name;
      EXPECT_TRUE(std::isfinite(key.range.low) && std::isfinite(key.range.high)) << name;
    }
  });
}

TEST(Schema, EveryDefaultIsValid) {
  for_each_section([](const Section& section, const std::string& path) {
    for (const Key& key : section.keys)
      if (key.fallback) {
        EXPECT_NO_THROW(convert(key, parse_value(*key.fallback, {}), key.unit)) << path << "." << key.name;
      }
  });
}

// A word stands for a value, whatever its place in the list, and no other word of the key for the same one;
// only what is kept as a text is its own value.
TEST(Schema, EveryWordStandsForAValue) {
  std::set<std::string> texts;
  for_each_section([&](const Section& section, const std::string& path) {
    for (const Key& key : section.keys) {
      std::set<std::optional<double>> values;
      for (const Choice& choice : key.choices) {
        values.insert(choice.value);
        if (!choice.value) {
          texts.insert(path + "." + key.name);
          continue;
        }
        const std::string word = toml_string(choice.word);
        const Value value = convert(key, parse_value(key.is_list() ? "[" + word + "]" : word, {}), key.unit);
        EXPECT_EQ(value.front().number, *choice.value) << path << "." << key.name;
        EXPECT_EQ(key.word_of({*choice.value, ""}), choice.word) << path << "." << key.name;
      }
      if (texts.contains(path + "." + key.name)) continue;
      EXPECT_EQ(values.size(), key.choices.size()) << path << "." << key.name;
    }
  });
  EXPECT_EQ(texts, (std::set<std::string>{".quantity.of"}));
}

TEST(Schema, EveryWordOfASelectorIsOneOfItsChoices) {
  for_each_section([](const Section& section, const std::string& path) {
    if (section.selector.empty() || section.selector == "geometry") return;
    const Key* selector = section.find_key(section.selector, "");
    ASSERT_NE(selector, nullptr) << path;
    for (const Key& key : section.keys)
      for (const std::string& word : key.only_for)
        EXPECT_TRUE(std::any_of(selector->choices.begin(), selector->choices.end(),
                                [&](const Choice& choice) { return choice.word == word; }))
            << path << "." << key.name << " for " << word;
  });
}

TEST(Schema, LawsAndTheirParametersComeFromTheRegistry) {
  const Section& material = *case_schema().find_section("film")->find_section("material");
  const Key* law = material.find_key("law", "");
  ASSERT_EQ(law->choices.size(), std::variant_size_v<materials::ElasticLaw>);
  EXPECT_EQ(law->choices[0].word, materials::NeoHookean::name);
  for (const auto& parameter : materials::NeoHookean::parameters) {
    const Key* key = material.find_key(parameter.name, law->choices[0].word);
    ASSERT_NE(key, nullptr);
    EXPECT_EQ(key->unit, parameter.unit);
    EXPECT_EQ(key->meaning, parameter.meaning);
  }
}

TEST(Schema, JsonSchemaIsJsonWithEveryKey) {
  const auto schema = nlohmann::json::parse(json_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["additionalProperties"], false);
  for (const Section& section : case_schema().sections)
    EXPECT_TRUE(schema["properties"].contains(section.name)) << section.name;
  const auto& honeycomb = schema["properties"]["honeycomb"];
  EXPECT_EQ(honeycomb["properties"]["columns"]["default"], nlohmann::json({7, 6, 7, 6, 7}));
  EXPECT_EQ(honeycomb["required"], nlohmann::json({"angle", "wall_length", "wall_width", "wall_height"}));
}

TEST(Schema, JsonSchemaDescribesWavesAndBranches) {
  const auto schema = nlohmann::json::parse(json_schema());
  const auto& voltage = schema["properties"]["drive"]["properties"]["voltage"]["anyOf"];
  ASSERT_EQ(voltage.size(), 3u); // a number, a text, a wave
  EXPECT_EQ(voltage[2]["required"], nlohmann::json({"wave"}));
  EXPECT_TRUE(voltage[2]["properties"].contains("end_frequency"));
  const auto& material = schema["properties"]["film"]["properties"]["material"]["anyOf"][1]["properties"];
  EXPECT_TRUE(material["branch"]["items"]["properties"].contains("relaxation_time"));
  EXPECT_EQ(material["moduli"]["type"], "array");
}

TEST(Convert, AWaveIsWrittenAsItIsRead) {
  Drive drive;
  drive.voltage = {.kind = Waveform::Kind::sine, .amplitude = 4000, .frequency = 0.5};
  const Key& key = *case_schema().find_section("drive")->find_key("voltage", "");
  EXPECT_EQ(toml_text(key, *key.binding.get(&drive)), "{ wave = \"sine\", mean = \"0 V\", amplitude = \"4000 "
                                                      "V\", frequency = \"0.5 Hz\", phase = \"0 deg\" }");
}

TEST(Describe, WavesHaveATopicWithAllTheirKeys) {
  const std::string waves = describe("waves");
  for (const Key& key : wave_section("V").keys)
    EXPECT_NE(waves.find(key.type == Type::word ? "unipolar sine: " : "  " + key.name), std::string::npos)
        << key.name;
}

TEST(Describe, EveryTopicHasAText) {
  for (const std::string& topic : topics()) EXPECT_GT(describe(topic).size(), 100u) << topic;
  EXPECT_THROW(describe("laaws"), std::invalid_argument);
  EXPECT_EQ(describe("mesh").find("[part.mesh]"), std::string::npos);
  EXPECT_EQ(describe("part.mesh").find("[part.mesh]"), 0u);
}

TEST(Describe, ExplainsFormsOfWavesPlacesAndStandardQuantities) {
  EXPECT_NE(describe("unipolar sine").find("amplitude"), std::string::npos);
  EXPECT_NE(describe("trapezoid").find("  hold "), std::string::npos);
  EXPECT_NE(describe("fall").find("for wave trapezoid"), std::string::npos);
  EXPECT_NE(describe("rim").find("place of [disc]: rim: "), std::string::npos);
  EXPECT_NE(describe("eps_x").find("standard quantity of [honeycomb]: "), std::string::npos);
}

TEST(Describe, TellsEveryMaterialPlaceAndKey) {
  const std::string materials = describe("materials"), devices = describe("devices"), keys = describe("keys");
  for (const auto& film : materials::named_films()) EXPECT_NE(materials.find(film.name), std::string::npos);
  for (const auto& solid : materials::named_solids())
    EXPECT_NE(materials.find(solid.name), std::string::npos);
  for (const Template& device : templates())
    for (const PlaceName& place : device.places) EXPECT_NE(devices.find(place.name), std::string::npos);
  visit_sections(case_schema(), "", [&](const Section& section, const std::string&) {
    for (const Key& key : section.keys) EXPECT_NE(keys.find("  " + key.name), std::string::npos) << key.name;
  });
}

using nlohmann::json;

json json_of(const Node& node) {
  switch (node.kind) {
  case Node::Kind::flag:
    return node.flag;
  case Node::Kind::integer:
    return node.integer;
  case Node::Kind::number:
    return node.number;
  case Node::Kind::text:
  case Node::Kind::date:
    return node.text;
  case Node::Kind::list: {
    json list = json::array();
    for (const Node& item : node.items) list.push_back(json_of(item));
    return list;
  }
  case Node::Kind::table:
    break;
  }
  json table = json::object();
  for (std::size_t i = 0; i < node.items.size(); ++i) table[node.keys[i]] = json_of(node.items[i]);
  return table;
}

bool has_type(const json& value, const std::string& type) {
  return type == "object"    ? value.is_object()
         : type == "array"   ? value.is_array()
         : type == "string"  ? value.is_string()
         : type == "boolean" ? value.is_boolean()
         : type == "integer"
             ? value.is_number_integer() || (value.is_number() && value == std::floor(value.get<double>()))
             : value.is_number();
}

/// What is wrong with a value by the words of JSON Schema that ours uses; empty: nothing.
std::string violation(const json& schema, const json& value, const std::string& path) {
  static const std::set<std::string> known{"$schema",
                                           "title",
                                           "description",
                                           "default",
                                           "type",
                                           "properties",
                                           "required",
                                           "additionalProperties",
                                           "items",
                                           "minItems",
                                           "maxItems",
                                           "minLength",
                                           "pattern",
                                           "enum",
                                           "anyOf",
                                           "if",
                                           "else",
                                           "minimum",
                                           "maximum",
                                           "exclusiveMinimum",
                                           "exclusiveMaximum"};
  for (const auto& [word, ignored] : schema.items())
    if (!known.contains(word)) return path + ": the test does not know " + word;
  if (schema.contains("type") && !has_type(value, schema["type"])) return path + ": type";
  if (schema.contains("enum") && std::ranges::find(schema["enum"], value) == schema["enum"].end())
    return path + ": enum";
  if (schema.contains("anyOf") && std::ranges::none_of(schema["anyOf"], [&](const json& one) {
        return violation(one, value, path).empty();
      }))
    return path + ": anyOf";
  if (schema.contains("if") && !violation(schema["if"], value, path).empty())
    if (std::string wrong = violation(schema["else"], value, path); !wrong.empty()) return wrong;
  if (value.is_number()) {
    const double number = value;
    if (number < schema.value("minimum", number) || number > schema.value("maximum", number))
      return path + ": range";
    if (number <= schema.value("exclusiveMinimum", -INFINITY) ||
        number >= schema.value("exclusiveMaximum", INFINITY))
      return path + ": range";
  }
  if (value.is_string() && schema.contains("pattern") &&
      !std::regex_search(value.get<std::string>(), std::regex(schema["pattern"].get<std::string>())))
    return path + ": pattern";
  if (value.is_string() && value.get<std::string>().size() < schema.value("minLength", 0u))
    return path + ": minLength";
  if (value.is_array()) {
    if (value.size() < schema.value("minItems", 0u) || value.size() > schema.value("maxItems", value.size()))
      return path + ": number of items";
    if (schema.contains("items"))
      for (std::size_t i = 0; i < value.size(); ++i)
        if (std::string wrong = violation(schema["items"], value[i], path + "[" + std::to_string(i) + "]");
            !wrong.empty())
          return wrong;
  }
  if (!value.is_object()) return "";
  for (const json& name : schema.value("required", json::array()))
    if (!value.contains(name)) return path + ": " + name.get<std::string>() + " is missing";
  const json properties = schema.value("properties", json::object());
  for (const auto& [name, inner] : value.items()) {
    const json more = schema.value("additionalProperties", json(true));
    if (!properties.contains(name) && more == false) return path + "." + name + ": unknown";
    const json& rule = properties.contains(name) ? properties[name] : more;
    if (!rule.is_object()) continue;
    if (std::string wrong = violation(rule, inner, path + "." + name); !wrong.empty()) return wrong;
  }
  return "";
}

TEST(JsonSchema, AcceptsTheGalleryAndWhatIsValid) {
  const json schema = json::parse(json_schema());
  int files = 0;
  for (const char* folder : {"cases/gallery", "tests/cases/valid"})
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(DIELAST_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".toml") continue;
      ++files;
      EXPECT_EQ(violation(schema, json_of(read_tree(entry.path())), ""), "") << entry.path();
    }
  EXPECT_GT(files, 30);
}

TEST(JsonSchema, RefusesWhatTheLanguageDoesNotKnow) {
  const json schema = json::parse(json_schema());
  const auto wrong = [&](const std::string& toml) {
    return violation(schema, json_of(parse_tree(toml, "")), "");
  };
  const std::string film = "[film]\nmaterial = \"VHB 4910 (honeycomb)\"\n";
  EXPECT_EQ(wrong(film + "thickness = \"1 mm\"\n"), "");
  EXPECT_EQ(wrong(film), ".film: thickness is missing");
  EXPECT_EQ(wrong(film + "[fit]\n"), "");
  EXPECT_EQ(wrong(film + "thicknes = \"1 mm\"\n[fit]\n"), ".film.thicknes: unknown");
  EXPECT_EQ(wrong(film + "thickness = -1\n"), ".film.thickness: anyOf");
  for (const char* thickness : {"8 kg", "7.5 kv", "50 deg", "1e-3 s"})
    EXPECT_EQ(wrong(film + "thickness = \"" + thickness + "\"\n"), ".film.thickness: anyOf") << thickness;
  for (const char* thickness : {"0.8 mm", "1e-3m", "800 µm", "30 thou", "1 mm2/mm"})
    EXPECT_EQ(wrong(film + "thickness = \"" + thickness + "\"\n"), "") << thickness;
  EXPECT_NE(wrong("[drive]\nvoltage = \"7.5 kv\"\n"), "");
  EXPECT_EQ(wrong("model = \"flat\"\n"), ".model: enum");
  EXPECT_EQ(wrong("[[step]]\nkind = \"voltage\"\nincrements = 2.5\n"), ".step[0].increments: type");
}

} // namespace
} // namespace dielast::cases::schema_test
