// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/manual/describe.hpp"

#include "cases/case/quantities.hpp"
#include "cases/language/convert.hpp"
#include "cases/manual/entries.hpp"
#include "cases/manual/manual_page.hpp"
#include "cases/manual/materials_page.hpp"
#include "cases/manual/names.hpp"
#include "cases/tables/templates.hpp"
#include "cases/text/units.hpp"
#include "materials/catalog.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

namespace dielast::cases {
namespace {

/// One entry per choice of a section's selector, with the keys that it has.
std::string choices_text(const Section& section) {
  std::string text;
  for (const Choice& choice : section.find_key(section.selector, "")->choices)
    text += fmt::format("\n{}: {}\n", choice.word, choice.meaning) + keys_for(section, choice.word);
  text += "\nall of them\n";
  for (const Key& key : section.keys)
    if (key.only_for.empty() && key.name != section.selector) text += key_text(key, section);
  return text;
}

std::string overview() {
  std::string text =
      "A case file is TOML. Quantities are texts with units: \"0.8 mm\"; a bare number is SI.\n"
      "Sections:\n";
  for (const Section& section : case_schema().sections)
    text += fmt::format("  {:<13} {}\n", section.heading(section.name), section.meaning);
  text += fmt::format(
      "Topics: {}\nAny name is explained, too: dielast info disc, gent, film.thickness, voltage\n",
      fmt::join(topics(), ", "));
  return text;
}

std::string materials_text() {
  std::string text = "Film materials (film.material)\n";
  for (const auto& named : materials::named_films()) text += material_text(named);
  text += "Wall materials (honeycomb.wall_material)\n";
  for (const auto& named : materials::named_solids()) text += material_text(named);
  return text;
}

std::string laws_text() {
  const Section& material = *case_schema().find_section("film")->find_section("material");
  const Section& branch = *material.find_section("branch");
  std::string text = "Laws of the film (film.material.law) and of its branches\n" + choices_text(material) +
                     fmt::format("\n{}  {}, with the keys of its law and\n",
                                 branch.heading("film.material.branch"), branch.meaning);
  for (const Key& key : branch.keys)
    if (key.only_for.empty()) text += key_text(key, branch);
  return text;
}

std::string devices_text() {
  std::string text;
  for (const Template& device : templates()) text += device_text(device);
  return text;
}

std::string actuators_text() {
  std::string text = "Devices of the literature, and how a case says them\n";
  for (const Actuator& actuator : actuators()) text += "  " + actuator_text(actuator);
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
  for (const Dimension& one : dimensions()) text += fmt::format("  {:<28}{}\n", one.noun, one.usual);
  return text;
}

std::string terms_text() {
  std::string text = "Words of messages and documents\n";
  for (const Term& term : terms()) text += fmt::format("  {}: {}\n", term.name, term.meaning);
  return text;
}

struct Topic {
  const char* name;
  std::string (*text)();
};

constexpr std::array all_topics{
    Topic{"overview", overview},
    Topic{"manual.md", manual_page},
    Topic{"materials", materials_text},
    Topic{"materials.md", materials_page},
    Topic{"laws", laws_text},
    Topic{"devices", devices_text},
    Topic{"actuators", actuators_text},
    Topic{"quantities", quantities_text},
    Topic{"steps", steps_text},
    Topic{"waves", waves_text},
    Topic{"fit", fit_text},
    Topic{"keys", keys_text},
    Topic{"units", units_text},
    Topic{"terms", terms_text},
};

} // namespace

std::vector<std::string> topics() {
  std::vector<std::string> names;
  for (const Topic& topic : all_topics) names.emplace_back(topic.name);
  return names;
}

std::string describe(const std::string& topic) {
  if (topic.empty()) return overview();
  for (const Topic& candidate : all_topics)
    if (topic == candidate.name) return candidate.text();
  if (std::string text = explain_name(topic); !text.empty()) return text;
  std::vector<std::string> known = topics();
  for (std::string& name : explained_names()) known.push_back(std::move(name));
  throw std::invalid_argument(fmt::format("no topic or name \"{}\"{}; topics are {}", topic,
                                          did_you_mean(topic, known), listed(topics())));
}

} // namespace dielast::cases
