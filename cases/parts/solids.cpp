// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/parts/part_kinds.hpp"
#include "fem/model/model.hpp"
#include "fem/solids/solid_block.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

/// Solids that no electrode touches have no field: nothing tells their potential, which is the ground's here.
void ground_what_is_not_charged(const meshing::CellBlock& film, std::vector<int>& map) {
  std::vector<char> touched(map.size());
  const auto is_touched = [&](int node) { return touched[static_cast<std::size_t>(node)] != 0; };
  for (std::size_t n = 0; n < map.size(); ++n) touched[n] = map[n] != fem::NodePotential::follows;
  for (bool grows = true; grows;) { // from cell to cell
    grows = false;
    for (int cell = 0; cell < film.size(); ++cell) {
      const auto own = film.cell(cell);
      if (std::ranges::none_of(own, is_touched) || std::ranges::all_of(own, is_touched)) continue;
      for (const int node : own) touched[static_cast<std::size_t>(node)] = 1;
      grows = true;
    }
  }
  for (const int node : film.nodes)
    if (!is_touched(node)) map[static_cast<std::size_t>(node)] = fem::NodePotential::ground;
}

/// Electrode or ground at each node of solids with a potential.
std::vector<int> potential_map(const Case& one, const meshing::Mesh& mesh) {
  std::vector<int> map(mesh.nodes.size(), fem::NodePotential::follows);
  const meshing::CellBlock& film = *mesh.film();
  // the field of a point, or of a line in space, has no limit, and its charge is that of the mesh
  const auto sides = static_cast<std::ptrdiff_t>(meshing::is_tetrahedron(film.type) ? 3 : 2);
  const auto is_surface = [&](const std::vector<int>& nodes) {
    for (int cell = 0; cell < film.size(); ++cell)
      if (std::ranges::count_if(film.cell(cell).first(static_cast<std::size_t>(sides) + 1),
                                [&](int node) { return std::ranges::binary_search(nodes, node); }) >= sides)
        return true;
    return false;
  };
  const auto claim = [&](const std::string& key, const std::string& place, int potential) {
    if (!is_surface(mesh.node_sets.at(place)))
      throw one.error_at(key,
                         fmt::format("\"{}\" is no surface of the solid, but a point or line, whose field "
                                     "has no limit",
                                     place));
    for (const int node : mesh.node_sets.at(place)) {
      int& known = map[static_cast<std::size_t>(node)];
      if (known != fem::NodePotential::follows && known != potential)
        throw one.error_at(key, fmt::format("\"{}\" touches a surface of another potential", place));
      known = potential;
    }
  };
  for (std::size_t e = 0; e < one.electrodes.size(); ++e)
    if (const Electrode& electrode = one.electrodes[e]; !electrode.ground.empty()) {
      claim(fmt::format("electrode[{}].ground", e + 1), electrode.ground, fem::NodePotential::ground);
      claim(fmt::format("electrode[{}].place", e + 1), electrode.place, static_cast<int>(e));
    }
  ground_what_is_not_charged(film, map);
  return map;
}

/// A part that is meshed across its thickness.
fem::SolidSection solid_section(const Case& one, const Part& part) {
  const Film& film = *part.film;
  fem::SolidSection section{.material = film.material, .width = film.width, .thickness = film.thickness};
  if (film.bulk_modulus) section.bulk_modulus = *film.bulk_modulus;
  const Part* const meshed = part.has_mesh() ? &part : one.unnamed();
  const bool is_slab = meshed && std::holds_alternative<Slab>(meshed->geometry);
  const bool along_z =
      one.dimension == fem::Dimension::axisymmetric || (one.dimension == fem::Dimension::spatial && !is_slab);
  section.normal = Eigen::AngleAxisd(part.turned, Eigen::Vector3d::UnitZ()) *
                   Eigen::Vector3d::Unit(film.stacked_along.value_or(along_z ? 2 : 1));
  return section;
}

