// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/part_kind.hpp"
#include "cases/language/schema.hpp"

#include <algorithm>

namespace dielast::cases {
namespace {

/// What the file says at its top is about the part without a name.
Section of_unnamed_part(Section section) {
  const Access inner = section.access;
  section.access.enter = [inner](void* parent, const std::string& name) {
    auto& parts = static_cast<Case*>(parent)->parts;
    if (parts.empty()) parts.emplace_back();
    return inner.enter(&parts.front(), name);
  };
  section.access.entries = [inner](const void* parent) {
    const Part* part = static_cast<const Case*>(parent)->unnamed();
    return part ? inner.entries(part) : std::vector<Access::Entry>{};
  };
  return section;
}

bool has_geometry(const Node& table) {
  const Node* mesh = table.find("mesh");
  if (mesh && mesh->find("file")) return true;
  return std::ranges::any_of(geometry_sections(),
                             [&](const Section& section) { return table.find(section.name); });
}

/// Where parts, or a place, stand for a mesh.
bool is_without_mesh(const Node& outer) {
  return !has_geometry(outer) && (outer.find("part") || outer.find("place"));
}

/// A binding that gives nothing of a part that is a place: its position is that of another's mesh.
Binding of_own_mesh(Binding binding) {
  binding.get = [get = std::move(binding.get)](const void* part) {
    return static_cast<const Part*>(part)->place.empty() ? get(part) : std::nullopt;
  };
  return binding;
}

} // namespace

std::vector<Section> unnamed_part_sections() {
  std::vector<Section> sections{film_section()};
  sections.front().needless = [](const Node& outer) { return outer.find("part") != nullptr; };
  for (const PartKind& kind : part_kinds())
    if (kind.at_top) sections.push_back(kind.table());
  for (Section& section : geometry_sections()) sections.push_back(std::move(section));
  for (Section& section : leaf_sections()) sections.push_back(std::move(section));
  for (Section& section : region_sections()) sections.push_back(std::move(section));
  sections.push_back(mesh_section());
  sections.back().needless = is_without_mesh;
  for (Section& section : sections) section = of_unnamed_part(std::move(section));
  return sections;
}

std::vector<Section> part_sections() {
  Section part;
  part.name = "part";
  part.meaning =
      "one of several films, or bars beside them, with a geometry of its own or in a place of the mesh; "
      "a case has one film at least";
  part.shape = Section::Shape::named;
  part.presence = Section::Presence::optional;
  part.access = {[](void* parent, const std::string& name) -> void* {
                   auto& parts = static_cast<Case*>(parent)->parts;
                   parts.emplace_back().name = name;
                   return &parts.back();
                 },
                 [](const void* parent) {
                   std::vector<Access::Entry> entries;
                   for (const Part& one : static_cast<const Case*>(parent)->parts)
                     if (!one.name.empty()) entries.push_back({one.name, &one});
                   return entries;
                 }};
  part.keys = {
      text("place", to(&Part::place),
           "the place of the mesh at the top of the file that it is; without it the part has a geometry of "
           "its own")
          .refers_to(Reference::place)
          .optional(),
      measure("at", "m", of_own_mesh(to(&Part::at)), "where the origin of its own geometry is")
          .values(3, 3)
          .otherwise("[0, 0, 0]"),
      measure(
          "turned", "rad", of_own_mesh(to(&Part::turned)),
          "angle by which its own geometry is turned about z, before it is placed; its standard quantities "
          "along x and y turn with it by 90 deg, by other angles distances are those along the straight line "
          "and sizes are left out")
          .otherwise("0 deg"),
  };
  part.sections.push_back(film_section());
  part.sections.back().presence = Section::Presence::optional;
  for (const PartKind& kind : part_kinds())
    if (kind.table) part.sections.push_back(kind.table());
  for (Section& section : geometry_sections()) part.sections.push_back(std::move(section));
  part.sections.push_back(mesh_section());
  part.sections.back().needless = is_without_mesh;
  Section tie =
      list_section("tie", "nodes that two places have at the same points become one", each(&Case::ties));
  tie.keys = {
      text("between", to(&TiedPlaces::between), "the two places").values(2, 2).refers_to(Reference::place)};
  return {std::move(part), std::move(tie)};
}

} // namespace dielast::cases
