// SPDX-License-Identifier: GPL-3.0-or-later
// What keys of parts and of their film ask of these.
#include "cases/case/part_kind.hpp"
#include "cases/language/condition_on.hpp"
#include "cases/language/conditions.hpp"
#include "meshing/solids/surface.hpp"

#include <fmt/format.h>

namespace dielast::cases::when {

Condition elements() {
  const auto are_one = [](const PartKind& kind) { return kind.one_element; };
  return on<Part>(fmt::format("more than {}, which is one element", words_of_kinds(are_one)),
                  [](const Case&, const Part& part) { return !is_one_element(part); });
}

Condition curved_triangles() {
  return on<Part>("6-node triangles: mesh.order = 2 of a membrane that is not of revolution",
                  [](const Case& one, const Part& part) {
                    const bool membranes =
                        one.any_film([](const Film& film) { return film.section == FilmSection::membrane; });
                    return membranes && part.mesh.order == 2 && one.dimension != fem::Dimension::axisymmetric;
                  });
}

Condition order_matters() {
  return on<Part>(
      fmt::format("another part than {}, whose elements have no nodes between their ends",
                  words_of_kinds([](const PartKind& kind) { return kind.line && !kind.has_middles; })),
      [](const Case&, const Part& part) {
        const PartKind* kind = kind_of(part);
        return !kind || kind->has_middles || !std::holds_alternative<Line>(part.geometry);
      });
}

Condition shell() {
  return on<Film>("section = \"shell\"",
                  [](const Case&, const Film& film) { return film.section == FilmSection::shell; });
}

Condition solid() {
  return on<Film>("section = \"solid\"", [](const Case&, const Film& film) { return film.is_solid(); });
}

Condition layers() {
  return on<Film>("section = \"solid\" and field = \"layers\"",
                  [](const Case&, const Film& film) { return film.is_solid() && !film.potential; });
}

Condition law_without_volume() {
  return on<Film>("section = \"solid\" and another law than \"st-venant-kirchhoff\", whose poisson_ratio "
                  "says what changes of volume take",
                  [](const Case&, const Film& film) {
                    return film.is_solid() &&
                           !std::holds_alternative<materials::StVenantKirchhoff>(film.material.law);
                  });
}

Condition plane_strain() {
  return on<Film>("section = \"solid\" in a planar model", [](const Case& one, const Film& film) {
    return film.is_solid() && one.dimension == fem::Dimension::planar;
  });
}

Condition fills_a_surface() {
  return on<Part>("a file of a surface: .stl, .ply or .off", [](const Case&, const Part& part) {
    const auto* file = std::get_if<MeshFile>(&part.geometry);
    return file && meshing::is_surface_file(file->path);
  });
}

} // namespace dielast::cases::when
