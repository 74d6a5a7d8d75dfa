// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/rules.hpp"

#include "cases/case/quantities.hpp"
#include "cases/language/conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace dielast::cases {
namespace {

/// Reports at a section of the tree, or at the file as a whole for what a template has brought.
void report_at(SectionReader& reader, const Node& tree, const std::string& section,
               const std::string& message) {
  const Node* node = tree.find(section);
  reader.report(node ? node->source : tree.source, section, message);
}

/// Reports at the first step that is such.
template<class Rule>
void report_step(SectionReader& reader, const Node& tree, const Case& one, const Rule& is_such,
                 const std::string& message) {
  const auto found = std::ranges::find_if(one.steps, is_such);
  if (found == one.steps.end()) return;
  const StepPlace at = place_of_step(tree, static_cast<std::size_t>(found - one.steps.begin()));
  reader.report(at.source, at.key, message);
}
auto of_kind(StepKind kind) {
  return [kind](const Step& step) { return step.kind == kind; };
}

void check_step_names(SectionReader& reader, const Node& tree, const Case& one) {
  report_step(
      reader, tree, one, [](const Step& step) { return step.name == "drawn"; },
      "found the name \"drawn\", which the history gives the device as it is drawn; call the step otherwise");
}

void check_loads(SectionReader& reader, const Node& tree, const Case& one) {
  if (one.loads.empty())
    report_step(reader, tree, one, of_kind(StepKind::force),
                "a step of kind \"force\" has nothing to apply; add a [[load]]");
  if (one.loads.empty() || has_step(one, {StepKind::force, StepKind::transient})) return;
  report_at(reader, tree, one.loads.front().standard ? "patch" : "load",
            "no step applies it; add a [[step]] with kind = \"force\"");
}

void check_motions(SectionReader& reader, const Node& tree, const Case& one) {
  const auto moved = std::ranges::find_if(one.supports, &Support::moves);
  if (moved == one.supports.end()) {
    report_step(reader, tree, one, of_kind(StepKind::move),
                "a step of kind \"move\" has nothing to move; give a [[support]] a displacement");
  } else if (!has_step(one, {StepKind::move, StepKind::transient})) {
    report_at(reader, tree,
              !moved->standard ? "support"
              : one.pivot      ? "pivot"
                               : "patch",
              "no step moves it; add a [[step]] with kind = \"move\"");
  }
}

void check_drives(SectionReader& reader, const Node& tree, const Case& one) {
  if (one.electrodes.empty())
    for (const char* section : {"drive", "circuit"})
      if (const Node* written = tree.find(section); written && !written->items.empty())
        reader.report(written->source, section,
                      "there is no electrode for it; add an [[electrode]] with a name and a place");
  const auto any_drive = [&](std::optional<Waveform> Drive::*given) {
    return std::ranges::any_of(one.drives, [&](const auto& d) { return (d.second.*given).has_value(); });
  };
  const bool charge = any_drive(&Drive::charge);
  const bool driven =
      charge || any_drive(&Drive::voltage) || std::ranges::any_of(one.steps, [](const Step& step) {
        return step.to && (step.kind == StepKind::voltage || step.kind == StepKind::charge);
      });
  for (std::size_t s = 0; s < one.steps.size() && !one.electrodes.empty(); ++s) {
    const Step& step = one.steps[s];
    const bool charges = step.kind == StepKind::charge;
    if ((!charges && step.kind != StepKind::voltage) || step.to) continue;
    const bool leads = std::ranges::any_of(one.drives, [&](const auto& drive) {
      return (step.electrode.empty() || step.electrode == drive.first) &&
             (charges ? drive.second.charge : drive.second.voltage).has_value();
    });
    const StepPlace at = place_of_step(tree, s);
    if (const char* what = charges ? "charge" : "voltage"; !leads && (charges || driven))
      reader.report(at.source, at.key,
                    fmt::format("a step of kind \"{0}\" has no {0} to reach; give [drive] a {0}", what));
  }
  if (charge && std::ranges::none_of(one.steps, [](const Step& step) {
        return step.kind == StepKind::charge ||
               (step.kind == StepKind::transient && step.control == Control::charge);
      }))
    report_at(reader, tree, "drive", "no step applies its charge; add a [[step]] with kind = \"charge\"");
}

/// Whether a support held until the step before.
bool lets_go(const Case& one, std::size_t step) {
  while (step-- > 0) {
    if (std::ranges::count(one.supports, one.steps[step].name, &Support::until) > 0) return true;
    if (!one.steps[step].is_analysis()) return false;
  }
  return false;
}

void check_masses(SectionReader& reader, const Node& tree, const Case& one) {
  for (std::size_t s = 0; s < one.steps.size(); ++s) {
    const Step& step = one.steps[s];
    const StepPlace at = place_of_step(tree, s);
    if (step.kind == StepKind::modes && !has_mass(one))
      reader.report(at.source, at.key,
                    "nothing vibrates: film, bars, plate and point masses have no mass; give plate.mass or "
                    "film.material.density");
    const auto weightless = [](const auto& all) {
      return std::ranges::all_of(all, [](const auto& body) { return body.mass == 0; });
    };
    if (step.kind == StepKind::weight && !one.plate && one.point_masses.empty() && one.bodies.empty() &&
        !one.gravity.film)
      reader.report(
          at.source, at.key,
          "nothing has a weight; add [plate], a [[point_mass]], a [[body]] or [gravity] with film = true");
    else if (step.kind == StepKind::weight && (!one.plate || one.plate->mass == 0) &&
             weightless(one.point_masses) && weightless(one.bodies) && !one.gravity.film)
      reader.warn(at.source, at.key, "has no effect here: nothing has a weight");
    if (step.kind == StepKind::relax && !when::branches().met(one, nullptr) && one.circuits.empty() &&
        !lets_go(one, s) && step.on_instability == OnInstability::stop &&
        std::ranges::none_of(one.electrodes,
                             [](const Electrode& e) { return e.sheet_resistance.has_value(); }))
      reader.warn(at.source, at.key,
                  "has no effect here: without a [[film.material.branch]], a viscosity, a [circuit] or a "
                  "sheet_resistance nothing flows");
    if ((step.kind == StepKind::move || step.kind == StepKind::inflate) &&
        step.response == Response::instantaneous &&
        std::ranges::any_of(one.film_materials(),
                            [](const auto* material) { return material->viscosity > 0; }))
      reader.report(
          at.source, at.key + ".response",
          "found \"instantaneous\": a film with a viscosity resists what is moved in no time with an "
          "infinite force; let it take time, by kind = \"transient\" and a ramp");
    const auto& [x, y, z] = one.gravity.direction;
    const Node* gravity = tree.find("gravity");
    const Node* direction = gravity ? gravity->find("direction") : nullptr;
    const auto report_direction = [&](const char* message) {
      reader.report(direction ? direction->source : at.source, direction ? "gravity.direction" : at.key,
                    message);
    };
    if (step.kind == StepKind::weight && one.dimension == fem::Dimension::planar && !one.plate && x == 0 &&
        y == 0)
      report_direction("a planar model does not move along z; give [gravity] a direction in the plane");
    if (step.kind == StepKind::weight && one.dimension == fem::Dimension::axisymmetric && (x != 0 || y != 0))
      report_direction("a model of revolution moves along z alone; use model = \"3d\"");
    if (step.kind != StepKind::harmonic) continue;
    if (one.electrodes.empty())
      reader.report(at.source, at.key, "there is no electrode whose source could swing");
    if (!response_quantity(one, step.response_of))
      reader.report(at.source, at.key + ".response_of",
                    "needs a quantity of kind " + response_kinds(" with a direction (along)"));
  }
}

/// Gravity that is written pulls at masses of bodies alone, unless it says otherwise.
void check_own_weight(SectionReader& reader, const Node& tree, const Case& one) {
  const Node* gravity = tree.find("gravity");
  const bool falls = std::ranges::count(one.steps, StepKind::weight, &Step::kind) > 0;
  if (!gravity || gravity->find("film") || one.gravity.film || !falls) return;
  const auto weighs = [](const materials::Material* material) { return material->density > 0; };
  if (std::ranges::any_of(one.parts, has_heavy_bars) || std::ranges::any_of(one.film_materials(), weighs))
    reader.warn(gravity->source, "gravity",
                "the own weight of film and bars is left out here, though they have a density: film = true "
                "counts it, film = false says that it shall be so");
}

/// A given charge stays what it is, whatever leaks.
void check_leaks(SectionReader& reader, const Node& tree, const Case& one) {
  const auto leaks = [](const auto& circuit) { return circuit.second.leakage_resistance.has_value(); };
  const auto leaks_under_a_charge = [&](const auto& circuit) {
    const auto drive = one.drives.find(circuit.first);
    return leaks(circuit) && drive != one.drives.end() && drive->second.charge;
  };
  const bool any = std::ranges::any_of(one.circuits, leaks);
  const bool any_given = std::ranges::any_of(one.circuits, leaks_under_a_charge);
  for (std::size_t s = 0; any && s < one.steps.size(); ++s) {
    const Step& step = one.steps[s];
    const bool isolated = step.control == Control::charge;
    const bool given = (step.kind == StepKind::charge && step.duration && (step.to || any_given)) ||
                       (step.kind == StepKind::transient && isolated && any_given);
    const StepPlace at = place_of_step(tree, s);
    if (given)
      reader.warn(at.source, at.key,
                  "charges that are given here stay what they are: their sources give what leaks, too");
    if (step.kind == StepKind::relax && isolated)
      reader.report(
          at.source, at.key + ".control",
          "isolated electrodes with a leakage_resistance lose their charges to the end: to that state "
          "leads a step of kind \"voltage\" with to = \"0 V\"; they lose a part of them while time "
          "passes, in a \"hold\"");
  }
}

void check_bodies(SectionReader& reader, const Node& tree, const Case& one) {
  const Node* written = tree.find("body");
  if (one.chamber && !one.bodies.empty())
    reader.report(
        tree.find("chamber")->key_source, "chamber",
        fmt::format(
            "its volume under a [[body]], which may tilt or close it, is not known; here is "
            "\"{}\"{}",
            one.bodies.front().name,
            written->items.front().source.is_written()
                ? ". A [plate] may take its place"
                : ", which the geometry brings: leave [chamber] out. A tube with a pressure inside may be a "
                  "[slab] of solid, of revolution, with chamber.at = \"left\""));
  for (std::size_t f = 0; f < one.fins.size(); ++f)
    if (!fem::moves(one.dimension, one.fins[f].along))
      reader.report(tree.find("fin")->items[f].source, fmt::format("fin[{}].along", f + 1),
                    "a planar model does not move along z");
  for (std::size_t b = 0; b < one.bodies.size(); ++b) {
    const Body& body = one.bodies[b];
    for (std::size_t s = 0; s < one.supports.size(); ++s)
      if (const std::string& place = one.supports[s].place; std::ranges::count(body.places, place) > 0) {
        const bool brought = !written->items[b].source.is_written(); // by the geometry
        reader.report(brought ? tree.find("support")->items[s].source : written->items[b].source,
                      brought ? fmt::format("support[{}].place", s + 1)
                              : fmt::format("body[{}].places", b + 1),
                      fmt::format("\"{}\" is {}; fix the body instead", place,
                                  brought ? fmt::format("on the body \"{}\"", body.name)
                                  : tree.find("support")->items[s].source.is_written()
                                      ? std::string("held by a [[support]]")
                                      : std::string("held by a [[support]] that the geometry brings where "
                                                    "the case has none (write one for what is to stand)")));
      }
    const bool spatial = one.dimension == fem::Dimension::spatial;
    const auto& moment = body.inertia;
    const bool turns = spatial ? !(body.fixed[3] && body.fixed[4] && body.fixed[5])
                               : fem::moves(one.dimension, 5) && !body.fixed[5];
    const bool moves = has_step(one, {StepKind::modes}) || std::ranges::any_of(one.steps, &Step::inertia);
    const bool tilts = spatial && !(body.fixed[3] && body.fixed[4]);
    if (body.mass > 0 && turns && moves && (tilts ? moment[0] + moment[1] : moment[2]) == 0)
      reader.report(written->items[b].source, fmt::format("body[{}].inertia", b + 1),
                    "missing; what moves with inertia and can turn has moments of inertia");
  }
}

void check_chamber(SectionReader& reader, const Node& tree, const Case& one) {
  const auto need = [&](StepKind kind, const char* word, bool given) {
    for (std::size_t s = 0; s < one.steps.size(); ++s)
      if (const StepPlace at = place_of_step(tree, s);
          one.steps[s].kind == kind && !given && (!one.chamber || !one.steps[s].to))
        reader.report(at.source, at.key, fmt::format("has nothing to reach; give [chamber] a {}", word));
  };
  need(StepKind::pressure, "pressure", one.chamber && one.chamber->pressure);
  need(StepKind::inflate, "volume", one.chamber && one.chamber->volume);
}

/// Linear models have no unknowns for the voltages along a sheet.
void check_sheets(SectionReader& reader, const Node& tree, const Case& one) {
  if (!is_linearised(one)) return;
  for (std::size_t e = 0; e < one.electrodes.size(); ++e)
    if (one.electrodes[e].sheet_resistance)
      reader.report(
          tree.find("electrode")->items.at(e).find("sheet_resistance")->source,
          fmt::format("electrode[{}].sheet_resistance", e + 1),
          "steps of kind \"harmonic\" and [linearise] know of no resistance along an electrode; leave "
          "it out, or follow a sine in a step of kind \"transient\"");
}

/// What moves along an axis needs a model that moves along it.
void check_axes(SectionReader& reader, const Node& tree, const Case& one) {
  constexpr std::array names{"x", "y", "z"};
  const auto check = [&](const Node* node, const std::string& key, int axis) {
    if (node && node->source.is_written() && !fem::moves(one.dimension, axis))
      reader.report(node->source, key,
                    fmt::format("found {}: {} model does not move along {}", text_of(*node),
                                one.dimension == fem::Dimension::planar ? "a planar" : "an axisymmetric",
                                names[static_cast<std::size_t>(axis)]));
  };
  const Node* supports = tree.find("support");
  for (std::size_t i = 0; supports && i < supports->items.size(); ++i)
    if (const Node* motion = supports->items[i].find("displacement"))
      for (int axis = 0; axis < 3; ++axis) {
        const char* name = names[static_cast<std::size_t>(axis)];
        check(motion->find(name), fmt::format("support[{}].displacement.{}", i + 1, name), axis);
      }
  const auto check_list = [&](const char* section, const auto& objects) {
    const Node* list = tree.find(section);
    for (std::size_t i = 0; list && i < list->items.size() && i < objects.size(); ++i)
      check(list->items[i].find("along"), fmt::format("{}[{}].along", section, i + 1), objects[i].along);
  };
  check_list("spring", one.springs);
  check_list("linkage", one.linkages);
  check_list("profile", one.profiles);
}

/// What moves out of its plane, or has none.
void check_dimension(SectionReader& reader, const Node& tree, const Case& one) {
  const bool annulus = one.geometry<Annulus>();
  const bool round = annulus || one.geometry<Disc>();
  const bool balloon = one.geometry<Balloon>();
  const bool sphere = one.any_geometry<HollowSphere>();
  const bool roll = one.geometry<Roll>();
  const bool of_revolution = one.dimension == fem::Dimension::axisymmetric;
  if (sphere && one.dimension == fem::Dimension::planar)
    report_at(reader, tree, "model",
              "a hollow sphere is of revolution, or its eighth in space: model = \"axisymmetric\" or \"3d\"");
  if (roll && !of_revolution)
    report_at(reader, tree, "model", "a roll is a film of revolution: model = \"axisymmetric\"");
  if (balloon && !of_revolution)
    report_at(reader, tree, "model", "a balloon is a film of revolution: model = \"axisymmetric\"");
  if (of_revolution && !round && !balloon && !roll && !sphere && !one.any_geometry<Slab>())
    report_at(reader, tree, "model",
              "\"axisymmetric\" is for [disc], [annulus], [balloon], [roll], [slab] and [hollow_sphere]");
  if (of_revolution && !roll && std::ranges::any_of(one.parts, knows_x_from_y))
    report_at(reader, tree, "film",
              "a film of revolution is alike in all directions: one prestretch, dashpot = \"log\"");
  if (one.dimension == fem::Dimension::planar)
    for (const char* section : {"plate", "chamber"})
      if (tree.find(section))
        report_at(reader, tree, section,
                  "a planar model does not move along z; use model = \"axisymmetric\" or \"3d\"");
  if (balloon && !one.chamber) report_at(reader, tree, "balloon", "a balloon needs a [chamber]");
}

} // namespace

StepPlace place_of_step(const Node& tree, std::size_t number) {
  const Node& item = tree.find("step")->items.at(number);
  return {item.source.line > 0 ? fmt::format("step[{}]", number + 1) : "step", item.source};
}

void check_rules(SectionReader& reader, const Node& tree, const Case& one) {
  if (!reader.diagnostics().empty()) return; // these would complain of what is only misspelt
  check_step_names(reader, tree, one);
  check_loads(reader, tree, one);
  check_motions(reader, tree, one);
  check_drives(reader, tree, one);
  check_waves(reader, tree, one);
  check_masses(reader, tree, one);
  check_own_weight(reader, tree, one);
  check_leaks(reader, tree, one);
  check_bodies(reader, tree, one);
  check_supports(reader, tree, one);
  check_chamber(reader, tree, one);
  check_contact(reader, tree, one);
  check_sheets(reader, tree, one);
  check_results(reader, tree, one);
  check_axes(reader, tree, one);
  check_dimension(reader, tree, one);
  check_parts(reader, tree, one);
  check_regions(reader, tree, one);
  check_surroundings_of_walls(reader, tree, one);
  check_pivot(reader, tree, one);
}

} // namespace dielast::cases
