// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/warnings/load_warnings.hpp"

#include "cases/text/diagnostics.hpp"
#include "cases/text/tree.hpp"
#include "cases/warnings/held_places.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <variant>

namespace dielast::cases {
namespace {

/// Whether a support holds from the first step with loads to the last one.
bool holds_against_loads(const Case& one, const Support& support) {
  const auto& steps = one.steps;
  const auto first = std::ranges::find_if(steps, [](const Step& step) {
    return step.kind == StepKind::force || step.kind == StepKind::transient;
  });
  const auto named = [&](const std::string& name) { return std::ranges::find(steps, name, &Step::name); };
  return (support.from.empty() || named(support.from) <= first) &&
         (support.until.empty() || named(support.until) + 1 >= steps.end());
}

} // namespace

std::vector<std::string> carrying_warnings(const Case& one) {
  std::vector<std::string> warnings;
  if (one.contact || one.table || one.pivot || std::ranges::any_of(one.steps, &Step::inertia))
    return warnings;
  for (std::size_t s = 0; s < one.supports.size(); ++s)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Support& support = one.supports[s];
      const bool across = one.dimension == fem::Dimension::axisymmetric && axis == 0; // it widens
      if (!support.motion[axis] || across) continue;
      const auto holds = [&](const auto& other) { return other.fixed[axis]; };
      const auto pivots = [](const Body& body) { return body.pivot.has_value(); };
      if (std::ranges::count_if(one.supports, holds) > 1 || std::ranges::any_of(one.bodies, holds) ||
          std::ranges::any_of(one.bodies, pivots))
        continue;
      const bool own = std::ranges::none_of(one.supports, &Support::standard);
      const std::string key = fmt::format("support[{}].displacement.{}", s + 1, "xyz"[axis]);
      warnings.push_back(one.warning_at(
          key, fmt::format("nothing else holds the device along {}: it is carried along with \"{}\" as "
                           "it is{}",
                           "xyz"[axis], support.place,
                           own ? "; the [[support]] of a case stand instead of those that its geometry "
                                 "brings (dielast info tells these), hold such places, too"
                               : "")));
    }
  return warnings;
}

std::string settle_warning(const Case& one, bool attachments_pull) {
  if (attachments_pull)
    return "what is attached to the film pulls as drawn: a step \"settle\" before the first lets it find its "
           "balance; say so by a [[step]] of kind \"release\"";
  const auto pulls = std::ranges::find_if(one.steps, [](const Step& step) {
    return step.kind == StepKind::weight || step.kind == StepKind::force;
  });
  const bool slackens = one.dimension == fem::Dimension::spatial && pulls != one.steps.end();
  return fmt::format(
      "the film is not held in its prestretch{}: a step \"settle\" before the first cuts it free; say so "
      "by a [[step]] of kind \"release\", or hold it by [[support]]{}",
      one.supports.empty() ? ", there is no [[support]]" : "",
      slackens
          ? fmt::format(": where it slackens it buckles, so hold what the step \"{}\" pulls on until = {}",
                        pulls->name, toml_string(pulls->name))
          : "");
}

std::vector<std::string> weight_warnings(const Case& one) {
  std::vector<std::string> warnings;
  if (std::ranges::none_of(one.steps, [](const Step& step) { return step.kind == StepKind::weight; }))
    return warnings;
  for (const Body& body : one.bodies) {
    if (!(body.mass > 0) || body.pivot) continue;
    std::vector<char> held;
    bool follows = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (one.gravity.direction[axis] == 0) continue;
      const bool moves = !body.fixed[axis] && (axis == 2 ? one.dimension != fem::Dimension::planar
                                                         : one.dimension != fem::Dimension::axisymmetric);
      follows = follows || moves;
      if (!moves) held.push_back("xyz"[axis]);
    }
    if (held.empty() || !follows) continue;
    const std::string key = "gravity.direction";
    warnings.push_back(
        one.warning_at(key, fmt::format("has no effect along {} on the body \"{}\", which is held "
                                        "there; a [[body]] of that name with another `fix` is not",
                                        fmt::join(held, " and "), body.name)));
  }
  return warnings;
}

std::vector<std::string> idle_attachments(const Case& one, const meshing::Mesh& mesh,
                                          const fem::DofMap& dofs) {
  const HeldPlaces held(one, mesh, dofs);
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& section, std::size_t number, const char* key,
                        const std::string& why) {
    const std::string path = fmt::format("{}[{}].{}", section, number + 1, key);
    warnings.push_back(one.warning_at(path, "has no effect here: " + why));
  };
  const bool weighs =
      std::ranges::any_of(one.steps, [](const Step& step) { return step.kind == StepKind::weight; });
  for (std::size_t m = 0; m < one.point_masses.size() && !weighs; ++m) { // the support feels a weight
    const std::string& place = one.point_masses[m].place;
    if (held.rests(place, 0) && held.rests(place, 1) && held.rests(place, 2))
      warn("point_mass", m, "place", fmt::format("\"{}\" is held where it is", place));
  }
  const auto check = [&](const char* section, const auto& objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const auto& [first, second] = objects[i].between;
      if (first == second)
        warn(section, i, "between", fmt::format("both places are \"{}\"", first));
      else if (held.rests(first, objects[i].along) && held.rests(second, objects[i].along))
        warn(section, i, "between",
             fmt::format("\"{}\" and \"{}\" are held along {}, and what holds them bears all of it", first,
                         second, "xyz"[objects[i].along]));
    }
  };
  check("spring", one.springs);
  check("linkage", one.linkages);
  return warnings;
}

