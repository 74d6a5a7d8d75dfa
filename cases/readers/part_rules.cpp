// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/conditions.hpp"
#include "cases/parts/part_kinds.hpp"
#include "cases/readers/rules.hpp"
#include "cases/tables/templates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace dielast::cases {
namespace {

void check_patch(const WrittenPart& written) {
  const Part& part = written.part;
  const auto* patch = std::get_if<Patch>(&part.geometry);
  if (!patch || !part.film || patch->mode != PatchMode::equal_biaxial ||
      part.film->prestretch[0] == part.film->prestretch[1])
    return;
  written.report_film("prestretch", "in equal-biaxial tension x and y are stretched alike");
}

/// Stresses hold no prestretch: the patch is cut free before the first step, and what its branches have
/// relaxed to is lost.
void check_stressed_patch(const WrittenPart& written) {
  const Part& part = written.part;
  const Case& one = written.one;
  const auto* patch = std::get_if<Patch>(&part.geometry);
  if (!patch || !part.film || (part.film->material.branches.empty() && part.film->material.viscosity == 0) ||
      (!one.steps.empty() && one.steps.front().kind == StepKind::release))
    return;
  // Of a path along which branches have relaxed it does not matter that it begins free.
  if (const auto& steps = one.steps; !steps.empty() && steps.front().kind == StepKind::force &&
                                     !steps.front().duration && steps.front().response == Response::relaxed)
    return;
  if (std::ranges::none_of(one.steps, &Step::moves_dashpots) || one.steps.back().kind == StepKind::relax)
    return;
  const std::array stresses{&patch->stress_x, &patch->stress_y};
  for (std::size_t i = 0; i < stresses.size(); ++i) {
    const std::string key = i == 0 ? "stress_x" : "stress_y";
    const Node* table = written.top().find("patch");
    const Node* stress = table ? table->find(key) : nullptr;
    if (!*stresses[i] || !stress || part.film->prestretch[i] == 1) continue;
    written.reader.warn(
        stress->source, written.path("patch." + key),
        fmt::format("the prestretch is not held here: a step \"settle\" before the first cuts the film free, "
                    "with its branches relaxed; hold it by stretch_{}, or ramp the stress with response = "
                    "\"relaxed\" first, or say so by a [[step]] of kind \"release\"",
                    "xy"[i]));
  }
}

/// Electrodes of layers that there are, and that can be charged.
void check_layers(SectionReader& reader, const Node& tree, const Case& one) {
  std::vector<std::string> names, chargeable; // parts may have layers of one name
  for (const Part& part : one.parts)
    for (std::size_t l = 0; part.film && l < part.film->further_layers.size(); ++l)
      if (const Layer& layer = part.film->further_layers[l]; !layer.name.empty()) {
        names.push_back(layer.name);
        if (layer.material.dielectric.permittivity > 0) chargeable.push_back(layer.name);
      }
  for (std::size_t e = 0; e < one.electrodes.size(); ++e) {
    const std::string& layer = one.electrodes[e].layer;
    if (layer.empty() || std::ranges::count(chargeable, layer) > 0) continue;
    const bool is_passive = std::ranges::count(names, layer) > 0;
    reader.report(tree.find("electrode")->items.at(e).find("layer")->source,
                  fmt::format("electrode[{}].layer", e + 1),
                  is_passive ? fmt::format("found \"{}\": its material has no permittivity", layer)
                             : fmt::format("found \"{}\": {}{}", layer,
                                           names.empty() ? "there is no [[film.layer]] with a name"
                                                         : "no such layer, allowed " + listed(names),
                                           did_you_mean(layer, names)));
  }
}

/// What lies in a strip's clamps is a capacitance of its electrode.
void check_strip(const WrittenPart& written) {
  const Case& one = written.one;
  const auto* strip = std::get_if<Strip>(&written.part.geometry);
  if (!strip || !(strip->clamped_electrode() > 0)) return;
  const auto electrode = std::ranges::find(one.electrodes, "electrode", &Electrode::place);
  if (electrode != one.electrodes.end() && !electrode->sheet_resistance) return;
  written.reader.report(written.top().find("strip")->find("electrode_length")->source,
                        "strip.electrode_length",
                        electrode == one.electrodes.end()
                            ? "longer than the strip, and no [[electrode]] has the place \"electrode\""
                            : "longer than the strip, which an electrode with a sheet_resistance cannot be");
}

/// What a line, and what is a case of its own, need.
void check_geometry(const WrittenPart& written) {
  const Part& part = written.part;
  const auto report = [&](const char* table, const std::string& message) { written.report(table, message); };
  const bool rolls = std::holds_alternative<AntagonisticRolls>(part.geometry);
  if (rolls && !part.name.empty())
    return report("antagonistic_rolls", "antagonistic rolls are a case of their own, not a part");
  if (std::holds_alternative<Strip>(part.geometry) && !part.name.empty())
    return report("strip", "a strip is a case of its own, not a part");
  if (std::holds_alternative<Roll>(part.geometry) && !part.name.empty())
    return report("roll", "a roll is a case of its own, not a part");
  if (std::holds_alternative<Balloon>(part.geometry) && !part.name.empty())
    return report("balloon", "a balloon is a case of its own, not a part");
  for (const char* leaf : {"hinge", "ribbon"})
    if (rolls && !written.top().find(leaf))
      written.reader.report(written.top().find("antagonistic_rolls")->key_source, leaf,
                            fmt::format("missing; [antagonistic_rolls] need a section [{}]", leaf));
    else if (!rolls && written.top().find(leaf))
      report(leaf, "only for [antagonistic_rolls]");
  if (rolls && part.ribbon && part.ribbon->length <= std::get<AntagonisticRolls>(part.geometry).arm)
    report("ribbon",
           "its length must be above antagonistic_rolls.arm: it leads from the arm's end to the roll");
  if (!std::holds_alternative<Line>(part.geometry)) return;
  const auto on_lines = [](const PartKind& kind) { return kind.line != nullptr; };
  const auto is = [&](const PartKind& kind) { return on_lines(kind) && kind.is(part); };
  if (std::ranges::none_of(part_kinds(), is))
    report("line", fmt::format("a line is {}", words_of_kinds(on_lines)));
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
    reader.report(tree.source, "part",
                  "solids and other films (membranes, shells, rods) cannot be in one case: give all films "
                  "section = \"solid\", or none");
  const auto has_potential = [](const Film& film) { return film.potential; };
  if (one.any_film(has_potential) && one.any_film(std::not_fn(has_potential)))
    reader.report(tree.source, "part", "give all solids of a case the same field");
  if (one.chamber && one.chamber->place.empty())
    reader.report(tree.find("chamber")->source, "chamber.at",
                  "missing; say on which surface of the solid it presses");
}

/// Electrodes with a resistance along them need triangles or meridians of membrane.
void check_resistive_electrodes(SectionReader& reader, const Node& tree, const Case& one) {
  const PartKind* other = nullptr;
  for (const Part& part : one.parts)
    if (const PartKind* kind = kind_of(part); kind && kind->add && !kind->resists_along) other = kind;
  for (std::size_t e = 0; other && e < one.electrodes.size(); ++e)
    if (one.electrodes[e].sheet_resistance)
      reader.report(
          tree.find("electrode")->items.at(e).find("sheet_resistance")->source,
          fmt::format("electrode[{}].sheet_resistance", e + 1),
          fmt::format("the electrodes of {} do not resist; give their circuit a resistance", other->plural));
}

/// What is alike in all directions of its plane may be turned as one likes.
bool may_turn_by_halves_alone(const Part& part) {
  if (std::holds_alternative<Line>(part.geometry)) return false; // it knows its own way
  return !part.film || std::holds_alternative<Patch>(part.geometry) || knows_x_from_y(part);
}

/// The nodes of a body's places move with it already; its own place has no others.
void check_ties(SectionReader& reader, const Node& tree, const Case& one) {
  for (std::size_t t = 0; t < one.ties.size(); ++t)
    for (const std::string& place : one.ties[t].between)
      if (std::ranges::count(one.bodies, place, &Body::name) > 0)
        reader.report(tree.find("tie")->items[t].source, fmt::format("tie[{}].between", t + 1),
                      fmt::format("\"{}\" is a [[body]]: what moves with it stands in its places", place));
}

} // namespace

