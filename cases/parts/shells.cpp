// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/parts/part_kinds.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/model/model.hpp"
#include "fem/shells/shell_block.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

void add_shells(const Case&, const meshing::Mesh& mesh, std::span<const PartFilm> films, fem::Model& model) {
  for (const PartFilm& film : films) {
    const Part& part = *film.part;
    const std::vector<int> none(film.cells.size(), fem::passive);
    fem::ShellSection layers{.prestretch = part.film->prestretch};
    std::vector<std::vector<int>> electrodes_of;
    const auto stack = [&](double thickness, const std::vector<int>& under) {
      if (!(thickness > 0)) return;
      layers.layers.push_back({part.film->material, thickness});
      electrodes_of.push_back(under);
    };
    stack(cover_of(part), none);
    for (int layer = 0; layer < part.layers(); ++layer) stack(part.film->thickness, film.electrodes);
    stack(cover_of(part), none);
    model.blocks.push_back(fem::make_shell_block(mesh, meshing::subset(*mesh.film(), film.cells), layers,
                                                 std::move(electrodes_of), film.cells));
  }
}

/// What a shell needs of its case and its mesh.
void check_shell(const WrittenPart& written) {
  const Part& part = written.part;
  const Case& one = written.one;
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
  if (of_membranes != one.quantities.end()) // those of a case with a [plate] are among the standard ones
    report(fmt::format("quantities of kind \"{}\", of which a [plate] brings some, are of membranes",
                       of_membranes->kind->word));
}

} // namespace

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
