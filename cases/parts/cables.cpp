// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/conditions.hpp"
#include "cases/parts/part_kinds.hpp"
#include "fem/elements/cable_block.hpp"
#include "meshing/bars/bars.hpp"

#include <numbers>

namespace dielast::cases {
namespace {

Section cable_section() {
  Section section;
  section.name = "cable";
  section.meaning = "threads along the lines of the part's place, or one along a [line]: they pull, and "
                    "resist neither compression nor bending. What they alone hold needs them taut as drawn "
                    "(prestretch above 1) or inertia";
  section.presence = Section::Presence::optional;
  section.access = present(&Part::cable);
  section.keys = {
      measure("diameter", "m", to(&Cable::diameter), "of its fibres together, as if they were one")
          .above(0)
          .at_most(0.1),
      measure("youngs_modulus", "Pa", to(&Cable::youngs_modulus), "of its straight fibres").above(0),
      number("prestretch", to(&Cable::prestretch),
             "length as drawn over that at rest; below 1 it hangs slack as drawn, though drawn straight")
          .of_stretch()
          .above(0)
          .at_most(100)
          .otherwise("1"),
      measure(
          "crimp", "1", to(&Cable::crimp),
          "strain over which its fibres straighten; on the way the tension grows with the strain's square")
          .at_least(1e-6)
          .at_most(10)
          .otherwise("0.1 %"),
      measure("yield_strain", "1", to(&Cable::yield_strain),
              "strain of the straight fibres at which they yield or break; without it no limit is known")
          .above(0)
          .optional(),
      measure("density", "kg/m^3", to(&Cable::density), "mass per volume of its fibres")
          .at_least(0)
          .otherwise("1000 kg/m^3")
          .only_with(when::masses_matter()),
  };
  return section;
}

AlikeBars cables_of(const Part& part) {
  const Cable& cable = *part.cable;
  const double area = std::numbers::pi / 4 * cable.diameter * cable.diameter;
  const fem::CableSection section{cable.youngs_modulus * area, cable.crimp, cable.prestretch,
                                  cable.density * area, cable.yield_strain.value_or(0)};
  const bool straight = part.has_mesh();
  return {cable.diameter, cable.diameter, 0,
          [section, straight](const meshing::Mesh& mesh, const std::vector<int>& lines) {
            return fem::make_cable_block(mesh, meshing::subset(*mesh.walls(), lines), section, straight,
                                         lines);
          }};
}

} // namespace

PartKind cable_kind() {
  return {.word = "cable",
          .plural = "cables",
          .table = cable_section,
          .is = [](const Part& part) { return part.cable.has_value(); },
          .check =
              [](const WrittenPart& written) {
                if (written.part.cable && written.one.dimension == fem::Dimension::axisymmetric)
                  written.report("cable", "a model of revolution has no lines along which it could pull");
              },
          .bars = cables_of,
          .line = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                     const MeshOptions& options) { return meshing::line_mesh(from, to, 1, options.order); },
          .one_element = true};
}

} // namespace dielast::cases
