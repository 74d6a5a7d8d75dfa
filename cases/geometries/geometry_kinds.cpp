// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/geometries/geometry_kinds.hpp"

#include "cases/language/conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace dielast::cases {
namespace {

Binding mesh_file() {
  return {[](void* object, const Value& value) {
            static_cast<Part*>(object)->geometry = MeshFile{value.at(0).text};
          },
          [](const void* object) -> std::optional<Value> {
            const auto* file = std::get_if<MeshFile>(&static_cast<const Part*>(object)->geometry);
            return file ? value_of(file->path) : std::nullopt;
          }};
}

std::vector<Key> file_keys() {
  return {
      text(
          "file", mesh_file(),
          "the user's own gmsh mesh (MSH 4.1 or 2.2), beside the case file; physical names are places; or a "
          "closed surface (.stl, .ply, .off), which is filled with tetrahedra: places face_1, face_2 ... end "
          "where its triangles meet at more than 30 deg, x_min ... z_max lie in the sides of the box around "
          "it"),
      measure("size", "m", mesh_option(&MeshOptions::size),
              "of a surface: longest side, nearly, of its tetrahedra; without it a tenth of its extent")
          .above(0)
          .optional()
          .only_with(when::fills_a_surface()),
      measure(
          "unit", "m", mesh_option(&MeshOptions::unit),
          "what one unit of length of the file stands for; without it 1 m, and a warning says how large the "
          "film is")
          .above(0)
          .optional(),
      integer("refine", mesh_option(&MeshOptions::refine),
              "how often each triangle of the file is split into four")
          .at_least(0)
          .at_most(6)
          .otherwise("0"),
      quadrature_key("3")};
}

} // namespace

Key order_key() {
  return integer("order", mesh_option(&MeshOptions::order),
                 "1: 3-node triangles, 2-node beams and meridians; 2: 6-node and 3-node")
      .at_least(1)
      .at_most(2)
      .otherwise("2")
      .only_with(when::order_matters());
}

Key wall_elements_key() {
  return integer("wall_elements", mesh_option(&MeshOptions::wall_elements),
                 "beams per wall, along a line, a hinge or a ribbon")
      .at_least(1)
      .at_most(200)
      .otherwise("8")
      .only_with(when::elements());
}

Key rings_key() {
  return integer("rings", mesh_option(&MeshOptions::rings),
                 "elements along the radius, of a balloon from pole to pole, along a roll; without it 24, of "
                 "a film of revolution 64")
      .at_least(2)
      .at_most(2000)
      .optional();
}

Key across_key(std::string meaning, int largest, std::string fallback) {
  return integer("across", mesh_option(&MeshOptions::across), std::move(meaning))
      .at_least(1)
      .at_most(largest)
      .otherwise(std::move(fallback));
}

Key grading_key(std::string meaning, std::string fallback) {
  return number("grading", mesh_option(&MeshOptions::grading), std::move(meaning))
      .at_least(1)
      .at_most(100)
      .otherwise(std::move(fallback));
}

Key quadrature_key(std::string fallback) {
  return integer("quadrature", mesh_option(&MeshOptions::quadrature),
                 "integration points of a 6-node triangle: 3 or 6")
      .at_least(3)
      .at_most(6)
      .otherwise(std::move(fallback))
      .only_with(when::curved_triangles())
      .checked([](const Value& value) {
        const double count = value.at(0).number;
        return count == 3 || count == 6 ? "" : fmt::format("found {}, allowed 3 or 6", count);
      });
}

std::span<const GeometryKind> geometry_kinds() {
  const auto height = [](const char* fallback) {
    return across_key("elements across the height (of a slab that is higher than long along x), or the wall",
                      200, fallback);
  };
  static const std::vector<GeometryKind> kinds{
      {honeycomb_section(),
       {order_key(), wall_elements_key(),
        grading_key("largest film element over the wall's; 1 is uniform", "3"), quadrature_key("3")},
       honeycomb_templates()},
      {disc_section(), {order_key(), rings_key(), quadrature_key("6")}, disc_templates()},
      {annulus_section(),
       {order_key(), rings_key(),
        grading_key("element at the outer edge over that at the inner edge; 1 is uniform", "4"),
        quadrature_key("3")},
       annulus_templates()},
      {balloon_section(), {order_key(), rings_key()}, balloon_templates()},
      {patch_section(), {}, patch_templates()},
      {strip_section(),
       {order_key(), across_key("elements from side to side of a strip", 1000, "16"), quadrature_key("3")},
       strip_templates()},
      rectangle_geometry(),
      {roll_section(), {order_key(), rings_key()}, roll_templates()},
      {rolls_section(), {order_key(), wall_elements_key()}, antagonistic_rolls_templates()},
      {slab_section(),
       {grading_key(
            "largest element along a longer side over the size of those across, as long as which they are at "
            "an electrode's end along x",
            "6"),
        height("12")},
       slab_templates()},
      {hollow_sphere_section(), {height("4")}, hollow_sphere_templates()},
      {line_section(), {order_key(), wall_elements_key()}, line_templates()},
      {Section{.name = "file"}, file_keys(), file_templates()}};
  return kinds;
}

std::vector<Section> geometry_sections() {
  std::vector<Section> sections;
  for (const GeometryKind& kind : geometry_kinds())
    if (kind.section.presence == Section::Presence::geometry) sections.push_back(kind.section);
  return sections;
}

Section mesh_section() {
  Section section;
  section.name = "mesh";
  section.meaning = "how fine the mesh is, or the user's own mesh";
  section.access = same_object();
  section.access.entries = [](const void* part) { // what is a place has the mesh of another part
    return static_cast<const Part*>(part)->has_mesh() ? std::vector<Access::Entry>{{"", part}}
                                                      : std::vector<Access::Entry>{};
  };
  section.selector = "geometry";
  for (const GeometryKind& kind : geometry_kinds())
    add_keys_of(kind.section.name, kind.mesh_keys, section.keys);
  return section;
}

std::span<const Template> templates() {
  static const std::vector<Template> all = [] {
    std::vector<Template> some;
    for (const GeometryKind& kind : geometry_kinds())
      std::ranges::copy(kind.templates, std::back_inserter(some));
    return some;
  }();
  return all;
}

} // namespace dielast::cases