std::vector<std::string> warnings_of_held_quantities(const Case& one, const meshing::Mesh& mesh,
                                                     const fem::DofMap& dofs) {
  const HeldPlaces held(one, mesh, dofs);
  std::vector<std::string> warnings;
  int number = 0;
  for (const Quantity& quantity : one.quantities) {
    if (quantity.standard) continue;
    ++number;
    if (quantity.kind->word != "displacement" || !mesh.node_sets.contains(quantity.of)) continue;
    const bool falls = quantity.along == along_gravity;
    bool rests = true;
    for (int axis = 0; axis < 3; ++axis)
      if (falls ? one.gravity.direction[axis] != 0 : quantity.along.value_or(axis) == axis)
        rests = rests && held.rests(quantity.of, axis);
    if (rests)
      warnings.push_back(
          one.warning_at(fmt::format("quantity[{}].of", number),
                         fmt::format("all nodes of \"{}\" are held{}: \"{}\" is always 0", quantity.of,
                                     falls            ? " along gravity"
                                     : quantity.along ? fmt::format(" along {}", "xyz"[*quantity.along])
                                                      : "",
                                     quantity.name)));
  }
  return warnings;
}

std::vector<std::string> load_warnings(const Case& one, const meshing::Mesh& mesh, const fem::DofMap& dofs) {
  const auto lets_go = [&](int node, int c) {
    return std::ranges::any_of(one.supports, [&](const Support& support) {
      return support.fixed[static_cast<std::size_t>(c)] && !holds_against_loads(one, support) &&
             std::ranges::count(mesh.node_sets.at(support.place), node) > 0;
    });
  };
  std::vector<std::string> warnings;
  for (std::size_t l = 0; l < one.loads.size(); ++l) {
    const Load& load = one.loads[l];
    if (load.standard) continue;
    const auto& nodes = mesh.node_sets.at(load.place);
    std::vector<char> axes;
    for (int c = 0; c < fem::DofMap::components; ++c) {
      const Waveform* wave = load.component(c);
      if (!wave || *wave == Waveform::constant_at(0)) continue;
      const bool held = std::ranges::all_of(nodes, [&](int node) {
        const int e = dofs.equation(node, c);
        return e == fem::DofMap::absent || (dofs.is_held(e) && !lets_go(node, c));
      });
      if (held) axes.push_back("xyz"[c % 3]);
    }
    if (axes.empty()) continue;
    const auto body = std::ranges::find(one.bodies, load.place, &Body::name);
    const bool at_pivot = !load.moment && body != one.bodies.end() && body->pivot;
    const std::string key = fmt::format("load[{}].{}", l + 1, load.moment ? "moment" : "force");
    warnings.push_back(one.warning_at(
        key, fmt::format("has no effect {} {}: \"{}\" is held there while it acts{}",
                         load.moment ? "about" : "along", fmt::join(axes, " and "), load.place,
                         at_pivot ? "; a force on a body with a pivot acts at the pivot: write its "
                                    "moment about that point, moment = [...], instead"
                                  : "")));
  }
  return warnings;
}

std::vector<std::string> pressure_warnings(const Case& one, const meshing::Mesh& mesh,
                                           std::span<const int> parts, const fem::DofMap& dofs) {
  std::vector<std::string> warnings;
  for (std::size_t p = 0; p < one.parts.size(); ++p) {
    const auto& film = one.parts[p].film;
    if (!film || !film->is_solid() || film->bulk_modulus ||
        std::holds_alternative<materials::StVenantKirchhoff>(film->material.law))
      continue;
    const auto is_held = [&dofs](int node) {
      return std::ranges::all_of(std::array{0, 1, 2}, [&](int c) {
        const int e = dofs.equation(node, c);
        return e == fem::DofMap::absent || dofs.is_held(e);
      });
    };
    bool held = true;
    for (int cell = 0; held && cell < mesh.film()->size(); ++cell)
      held = parts[static_cast<std::size_t>(cell)] != static_cast<int>(p) ||
             std::ranges::all_of(mesh.film()->cell(cell), is_held);
    if (!held) continue;
    const std::string key = one.parts[p].key_prefix() + "film.bulk_modulus";
    warnings.push_back(one.warning_at(
        key, "is missing: this solid is held everywhere and incompressible, so that nothing tells "
             "its pressures, and the tangent is singular"));
  }
  return warnings;
}

} // namespace dielast::cases
