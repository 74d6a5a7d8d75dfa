// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/rules.hpp"

#include "cases/case/holding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace dielast::cases {
namespace {

/// What slides has no way back, and no time of its own.
void check_friction(SectionReader& reader, const Node& tree, const Case& one, const char* of) {
  const Node* steps = tree.find("step");
  for (std::size_t s = 0; steps && s < one.steps.size(); ++s) {
    const Step& step = one.steps[s];
    const auto report = [&](const char* message) {
      reader.report(steps->items.at(s).source, fmt::format("step[{}]", s + 1),
                    fmt::format(fmt::runtime(message), of));
    };
    if (step.duration || step.is_analysis())
      report("friction of the {} is for ramps that take no time");
    else if (step.response == Response::instantaneous)
      report("friction of the {} flows with the branches; use response = \"relaxed\"");
    if (step.on_instability != OnInstability::stop)
      report("no path is followed or jumped along with friction of the {}");
  }
}

/// Surfaces that are kept apart, and what holds their solids.
void check_surfaces_in_contact(SectionReader& reader, const Node& contact, const Case& one) {
  const auto report = [&](const std::string& message) {
    reader.report(contact.find("between")->source, "contact.between", message);
  };
  if (!one.any_film([](const Film& film) { return film.is_solid(); }))
    return report("only for surfaces of solids");
  const std::vector<std::string>& places = one.contact->between;
  for (auto place = places.begin(); place != places.end(); ++place)
    if (std::find(places.begin(), place, *place) != place)
      report(fmt::format("\"{}\" stands there twice: a surface does not touch itself", *place));
  if (one.supports.empty() && one.bodies.empty() && !one.table)
    report("nothing holds the solids, which would fly apart; hold places of each with [[support]]");
  std::optional<double> width;
  for (const Part& part : one.parts) {
    if (!part.film || one.dimension != fem::Dimension::planar) continue;
    if (width && *width != part.film->width) report("solids that touch in plane strain have one film.width");
    width = part.film->width;
  }
}

/// A device that nothing holds bears no weight: it would fall.
void check_held(SectionReader& reader, const Node& tree, const Case& one) {
  bool weighs = false;
  for (std::size_t s = 0; s < one.steps.size(); ++s) {
    weighs = weighs || one.steps[s].kind == StepKind::weight;
    if (!weighs || !is_free(one, holding_in(one, one.steps, static_cast<int>(s)).supports)) continue;
    const StepPlace at = place_of_step(tree, s);
    return reader.report(
        at.source, at.key,
        "nothing holds the device: the nodes that keep it from drifting bear here its weight; "
        "hold it with [[support]]");
  }
}

} // namespace

void check_contact(SectionReader& reader, const Node& tree, const Case& one) {
  const auto report = [&](const char* section, const char* message) {
    reader.report(tree.find(section)->source, section, message);
  };
  if (one.table && !one.any_film([](const Film& film) { return film.is_solid(); }))
    report("table", "only for solids");
  if (one.table && !one.contact) report("table", "needs [contact], which says how thick its barrier is");
  const auto* roll = one.geometry<Roll>();
  const bool core = roll && roll->core == RollCore::one_sided;
  if (core && !one.contact)
    reader.report(tree.find("roll")->find("core")->source, "roll.core",
                  "a one-sided core needs [contact], which says how thick its barrier is");
  if (core && one.contact && one.contact->thickness >= roll->radius)
    reader.report(tree.find("contact")->find("thickness")->source, "contact.thickness",
                  "it leaves no room for a core: it must be below roll.radius");
  const bool walls = one.any_geometry<Honeycomb>() && one.dimension == fem::Dimension::planar;
  const bool surfaces = one.contact && !one.contact->between.empty();
  if (one.contact && !one.table && !walls && !core && !surfaces)
    report("contact", "is between the walls of a planar [honeycomb], surfaces of solids (between = [...]), a "
                      "solid and a [table], or a [roll] and its one-sided core");
  if (surfaces) check_surfaces_in_contact(reader, *tree.find("contact"), one);
  if (surfaces && one.contact->friction > 0) check_friction(reader, tree, one, "[contact]");
  if (!one.table || !one.any_film(std::mem_fn(&Film::is_solid))) return;
  if (one.table->friction > 0) return check_friction(reader, tree, one, "[table]");
  const auto slides = [&](std::size_t axis) {
    const auto holds = [&](const auto& what) { return what.fixed[axis]; };
    return std::ranges::none_of(one.supports, holds) &&
           std::ranges::none_of(one.bodies, [&](const Body& body) { return holds(body) || body.pivot; });
  };
  if (one.dimension == fem::Dimension::planar && slides(0))
    report("table", "without friction nothing keeps the solid from sliding away; fix x of a "
                    "place");
  if (one.dimension == fem::Dimension::spatial && (slides(0) || slides(2)))
    report("table", "without friction nothing keeps the solid from sliding away; fix x of a place, and z of "
                    "one");
}

void check_supports(SectionReader& reader, const Node& tree, const Case& one) {
  const Node* list = tree.find("support");
  for (std::size_t i = 0; list && i < list->items.size(); ++i) {
    const Support& support = one.supports[i];
    bool holds = false;
    for (int c = 0; c < fem::DofMap::components; ++c)
      holds = holds || (support.fixed[static_cast<std::size_t>(c)] && fem::moves(one.dimension, c));
    if (const Node* fixed = list->items[i].find("fix"); !holds && fixed && fixed->source.is_written())
      reader.report(fixed->source, fmt::format("support[{}].fix", i + 1),
                    fmt::format("found {}, which holds nothing: {}", text_of(*fixed),
                                one.dimension == fem::Dimension::planar
                                    ? "a planar model moves along x and y, and turns about z"
                                    : "an axisymmetric model moves along x, the radius, and z"));
    const auto from = std::ranges::find(one.steps, support.from, &Step::name),
               until = std::ranges::find(one.steps, support.until, &Step::name);
    for (const auto& [key, step] : {std::pair{"from", from}, {"until", until}})
      if (step != one.steps.end() && step->is_analysis())
        reader.report(list->items[i].find(key)->source, fmt::format("support[{}].{}", i + 1, key),
                      fmt::format("found \"{}\": in a step of this kind no support changes; name the step "
                                  "before it",
                                  step->name));
    if (until != one.steps.end() && !until->is_analysis() && until + 1 != one.steps.end() &&
        std::all_of(until + 1, one.steps.end(), std::mem_fn(&Step::is_analysis)))
      reader.warn(list->items[i].find("until")->source, fmt::format("support[{}].until", i + 1),
                  "has no effect here: steps of kind \"modes\" and \"harmonic\" are about the state that the "
                  "step before them leaves; put one between them in which it lets go, such as \"relax\"");
    if (!support.from.empty() && !support.until.empty() && until < from)
      reader.report(list->items[i].find("until")->source, fmt::format("support[{}].until", i + 1),
                    fmt::format("found \"{}\", which is before \"{}\", the first step in which it holds",
                                support.until, support.from));
  }
  check_held(reader, tree, one);
}

} // namespace dielast::cases
