// SPDX-License-Identifier: GPL-3.0-or-later
// A strip of film or a stack of layers, and what hangs from it.
#include "cases/geometries/geometry_kinds.hpp"
#include "cases/language/conditions.hpp"
#include "cases/tables/bar_keys.hpp"

namespace dielast::cases {

Section strip_section() {
  const auto size = [](std::string name, auto member, std::string meaning) {
    return measure(std::move(name), "m", to(member), std::move(meaning)).above(0).at_most(1);
  };
  Section section;
  section.name = "strip";
  section.meaning = "a strip of film, or a stack of layers, clamped at both ends, that hangs along -y; a "
                    "case of its own, no part";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Strip>();
  section.keys = {
      size("length", &Strip::length, "length between the clamps as clamped, after the prestretch"),
      size("width", &Strip::width, "width as clamped, after the prestretch"),
      integer("layers", to(&Strip::layers), "layers of film, each with the electrode's voltage across it")
          .at_least(1)
          .at_most(100000)
          .otherwise("1"),
      measure("cover_thickness", "m", to(&Strip::cover_thickness),
              "undeformed thickness of the passive film, of the same material, on each face")
          .at_least(0)
          .at_most(0.1)
          .otherwise("0 m"),
      size("electrode_length", &Strip::electrode_length,
           "length of the electrode as clamped; without it all of the length. What is longer than the strip "
           "lies in the clamps, where it has a capacitance only")
          .optional(),
      size("electrode_width", &Strip::electrode_width,
           "width of the electrode as clamped; without it all of the width")
          .optional(),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& strip = *static_cast<const Strip*>(object);
    if (strip.electrode_width.value_or(0) <= strip.width) return std::nullopt;
    return Conflict{"electrode_width", "the electrode is wider than the film"};
  };
  return section;
}

Section roll_section() {
  Section section;
  section.name = "roll";
  section.meaning = "film wound around a core: a cylinder of layers about z, with one prestretch along it "
                    "and one around it; a case of its own, no part";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Roll>();
  section.keys = {
      measure("length", "m", to(&Roll::length), "length along the roll, before the prestretch")
          .above(0)
          .at_most(1),
      measure("radius", "m", to(&Roll::radius), "radius of the film's middle as wound, after the prestretch")
          .above(0)
          .at_most(1),
      integer("turns", to(&Roll::turns), "layers of film, each with the electrode's voltage across it")
          .at_least(1)
          .at_most(100000)
          .otherwise("1"),
      measure(
          "electrode_length", "m", to(&Roll::electrode_length),
          "length of the electrode in the roll's middle, before the prestretch; without it all of the length")
          .above(0)
          .at_most(1)
          .optional(),
      word("core",
           {{"two-sided", "it holds the film's radius, pressed or pulled", RollCore::two_sided},
            {"one-sided",
             "it carries pressure, not tension: the film lifts where nothing presses it; needs "
             "[contact]",
             RollCore::one_sided},
            {"none", "the end caps alone hold the film", RollCore::none}},
           to(&Roll::core), "what the film is wound around, along which it slides")
          .otherwise("two-sided"),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& roll = *static_cast<const Roll*>(object);
    if (roll.electrode_length.value_or(0) <= roll.length) return std::nullopt;
    return Conflict{"electrode_length", "the electrode is longer than the film"};
  };
  return section;
}

Section weight_section() {
  Section section;
  section.name = "weight";
  section.meaning = "hangs from the lower end of a [strip]; its body is \"bar\", which moves along y alone "
                    "unless a [[body]] of that name says so";
  section.presence = Section::Presence::optional;
  section.access = present(&Case::weight);
  section.keys = {measure("mass", "kg", to(&HungWeight::mass), "its mass")
                      .at_least(0)
                      .only_with(when::hung_weight_matters())};
  return section;
}

} // namespace dielast::cases