/// One block of all: their potentials are continuous from one to the next.
void add_solids(const Case& one, const meshing::Mesh& mesh, std::span<const PartFilm> films,
                fem::Model& model) {
  std::vector<fem::SolidSection> sections;
  struct Cell {
    int number, electrode, section;
  };
  std::vector<Cell> all;
  for (const PartFilm& film : films) {
    for (std::size_t i = 0; i < film.cells.size(); ++i)
      all.push_back({film.cells[i], film.electrodes[i], static_cast<int>(sections.size())});
    sections.push_back(solid_section(one, *film.part));
  }
  std::ranges::sort(all, {}, &Cell::number);
  fem::SolidCells cells;
  for (const Cell& cell : all) {
    cells.numbers.push_back(cell.number);
    cells.electrodes.push_back(cell.electrode);
    cells.sections.push_back(cell.section);
  }
  cells.elements = meshing::subset(*mesh.film(), cells.numbers);
  const bool potential = films.back().part->film->potential;
  model.blocks.push_back(fem::make_solid_block(mesh, std::move(cells), sections,
                                               potential ? potential_map(one, mesh) : std::vector<int>{},
                                               one.dimension));
}

/// What a solid needs of its case and its mesh.
void check_solid(const WrittenPart& written) {
  const Part& part = written.part;
  const Case& one = written.one;
  const bool thick =
      std::holds_alternative<Slab>(part.geometry) || std::holds_alternative<HollowSphere>(part.geometry);
  if (!part.film || (!thick && !part.film->is_solid())) return;
  const Film& film = *part.film;
  const auto report = [&](const char* key, const std::string& message) { written.report_film(key, message); };
  if (!film.is_solid()) return report("section", "a thick geometry is of solid");
  const bool of_revolution = one.dimension == fem::Dimension::axisymmetric;
  const Part* meshed = written.meshed();
  if (!meshed) return;
  const bool own_mesh = std::holds_alternative<MeshFile>(meshed->geometry) && !of_revolution;
  const auto* slab = std::get_if<Slab>(&meshed->geometry);
  if (!own_mesh && !slab && !std::holds_alternative<HollowSphere>(meshed->geometry))
    report("section", of_revolution ? "a solid of revolution is a [slab] or a [hollow_sphere]"
                                    : "a solid is a [slab], a [hollow_sphere], or a mesh of your own");
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
  if (has_axes(part)) report("material", "a solid's dashpots have no axes: dashpot = \"log\"");
  if (meshed->mesh.order != 2) report("section", "a solid is made of 6-node triangles");
  if (one.linearise && film.potential)
    report("field", "a field that is solved for has no linear model; ask for a step of kind \"harmonic\"");
  if (std::ranges::any_of(one.steps,
                          [](const Step& step) { return step.on_instability == OnInstability::jump; }))
    report("section", "solids do not jump: on_instability = \"stop\" or \"follow\"");
  written.refuse_quantities(&QuantityKind::of_solids, "solid");
  for (std::size_t e = 0; e < one.electrodes.size(); ++e) {
    const Electrode& electrode = one.electrodes[e];
    if (electrode.ground.empty() != film.potential) continue;
    const Node* list = written.tree.find("electrode");
    const bool listed = list && e < list->items.size() && list->items[e].source.is_written();
    written.reader.report(listed ? list->items[e].source : written.top().find("film")->source,
                          fmt::format("electrode[{}].ground", e + 1),
                          film.potential
                              ? "missing; with field = \"potential\" an electrode has a surface opposite"
                              : "only for a solid with field = \"potential\"");
  }
}

} // namespace

PartKind solid_kind() {
  return {.word = "solid",
          .plural = "solids",
          .meaning =
              "it is meshed: in plane strain (model = \"planar\") or of revolution of 6-node triangles, in "
              "space "
              "of 10-node tetrahedra; the default of a [slab] and a [hollow_sphere]. All films of a case are "
              "solids, or none",
          .section = FilmSection::solid,
          .is = is_film_of<FilmSection::solid>,
          .check = check_solid,
          .add = add_solids};
}

} // namespace dielast::cases
