// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/conditions.hpp"
#include "cases/readers/rules.hpp"
#include "cases/tables/templates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace dielast::cases {
namespace {

/// The table in which a part is written.
const Node& top_of(const Node& tree, const Part& part) {
  return part.name.empty() ? tree : *tree.find("part")->find(part.name);
}

std::string key_of(const Part& part, const std::string& key) {
  if (part.name.empty()) return key;
  return fmt::format("part.{}{}{}", part.name, key.empty() ? "" : ".", key);
}

void check_patch(SectionReader& reader, const Node& tree, const Part& part) {
  const auto* patch = std::get_if<Patch>(&part.geometry);
  if (!patch || !part.film || patch->mode != PatchMode::equal_biaxial ||
      part.film->prestretch[0] == part.film->prestretch[1])
    return;
  const Node* written = top_of(tree, part).find("film")->find("prestretch");
  reader.report(
      written->source, key_of(part, "film.prestretch"),
      fmt::format("found {}: in equal-biaxial tension x and y are stretched alike", text_of(*written)));
}

/// 300 % is no stretch: some mean a length that is three times as long, others four times.
void check_prestretch(SectionReader& reader, const Node& top, const Part& part) {
  const Node* film = top.find("film");
  const Node* written = film ? film->find("prestretch") : nullptr;
  if (!written) return;
  for (const Node& one : written->is(Node::Kind::list) ? written->items : std::vector<Node>{*written})
    if (one.is(Node::Kind::text) && one.text.find('%') != std::string::npos)
      reader.report(
          written->source, key_of(part, "film.prestretch"),
          fmt::format("found {}: a stretch is a length over a length, without %; 3 is three times as long",
                      text_of(*written)));
}

/// What lies in a strip's clamps is a capacitance of its electrode.
void check_strip(SectionReader& reader, const Node& top, const Case& one, const Part& part) {
  const auto* strip = std::get_if<Strip>(&part.geometry);
  if (!strip || !(strip->clamped_electrode() > 0)) return;
  const auto electrode = std::ranges::find(one.electrodes, "electrode", &Electrode::place);
  if (electrode != one.electrodes.end() && !electrode->sheet_resistance) return;
  reader.report(top.find("strip")->find("electrode_length")->source, "strip.electrode_length",
                electrode == one.electrodes.end()
                    ? "longer than the strip, and no [[electrode]] has the place \"electrode\""
                    : "longer than the strip, which an electrode with a sheet_resistance cannot be");
}

/// What a line and a rod need of one another.
void check_line(SectionReader& reader, const Node& top, const Part& part) {
  const auto report = [&](const char* key, const std::string& message) {
    const Node* blamed = top.find(key);
    reader.report(blamed ? blamed->key_source : top.source, key_of(part, blamed ? key : ""), message);
  };
  const bool line = std::holds_alternative<Line>(part.geometry);
  const bool rolls = std::holds_alternative<AntagonisticRolls>(part.geometry);
  if (rolls && !part.name.empty())
    return report("antagonistic_rolls", "antagonistic rolls are a case of their own, not a part");
  if (std::holds_alternative<Strip>(part.geometry) && !part.name.empty())
    return report("strip", "a strip is a case of its own, not a part");
  if (std::holds_alternative<Roll>(part.geometry) && !part.name.empty())
    return report("roll", "a roll is a case of its own, not a part");
  for (const char* leaf : {"hinge", "ribbon"})
    if (rolls && !top.find(leaf))
      reader.report(top.find("antagonistic_rolls")->key_source, leaf,
                    fmt::format("missing; [antagonistic_rolls] need a section [{}]", leaf));
    else if (!rolls && top.find(leaf))
      report(leaf, "only for [antagonistic_rolls]");
  if (rolls && part.ribbon && part.ribbon->length <= std::get<AntagonisticRolls>(part.geometry).arm)
    report("ribbon",
           "its length must be above antagonistic_rolls.arm: it leads from the arm's end to the roll");
  if (line && !part.rod && !part.beam) report("line", "a line is a [rod] of film, or a [beam]");
  if (!part.rolled()) return;
  if (part.rod && !line) report("rod", "a rod is a [line]: write from where to where");
  if (part.rod && part.beam) report("rod", "given twice: a line is a [rod] of film, or a [beam]");
  if (!part.film) return report("rod", "a rod is rolled of a [film]");
  const Film& film = *part.film;
  if (film.prestretch[0] != film.prestretch[1])
    report("film", "a rod is stretched along itself only: give it one prestretch");
  if (film.tension_field) report("film", "a rod does not wrinkle: leave out film.wrinkling");
  if (std::ranges::any_of(film.material.branches, [](const materials::Branch& branch) {
        return branch.dashpot == materials::Dashpot::nominal;
      }))
    report("film", "a rod's dashpots flow alike in all directions across it: dashpot = \"log\"");
}

/// What a shell needs of its case and its mesh.
void check_shell(SectionReader& reader, const Node& top, const Case& one, const Part& part) {
  if (!part.film || part.film->section != FilmSection::shell) return;
  const Node* film = top.find("film");
  const Node* written = film->find("section");
  const auto report = [&](const std::string& message) {
    reader.report(written ? written->source : film->source, key_of(part, "film.section"),
                  fmt::format("found \"shell\": {}", message));
  };
  if (one.dimension != fem::Dimension::spatial) report("it bends in space: model = \"3d\"");
  const Part* meshed = part.has_mesh() ? &part : one.unnamed();
  if (!meshed) return; // reported elsewhere
  const MeshOptions& mesh = meshed->mesh;
  if (mesh.order != 2) report("it is made of 6-node triangles: mesh.order = 2");
  if (part.film->tension_field) report("it buckles instead of wrinkling: leave out film.wrinkling");
  if (part.rolled()) report("a rod pulls along itself only");
  if (std::holds_alternative<Patch>(part.geometry)) report("a patch stays flat");
  const auto of_membranes = std::ranges::find_if(
      one.quantities, [](const Quantity& quantity) { return !quantity.kind->of_shells; });
  if (of_membranes != one.quantities.end()) // those of a case with a [plate] are among the standard ones
    report(fmt::format("quantities of kind \"{}\", of which a [plate] brings some, are of membranes",
                       of_membranes->kind->word));
}

/// What a solid needs of its case and its mesh.
void check_solid(SectionReader& reader, const Node& tree, const Case& one, const Part& part) {
  const bool thick =
      std::holds_alternative<Slab>(part.geometry) || std::holds_alternative<HollowSphere>(part.geometry);
  if (!part.film || (!thick && !part.film->is_solid())) return;
  const Film& film = *part.film;
  const Node& section = *top_of(tree, part).find("film");
  const auto report = [&](const char* key, const std::string& message) {
    const Node* written = section.find(key);
    if (written && !written->source.is_written()) written = nullptr; // the geometry has brought it
    reader.report(written ? written->source : section.source, key_of(part, fmt::format("film.{}", key)),
                  written ? fmt::format("found {}: {}", text_of(*written), message) : message);
  };
  if (!film.is_solid()) return report("section", "a thick geometry is of solid");
  const bool of_revolution = one.dimension == fem::Dimension::axisymmetric;
  const Part* meshed = part.has_mesh() ? &part : one.unnamed();
  if (!meshed) return; // reported elsewhere
  const bool own_mesh = std::holds_alternative<MeshFile>(meshed->geometry) && !of_revolution;
  const auto* slab = std::get_if<Slab>(&meshed->geometry);
  if (!own_mesh && !slab && !std::holds_alternative<HollowSphere>(meshed->geometry))
    report("section", "a solid is a [slab], a [hollow_sphere], or a mesh of your own");
  if (one.dimension == fem::Dimension::spatial && slab && !slab->width)
    report("section", "a slab in space has a width: slab.width");
  if (film.stacked_along && !fem::moves(one.dimension, *film.stacked_along))
    report("stacked_along", "the layers are stacked in the plane that is drawn: x and y of a planar model, x "
                            "and z of one of revolution");
  if (std::holds_alternative<HollowSphere>(part.geometry) && !film.potential)
    report("field", "a hollow sphere is charged between its surfaces: field = \"potential\"");
  if (film.prestretch != std::array{1.0, 1.0}) report("prestretch", "a solid is drawn free of stress");
  if (film.tension_field) report("wrinkling", "a solid does not wrinkle");
  if (film.material.dielectric.electrostriction != 0)
    report("material", "a solid is an ideal dielectric: leave out electrostriction");
  if (std::ranges::any_of(film.material.branches, [](const materials::Branch& branch) {
        return branch.dashpot == materials::Dashpot::nominal;
      }))
    report("material", "a solid's dashpots have no axes: dashpot = \"log\"");
  if (meshed->mesh.order != 2) report("section", "a solid is made of 6-node triangles");
  if (one.linearise && film.potential)
    report("field", "a field that is solved for has no linear model; ask for a step of kind \"harmonic\"");
  if (std::ranges::any_of(one.steps,
                          [](const Step& step) { return step.on_instability == OnInstability::jump; }))
    report("section", "solids do not jump: on_instability = \"stop\" or \"follow\"");
  for (const Quantity& quantity : one.quantities)
    if (!quantity.kind->of_solids)
      report("section",
             fmt::format("quantity \"{}\" is of films that are membranes or shells", quantity.name));
  for (std::size_t e = 0; e < one.electrodes.size(); ++e) {
    const Electrode& electrode = one.electrodes[e];
    if (electrode.ground.empty() != film.potential) continue;
    const Node* list = tree.find("electrode");
    const bool written = list && e < list->items.size() && list->items[e].source.is_written();
    reader.report(written ? list->items[e].source : section.source,
                  fmt::format("electrode[{}].ground", e + 1),
                  film.potential ? "missing; with field = \"potential\" an electrode has a surface opposite"
                                 : "only for a solid with field = \"potential\"");
  }
}

/// Surfaces are for solids.
void check_surfaces(SectionReader& reader, const Node& tree, const Case& one) {
  if (!one.any_film([](const Film& film) { return film.is_solid(); })) {
    for (std::size_t e = 0; e < one.electrodes.size(); ++e)
      if (!one.electrodes[e].ground.empty())
        reader.report(tree.find("electrode")->items.at(e).find("ground")->source,
                      fmt::format("electrode[{}].ground", e + 1),
                      "only for a solid with field = \"potential\"");
    if (one.chamber && !one.chamber->place.empty())
      reader.report(tree.find("chamber")->find("at")->source, "chamber.at", "only for solids");
    return;
  }
  if (one.any_film([](const Film& film) { return !film.is_solid(); }))
    reader.report(tree.source, "part", "solids and other films cannot be in one case");
  const auto has_potential = [](const Film& film) { return film.potential; };
  if (one.any_film(has_potential) && one.any_film(std::not_fn(has_potential)))
    reader.report(tree.source, "part", "give all solids of a case the same field");
  if (one.chamber && one.chamber->place.empty())
    reader.report(tree.find("chamber")->source, "chamber.at",
                  "missing; say on which surface of the solid it presses");
}

/// Electrodes with a resistance along them need triangles or meridians of membrane.
void check_resistive_electrodes(SectionReader& reader, const Node& tree, const Case& one) {
  const char* other = nullptr;
  for (const Part& part : one.parts) {
    if (part.rolled()) other = "rods";
    if (part.film && part.film->section == FilmSection::shell) other = "shells";
    if (part.film && part.film->is_solid()) other = "solids";
  }
  for (std::size_t e = 0; other && e < one.electrodes.size(); ++e)
    if (one.electrodes[e].sheet_resistance)
      reader.report(
          tree.find("electrode")->items.at(e).find("sheet_resistance")->source,
          fmt::format("electrode[{}].sheet_resistance", e + 1),
          fmt::format("the electrodes of {} do not resist; give their circuit a resistance", other));
}

/// A film that is alike in all directions of its plane may be turned as one likes.
bool knows_x_from_y(const Part& part) {
  if (std::holds_alternative<Line>(part.geometry)) return false; // it knows its own way
  if (!part.film || std::holds_alternative<Patch>(part.geometry)) return true;
  const auto has_axes = [](const materials::Branch& branch) {
    return branch.dashpot == materials::Dashpot::nominal;
  };
  return part.film->prestretch[0] != part.film->prestretch[1] ||
         std::ranges::any_of(part.film->material.branches, has_axes);
}

} // namespace

