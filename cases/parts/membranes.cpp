// SPDX-License-Identifier: GPL-3.0-or-later
// Film that does not resist bending, flat, of revolution, or rolled to a rod.
#include "cases/parts/part_kinds.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/model/model.hpp"
#include "meshing/bars/bars.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

fem::MembraneSection section_of(const Part& part) {
  return {.material = part.film->material,
          .thickness = part.film->thickness,
          .layers = part.layers(),
          .prestretch = part.film->prestretch,
          .tension_field = part.film->tension_field,
          .wrinkled = part.film->wrinkled};
}

/// Adds the film with a section under its electrodes; with another one beside it, in the same cells.
void add(const Case& one, const meshing::Mesh& mesh, const PartFilm& film,
         const fem::MembraneSection& section, const std::optional<fem::MembraneSection>& passive,
         fem::Model& model) {
  const meshing::CellBlock& cells = *mesh.film();
  // Two points of a 3-node meridian: there stretches are one order better than elsewhere.
  const int points = cells.type == meshing::CellType::triangle6
                         ? (film.part->has_mesh() ? film.part : one.unnamed())->mesh.quadrature
                     : cells.type == meshing::CellType::meridian3 ? 2
                                                                  : 1;
  const auto push = [&](const fem::MembraneSection& with, std::vector<int> under) {
    model.blocks.push_back(fem::make_membrane_block(mesh, meshing::subset(cells, film.cells), with,
                                                    std::move(under), one.dimension, points, film.cells));
  };
  push(section, film.electrodes);
  if (passive) push(*passive, std::vector<int>(film.cells.size(), fem::passive));
}

void add_membranes(const Case& one, const meshing::Mesh& mesh, std::span<const PartFilm> films,
                   fem::Model& model) {
  for (const PartFilm& film : films) {
    fem::MembraneSection section = section_of(*film.part);
    section.covers = 2 * cover_of(*film.part);
    add(one, mesh, film, section, std::nullopt, model);
  }
}

/// Unstretched widths of the film of a rod with all its layers side by side, m: under the electrode, as if
/// that were as long as the rod, and beside it.
struct RodWidths {
  double charged, passive;
};

RodWidths rod_widths(const Case& one, const Part& part) {
  const Rod& rod = *part.rolled();
  const auto* line = std::get_if<Line>(&part.geometry);
  const double length = line
                            ? (Eigen::Vector3d(line->to.data()) - Eigen::Vector3d(line->from.data())).norm() /
                                  part.film->prestretch[0]
                            : std::get<AntagonisticRolls>(part.geometry).length;
  const double electrode = rod.electrode_length.value_or(length);
  if (electrode > length * (1 + 1e-9))
    throw one.error_at(
        part.key_prefix() + (line ? "rod.electrode_length" : "antagonistic_rolls.electrode_length"),
        fmt::format("found {:.6g} mm: the unstretched rod is {:.6g} mm long", 1e3 * electrode, 1e3 * length));
  const double charged = rod.layers * rod.electrode_width.value_or(rod.width) * electrode / length;
  return {charged, std::max(0.0, rod.layers * rod.width - charged)};
}

/// Layers side by side; what lies beside the electrode is stretched with what lies under it.
void add_rods(const Case& one, const meshing::Mesh& mesh, std::span<const PartFilm> films,
              fem::Model& model) {
  for (const PartFilm& film : films) {
    const RodWidths widths = rod_widths(one, *film.part);
    fem::MembraneSection strip = section_of(*film.part);
    strip.width = widths.charged;
    std::optional<fem::MembraneSection> beside;
    if (widths.passive > 0) {
      beside = strip;
      beside->width = widths.passive;
    }
    add(one, mesh, film, strip, beside, model);
  }
}

void check_membrane(const WrittenPart& written) {
  const Film& film = *written.part.film;
  if (film.tension_field && film.material.viscosity > 0 &&
      std::ranges::any_of(written.one.steps, &Step::moves_dashpots))
    written.report_film("wrinkling", "a viscosity resists being compressed, as wrinkles do not; "
                                     "let the film have branches instead");
}

void check_rod(const WrittenPart& written) {
  const Part& part = written.part;
  if (!part.rolled()) return;
  if (part.rod && !std::holds_alternative<Line>(part.geometry))
    written.report("rod", "a rod is a [line]: write from where to where");
  if (!part.film) return written.report("rod", "a rod is rolled of a [film]");
  const auto report = [&](const char* message) { written.report("film", message); };
  if (part.film->prestretch[0] != part.film->prestretch[1])
    report("a rod is stretched along itself only: give it one prestretch");
  if (part.film->tension_field) report("a rod does not wrinkle: leave out film.wrinkling");
  if (has_axes(part)) report("a rod's dashpots flow alike in all directions across it: dashpot = \"log\"");
}

} // namespace

PartKind membrane_kind() {
  return {.word = "membrane",
          .plural = "membranes",
          .meaning = "it does not resist bending",
          .section = FilmSection::membrane,
          .is = is_film_of<FilmSection::membrane>,
          .check = check_membrane,
          .add = add_membranes,
          .resists_along = true};
}

PartKind rod_kind() {
  return {.word = "rod",
          .plural = "rods",
          .table = rod_section,
          .at_top = true,
          .is = [](const Part& part) { return part.rolled() != nullptr; },
          .check = check_rod,
          .add = add_rods,
          .line = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                     const MeshOptions&) { return meshing::rod_mesh(from, to); },
          .one_element = true,
          .has_middles = false};
}

} // namespace dielast::cases
