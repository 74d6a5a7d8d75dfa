// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/conditions.hpp"
#include "cases/tables/parameter_keys.hpp"
#include "materials/catalog.hpp"

#include <fmt/format.h>

namespace dielast::cases {

/// Access to a geometry of a Part.
template<class T>
Access geometry_of_type() {
  return {[](void* parent, const std::string&) -> void* {
            return &static_cast<Part*>(parent)->geometry.emplace<T>();
          },
          [](const void* parent) {
            const T* present = std::get_if<T>(&static_cast<const Part*>(parent)->geometry);
            return present ? std::vector<Access::Entry>{{"", present}} : std::vector<Access::Entry>{};
          }};
}

// Geometries.
Section line_section();
Section rolls_section();

/// Of a lattice's walls.
Key wall_print();

/// A named solid, or a table of its parameters. `beam(object)` returns a reference to the Beam in the object.
template<class T, class Bars>
Section bar_material_section(std::string name, Bars beam) {
  Section section;
  section.meaning = fmt::format("a named material ({} = \"...\"), or a table", name);
  section.name = std::move(name);
  section.fallback = "TPU 78 MPa";
  section.access = same_object();
  section.names = [] {
    std::vector<std::string> names;
    for (const auto& solid : materials::named_solids()) names.emplace_back(solid.name);
    return names;
  };
  section.start = [beam](void* object, const std::string& wanted) {
    for (const auto& named : materials::named_solids())
      if (named.name == wanted) {
        beam(*static_cast<T*>(object)).material = named.solid;
        return true;
      }
    return false;
  };
  section.keys.push_back(
      text("name", to_part<T>([beam](auto& object) -> auto& { return beam(object).material_name; }),
           "a named material to start from, or a label")
          .optional());
  add_parameter_keys<T, materials::ElasticSolid>(section.keys,
                                                 [beam](auto& object) { return &beam(object).material; });
  for (Key& key : section.keys)
    if (key.name == "density") key.acts = when::masses_matter();
  return section;
}

} // namespace dielast::cases