void check_parts(SectionReader& reader, const Node& tree, const Case& one) {
  for (const Part& part : one.parts) {
    const Node& top = top_of(tree, part);
    check_patch(reader, tree, part);
    check_prestretch(reader, top, part);
    check_line(reader, top, part);
    check_strip(reader, top, one, part);
    check_shell(reader, top, one, part);
    check_solid(reader, tree, one, part);
    if (part.name.empty()) continue;
    const auto report = [&](const char* key, const std::string& message) {
      const Node* blamed = top.find(key);
      reader.report(blamed ? blamed->key_source : top.source, key_of(part, blamed ? key : ""), message);
    };
    const auto geometries = geometries_of(top);
    if (geometries.size() > 1)
      reader.report(geometries[1]->key_source, key_of(part, ""),
                    fmt::format("there are {} geometries; a part has one", geometries.size()));
    if (!part.place.empty() && !geometries.empty())
      report("place", "given twice: a part is a place of the mesh or has a geometry of its own");
    if (part.place.empty() && geometries.empty())
      report("", "a part needs a place of the mesh at the top of the file, or a geometry of its own");
    if (!part.place.empty() && !(one.unnamed() && one.unnamed()->has_mesh()))
      report("place", "there is no mesh at the top of the file whose place it could be");
    if (part.film.has_value() == part.beam.has_value())
      report("beam", part.film ? "a part is a film or bars, not both" : "a part needs a [film] or a [beam]");
    if (part.beam && !geometries.empty() && !std::holds_alternative<Line>(part.geometry))
      report("beam", "bars are a [line], or lines of a mesh: give the part a place");
    if (!part.place.empty())
      for (const char* key : {"mesh", "at", "turned"})
        if (top.find(key)) report(key, "a part that is a place has the mesh and the position of its place");
    if (!geometries.empty() && one.dimension == fem::Dimension::axisymmetric) {
      if (!part.film || !part.film->is_solid())
        report("", "films with geometries of their own are planar or in space; model = \"axisymmetric\" has "
                   "one meridian");
      else if (part.at[0] != 0 || part.at[1] != 0)
        report("at", "a solid of revolution is moved along z alone");
      else if (part.turned != 0)
        report("turned", "a solid of revolution is drawn upright");
    }
    if (!geometries.empty() && (one.plate || one.chamber))
      report("", "[plate] and [chamber] are for a case without geometries in parts; use [[body]]");
    const double half_turns = part.turned / std::numbers::pi;
    if (knows_x_from_y(part) && std::abs(half_turns - std::round(half_turns)) > 1e-9)
      report("turned", "a patch, or a film that is not alike along x and y, can be turned by 180 deg only");
  }
  check_surfaces(reader, tree, one);
  check_resistive_electrodes(reader, tree, one);
  const auto wrinkles = [](const Film& film) { return film.tension_field; };
  if (one.any_film(wrinkles) && one.any_film(std::not_fn(wrinkles)))
    reader.report(tree.find("part")->key_source, "part",
                  "one film wrinkles and another does not; give all films of a case the same wrinkling");
  if (one.unnamed() && one.unnamed()->film && !one.unnamed()->has_mesh())
    reader.report(tree.find("film")->key_source, "film",
                  "a film without geometry; add one, or give each [part.NAME] its own [part.NAME.film]");
}

} // namespace dielast::cases
