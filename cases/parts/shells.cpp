// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/parts/shells.hpp"
#include "cases/parts/part_kinds.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/model/model.hpp"
#include "fem/shells/shell_block.hpp"

#include <fmt/format.h>

#include <algorithm>

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

void add_shells(const Case&, const meshing::Mesh& mesh, std::span<const PartFilm> films, fem::Model& model) {
  for (const PartFilm& film : films) {
    const LaidShell shell = lay(*film.part, &film);
    std::vector<std::vector<int>> electrodes;
    for (const std::vector<int>* under : shell.electrodes)
      electrodes.push_back(under ? *under : std::vector<int>(film.cells.size(), fem::passive));
    model.blocks.push_back(fem::make_shell_block(mesh, meshing::subset(*mesh.film(), film.cells),
                                                 shell.section, std::move(electrodes), film.cells));
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
  const auto of_membranes = std::ranges::find_if(
      one.quantities, [](const Quantity& quantity) { return !quantity.kind->of_shells; });
  if (of_membranes != one.quantities.end())
    report(fmt::format("quantities of kind \"{}\" are of membranes", of_membranes->kind->word));
}

} // namespace

fem::ShellMass shell_mass(const Part& part) { return fem::ShellMass::of(lay(part, nullptr).section); }

PartKind shell_kind() {
  return {.word = "shell",
          .plural = "shells",
          .meaning = "it resists bending, and its nodes turn; in space, of 6-node triangles",
          .section = FilmSection::shell,
          .is = is_film_of<FilmSection::shell>,
          .check = check_shell,
          .add = add_shells};
}

} // namespace dielast::cases