void check_parts(SectionReader& reader, const Node& tree, const Case& one) {
  for (const Part& part : one.parts) {
    const WrittenPart written{reader, tree, one, part};
    const Node& top = written.top();
    check_patch(written);
    check_stressed_patch(written);
    check_geometry(written);
    check_strip(written);
    for (const PartKind& kind : part_kinds())
      if (kind.check) kind.check(written);
    std::vector<const PartKind*> bars;
    for (const PartKind& kind : part_kinds())
      if (kind.bars && kind.is(part)) bars.push_back(&kind);
    const auto report = [&](const std::string& table, const std::string& message) {
      written.report(table, message);
    };
    if (bars.size() > 1)
      report(bars[1]->word,
             fmt::format("a part is a [{}] or a [{}], not both", bars[0]->word, bars[1]->word));
    if (part.name.empty()) continue;
    const auto geometries = geometries_of(top);
    if (geometries.size() > 1)
      reader.report(geometries[1]->key_source, written.path(""),
                    fmt::format("there are {} geometries; a part has one", geometries.size()));
    if (!part.place.empty() && !geometries.empty())
      report("place", "given twice: a part is a place of the mesh or has a geometry of its own");
    if (part.place.empty() && geometries.empty())
      report("", "a part needs a place of the mesh at the top of the file, or a geometry of its own");
    if (!part.place.empty() && !(one.unnamed() && one.unnamed()->has_mesh()))
      report("place", "there is no mesh at the top of the file whose place it could be");
    if (part.film && !bars.empty()) report(bars[0]->word, "a part is a film or bars, not both");
    if (!part.film && bars.empty())
      report("", "a part needs " +
                     words_of_kinds([](const PartKind& kind) { return kind.bars != nullptr; }, "a [film]"));
    if (!bars.empty() && !geometries.empty() && !std::holds_alternative<Line>(part.geometry))
      report(bars[0]->word, "bars are a [line], or lines of a mesh: give the part a place");
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
    if (may_turn_by_halves_alone(part) && std::abs(half_turns - std::round(half_turns)) > 1e-9)
      report("turned", "a patch, or a film that is not alike along x and y, can be turned by 180 deg only");
  }
  check_ties(reader, tree, one);
  check_surfaces(reader, tree, one);
  check_layers(reader, tree, one);
  check_resistive_electrodes(reader, tree, one);
  const auto wrinkles = [](const Film& film) { return film.tension_field; };
  if (one.any_film(wrinkles) && one.any_film(std::not_fn(wrinkles)))
    reader.report(tree.find("part")->key_source, "part",
                  "one film wrinkles and another does not; give all films of a case the same wrinkling");
  if (one.unnamed() && one.unnamed()->film && !one.unnamed()->has_mesh())
    reader.report(tree.find("film")->key_source, "film",
                  "a film without geometry; add one, or give each [part.NAME] its own [part.NAME.film]");
  if (const Node* mesh = tree.find("mesh"); mesh && !(one.unnamed() && one.unnamed()->has_mesh()))
    reader.report(mesh->key_source, "mesh",
                  "a mesh without geometry; write [part.NAME.mesh] for each part that has one");
  if (reader.diagnostics().empty() && !one.any_film([](const Film&) { return true; })) {
    const Node* parts = tree.find("part");
    reader.report(parts ? parts->key_source : tree.source, "part",
                  "no part is a film, and a case has one at least; bars lie beside it: give it a [film], or "
                  "a [part.NAME.film] that is held beside them");
  }
}

} // namespace dielast::cases
