// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/schema.hpp"
#include "cases/parts/part_kinds.hpp"
#include "fem/elements/beam_block.hpp"
#include "meshing/bars/bars.hpp"

#include <cmath>

namespace dielast::cases {

AlikeBars beams_of(const materials::BeamSection& section, double offset) {
  return {2 * section.half_width, 2 * section.half_height, offset,
          [section](const meshing::Mesh& mesh, const std::vector<int>& lines) {
            return fem::make_beam_block(mesh, meshing::subset(*mesh.walls(), lines), section,
                                        Eigen::Vector3d::UnitZ(), lines);
          },
          [section](const meshing::Mesh& mesh, const std::vector<int>& lines, fem::RotaryInertia& inertia) {
            fem::add_rotary_inertia(mesh, meshing::subset(*mesh.walls(), lines), section,
                                    Eigen::Vector3d::UnitZ(), inertia);
          }};
}

namespace {

/// The normal of its section is z.
void check_beam(const WrittenPart& written) {
  const auto* line = std::get_if<Line>(&written.part.geometry);
  if (!line || !written.part.beam) return;
  const double across = std::hypot(line->to[0] - line->from[0], line->to[1] - line->from[1]);
  if (across < 1e-6 * std::abs(line->to[2] - line->from[2]))
    written.report("line",
                   "a [beam] cannot run along z, the direction of its height: draw it in another one");
}

} // namespace

PartKind beam_kind() {
  return {.word = "beam",
          .plural = "beams",
          .table = beam_section,
          .is = [](const Part& part) { return part.beam.has_value(); },
          .check = check_beam,
          .bars =
              [](const Part& part) {
                const Beam& beam = *part.beam;
                return beams_of(materials::rectangular_section(beam.material, beam.width, beam.height),
                                beam.offset);
              },
          .line =
              [](const Eigen::Vector3d& from, const Eigen::Vector3d& to, const MeshOptions& options) {
                return meshing::line_mesh(from, to, options.wall_elements, options.order);
              }};
}

} // namespace dielast::cases
