// SPDX-License-Identifier: GPL-3.0-or-later
// Beams, rods, and what is made of them.
#include "cases/case/part_kind.hpp"
#include "cases/language/conditions.hpp"
#include "cases/tables/bar_keys.hpp"

namespace dielast::cases {
namespace {

std::optional<Conflict> rod_conflict(const Rod& rod) {
  if (rod.electrode_width.value_or(0) <= rod.width) return std::nullopt;
  return Conflict{"electrode_width", "the electrode is wider than the film"};
}

/// `rod(object)` returns a reference to the Rod in the object.
template<class T, class Of>
std::vector<Key> rod_keys(Of rod) {
  const auto electrode = [rod](std::string name, std::optional<double> Rod::*part, std::string meaning) {
    return measure(std::move(name), "m", to_part<T>([=](auto& object) -> auto& { return rod(object).*part; }),
                   std::move(meaning))
        .above(0)
        .at_most(10)
        .optional();
  };
  return {
      measure("width", "m", to_part<T>([rod](auto& object) -> auto& { return rod(object).width; }),
              "width of one layer of film across the rod, unstretched")
          .above(0)
          .at_most(10),
      integer("layers", to_part<T>([rod](auto& object) -> auto& { return rod(object).layers; }),
              "layers of film, each with the electrode's voltage across it")
          .at_least(1)
          .at_most(100000)
          .otherwise("1"),
      electrode("electrode_width", &Rod::electrode_width,
                "width of the electrode on a layer, unstretched; without it all of the width"),
      electrode("electrode_length", &Rod::electrode_length,
                "length of the electrode along the rod, unstretched; without it all of the length; the rod "
                "is stretched alike everywhere"),
  };
}

/// [hinge], [ribbon]: a leaf spring of the antagonistic rolls
Section leaf_section(std::string name, std::string meaning, std::optional<Leaf> Part::*leaf) {
  Section section;
  section.name = std::move(name);
  section.meaning = std::move(meaning);
  section.presence = Section::Presence::optional;
  section.access = present(leaf);
  section.keys = {
      measure("length", "m", to(&Leaf::length), "length of it that bends").above(0).at_most(1),
      measure("width", "m", to_part<Leaf>([](auto& one) -> auto& { return one.beam.height; }),
              "width across the plane in which it bends")
          .above(0)
          .at_most(1),
      measure("thickness", "m", to_part<Leaf>([](auto& one) -> auto& { return one.beam.width; }),
              "thickness in the plane in which it bends")
          .above(0)
          .at_most(1),
  };
  section.sections.push_back(bar_material_section<Leaf>(
      "material", [](auto& one) -> auto& { return one.beam; }));
  return section;
}

} // namespace

Key wall_print() {
  return word(
             "wall_print",
             {{"merged", "on both faces, one bar as if there were no film between", WallPrint::merged},
              {"both faces",
               "half of the height on each face: they bend as one across the film, and each twists by itself",
               WallPrint::both_faces},
              {"one face", "all of it on the upper face: the walls' axes lie above the film",
               WallPrint::one_face}},
             to(&Honeycomb::print), "on which faces of the film the walls are printed")
      .otherwise("merged")
      .only_with(when::in_space());
}

Section line_section() {
  Section section;
  section.name = "line";
  section.meaning =
      fmt::format("straight: {}", words_of_kinds([](const PartKind& kind) { return kind.line != nullptr; }));
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Line>();
  section.keys = {
      measure("from", "m", to(&Line::from), "where it starts").values(3, 3).otherwise("[0, 0, 0]"),
      measure("to", "m", to(&Line::to), "where it ends, a film in its prestretch").values(3, 3),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& line = *static_cast<const Line*>(object);
    if (line.from != line.to) return std::nullopt;
    return Conflict{"to", "a line must end elsewhere than it starts"};
  };
  return section;
}

Section rod_section() {
  Section section;
  section.name = "rod";
  section.meaning = "the film is rolled up to a bar: it pulls along itself, and across itself its width and "
                    "thickness change alike, under voltage too, as a cylinder's that keeps its volume: by "
                    "1/sqrt(stretch). Film that lies flat gives way otherwise, and has more capacitance: "
                    "[strip]";
  section.presence = Section::Presence::optional;
  section.access = present(&Part::rod);
  section.keys = rod_keys<Rod>([](auto& rod) -> auto& { return rod; });
  section.check = [](const void* object) -> std::optional<Conflict> {
    return rod_conflict(*static_cast<const Rod*>(object));
  };
  return section;
}

Section beam_section() {
  Section section;
  section.name = "beam";
  section.meaning =
      "bars of rectangular section along the lines of the part's place; with a mass, their sections' turning "
      "has inertia, too";
  section.presence = Section::Presence::optional;
  section.access = present(&Part::beam);
  section.keys = {
      measure("width", "m", to(&Beam::width), "width of a bar in the film's plane").above(0).at_most(1),
      measure("height", "m", to(&Beam::height), "height of a bar normal to the film").above(0).at_most(1),
      measure(
          "offset", "m", to(&Beam::offset),
          "distance of the bars' axes from the lines, along z; rigid links lead there, as to bars that are "
          "printed on one face of a film")
          .at_least(-1)
          .at_most(1)
          .otherwise("0 m")
          .only_with(when::in_space()),
  };
  section.sections.push_back(bar_material_section<Beam>(
      "material", [](auto& beam) -> auto& { return beam; }));
  return section;
}

Section rolls_section() {
  Section section;
  section.name = "antagonistic_rolls";
  section.meaning = "two rolls of film, beside a hinge, that turn a tip by ribbons; of the film in [film]; "
                    "a case of its own, no part";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<AntagonisticRolls>();
  section.keys = rod_keys<AntagonisticRolls>([](auto& rolls) -> auto& { return rolls.roll; });
  section.keys.push_back(
      measure("length", "m", to(&AntagonisticRolls::length), "length of a roll, unstretched")
          .above(0)
          .at_most(1));
  section.keys.push_back(measure("arm", "m", to(&AntagonisticRolls::arm),
                                 "distance from the hinge's face to where a ribbon is fixed to the tip, and "
                                 "from there to the roll's axis")
                             .above(0)
                             .at_most(1));
  section.keys.push_back(
      word("ribbons",
           {{"links",
             "turn freely at their ends, and go slack where they would be pushed; what bends them, E "
             "I/length each, is taken with the hinge",
             RibbonBending::with_hinge},
            {"beams", "are clamped to the tip and bend under the rolls' pull", RibbonBending::own}},
           to(&AntagonisticRolls::ribbons), "how the ribbons bend")
          .otherwise("links"));
  section.check = [](const void* object) {
    return rod_conflict(static_cast<const AntagonisticRolls*>(object)->roll);
  };
  return section;
}

std::vector<Section> leaf_sections() {
  return {
      leaf_section("hinge", "the hinge of [antagonistic_rolls]: from the backbone to the tip", &Part::hinge),
      leaf_section("ribbon", "the ribbons of [antagonistic_rolls]: from the tip to the rolls",
                   &Part::ribbon)};
}

} // namespace dielast::cases
