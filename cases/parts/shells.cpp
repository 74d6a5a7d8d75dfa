// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/parts/shells.hpp"
#include "cases/parts/part_kinds.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/model/model.hpp"
#include "fem/shells/shell_block.hpp"
#include "meshing/normals.hpp"
#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

/// The layers from below, with their electrodes in the film's cells.
struct LaidShell {
  fem::ShellSection section;
  std::vector<const std::vector<int>*> electrodes; ///< null: none
};

LaidShell lay(const Part& part, const PartFilm* film) {
  const auto [along_x, along_y] = part.film->prestretch;
  LaidShell shell{{.prestretch = part.film->prestretch, .offset = part.film->offset * along_x * along_y}, {}};
  fem::ShellSection& section = shell.section;
  const auto add = [&](fem::ShellLayer layer, const std::vector<int>* under, bool below) {
    if (!(layer.thickness > 0)) return;
    section.layers.insert(below ? section.layers.begin() : section.layers.end(), layer);
    shell.electrodes.insert(below ? shell.electrodes.begin() : shell.electrodes.end(), under);
  };
  for (int layer = 0; layer < part.layers(); ++layer)
    add({part.film->material, part.film->thickness}, film ? &film->electrodes : nullptr, false);
  for (const bool below : {true, false})
    add({.material = part.film->material, .thickness = cover_of(part), .number = 1}, nullptr, below);
  for (std::size_t l = 0; l < part.film->further_layers.size(); ++l) {
    const Layer& layer = part.film->further_layers[l];
    add({layer.material, layer.thickness, layer.prestretch, static_cast<int>(l) + 1},
        film ? &film->of_layers[l] : nullptr, layer.below);
    section.offset += (layer.below ? -0.5 : 0.5) *
                      section.depth_of(section.layers[layer.below ? 0 : section.layers.size() - 1]);
  }
  return shell;
}

/// The largest curvature of triangles as drawn, 1/m, by how their normals turn between their nodes.
double largest_curvature(const meshing::Mesh& mesh, const meshing::CellBlock& cells) {
  double largest = 0;
  for (int c = 0; c < cells.size(); ++c) {
    const auto nodes = cells.cell(c);
    const std::vector<Eigen::Vector3d> normals = meshing::normals(mesh.nodes, nodes);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        largest = std::max(largest, (normals[a] - normals[b]).norm() /
                                        (mesh.nodes[static_cast<std::size_t>(nodes[a])] -
                                         mesh.nodes[static_cast<std::size_t>(nodes[b])])
                                            .norm());
  }
  return largest;
}

/// Lengths of fibres, and volumes, are those of the drawn surface: of what lies Z above a radius R they are
/// Z/R off, which a middle surface makes (H/R)^2/12.
void check_curvature(const Case& one, const Part& part, const fem::ShellSection& section, double curvature) {
  constexpr double most_beside = 0.0025, most_thick = 0.2, most_of_layers = 0.02; // one per cent at most
  const bool layered = !part.film->further_layers.empty(); // whose stiffness has its middle anywhere
  double height = 0;
  for (const fem::ShellLayer& layer : section.layers) height += section.depth_of(layer);
  const std::string keys = part.key_prefix() + "film.", radius = post::engineering(1 / curvature, "m");
  if (height * curvature > (layered ? most_of_layers : most_thick))
    throw one.error_at(
        keys + (layered ? "layer[1].thickness" : "thickness"),
        fmt::format("{} on a radius of {} is too thick for a shell{}: section = \"solid\" has it",
                    post::engineering(height, "m"), radius, layered ? " of layers" : ""));
  if (std::abs(section.offset) * curvature > most_beside)
    throw one.error_at(
        keys + (layered ? "layer[1].thickness" : "offset"),
        fmt::format(
            "the middle of its layers is {} beside a surface that is drawn with a radius of {}, where "
            "fibres are not as long: draw the surface in their middle",
            post::engineering(std::abs(section.offset), "m"), radius));
}

void add_shells(const Case& one, const meshing::Mesh& mesh, std::span<const PartFilm> films,
                fem::Model& model) {
  for (const PartFilm& film : films) {
    const LaidShell shell = lay(*film.part, &film);
    const meshing::CellBlock cells = meshing::subset(*mesh.film(), film.cells);
    if (const double curvature = largest_curvature(mesh, cells))
      check_curvature(one, *film.part, shell.section, curvature);
    std::vector<std::vector<int>> electrodes;
    for (const std::vector<int>* under : shell.electrodes)
      electrodes.push_back(under ? *under : std::vector<int>(film.cells.size(), fem::passive));
    model.blocks.push_back(
        fem::make_shell_block(mesh, cells, shell.section, std::move(electrodes), film.cells));
  }
}

/// What a shell needs of its case and its mesh.
void check_shell(const WrittenPart& written) {
  const Part& part = written.part;
  const Case& one = written.one;
  if (part.film && !part.film->further_layers.empty()) {
    const auto blame = [&](const std::string& message) {
      written.reader.report(written.top().find("film")->find("layer")->source, written.path("film.layer"),
                            message);
    };
    if (part.film->section != FilmSection::shell)
      blame("layers lie on film that resists bending: section = \"shell\"");
    else if (part.layers() > 1 || cover_of(part) > 0)
      blame("a stack has its layers and covers by [strip]");
  }
  if (!is_film_of<FilmSection::shell>(part)) return;
  const auto report = [&](const std::string& message) { written.report_film("section", message); };
  if (one.dimension != fem::Dimension::spatial) report("it bends in space: model = \"3d\"");
  const Part* meshed = written.meshed();
  if (!meshed) return;
  if (meshed->mesh.order != 2) report("it is made of 6-node triangles: mesh.order = 2");
  if (part.film->tension_field) report("it buckles instead of wrinkling: leave out film.wrinkling");
  if (part.rolled()) report("a rod pulls along itself only");
  if (std::holds_alternative<Patch>(part.geometry)) report("a patch stays flat");
  written.refuse_quantities(&QuantityKind::of_shells, "shell");
}

} // namespace

fem::ShellMass shell_mass(const Part& part) { return fem::ShellMass::of(lay(part, nullptr).section); }

PartKind shell_kind() {
  return {.word = "shell",
          .plural = "shells",
          .meaning = "it resists bending, and its nodes turn; in space, of 6-node triangles; without a "
                     "prestretch a mesh file may draw it curved",
          .section = FilmSection::shell,
          .is = is_film_of<FilmSection::shell>,
          .check = check_shell,
          .add = add_shells};
}

} // namespace dielast::cases
