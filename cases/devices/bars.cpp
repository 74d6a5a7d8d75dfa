// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/sections.hpp"

#include "fem/elements/beam_block.hpp"
#include "meshing/mesh_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>

namespace dielast::cases {
namespace {

/// Hinge and ribbons. Ribbons that turn freely at their ends keep a trace of their bending stiffness.
std::array<materials::BeamSection, 2> leaves(const Part& part) {
  constexpr double trace = 1e-6;
  const auto of = [](const Leaf& leaf) {
    return materials::rectangular_section(leaf.beam.material, leaf.beam.width, leaf.beam.height);
  };
  materials::BeamSection hinge = of(*part.hinge), ribbon = of(*part.ribbon);
  if (std::get<AntagonisticRolls>(part.geometry).ribbons == RibbonBending::with_hinge) {
    hinge.EI3 += 2 * ribbon.EI3 * part.hinge->length / part.ribbon->length;
    for (double* stiffness : {&ribbon.EI2, &ribbon.EI3, &ribbon.GJ}) *stiffness *= trace;
  }
  return {hinge, ribbon};
}

/// Bars of one section along lines of the mesh.
struct SetOfBars {
  const std::vector<int>& lines;
  materials::BeamSection section;
  double offset;    ///< of their axes from the lines, along z, m
  std::size_t part; ///< that they are of, a number in Case::parts
};

/// The section of a lattice's walls, and how far above the film's middle their axis is.
std::pair<materials::BeamSection, double> walls_of(const Honeycomb& lattice, const Film& film) {
  const Beam& wall = lattice.wall;
  const double printed_on = film.thickness / (film.prestretch[0] * film.prestretch[1]);
  if (lattice.print == WallPrint::both_faces)
    return {materials::two_faced_section(wall.material, wall.width, wall.height, printed_on), 0};
  return {materials::rectangular_section(wall.material, wall.width, wall.height),
          lattice.print == WallPrint::one_face ? (wall.height + printed_on) / 2 : 0};
}

/// Calls `use` with each lattice's walls, and with the bars of each part along lines of the mesh.
void for_each_set_of_bars(const Case& one, const meshing::Mesh& mesh,
                          const std::function<void(const SetOfBars&)>& use) {
  std::set<int> taken;
  const auto take = [&](std::size_t p, const std::string& place, const materials::BeamSection& section,
                        double offset = 0) {
    const std::string& part = one.parts[p].name;
    const std::vector<int>* lines = mesh.cells_of(place, mesh.walls());
    if (!lines)
      throw meshing::MeshError(
          fmt::format("part \"{}\": the place \"{}\" has no lines in the mesh", part, place));
    for (const int line : *lines)
      if (!taken.insert(line).second)
        throw meshing::MeshError(fmt::format("part \"{}\": a line of \"{}\" has a bar already", part, place));
    use({*lines, section, offset, p});
  };
  for (std::size_t p = 0; p < one.parts.size(); ++p) {
    const Part& part = one.parts[p];
    if (const auto* lattice = std::get_if<Honeycomb>(&part.geometry)) {
      const auto [section, offset] = walls_of(*lattice, *part.film);
      take(p, part.called("walls"), section, offset);
    }
    if (std::holds_alternative<AntagonisticRolls>(part.geometry)) {
      const auto [hinge, ribbon] = leaves(part);
      take(p, "hinge", hinge);
      for (const char* place : {"upper_ribbon", "lower_ribbon"}) take(p, place, ribbon);
    }
    if (part.beam)
      take(p, part.has_mesh() ? part.called("line") : part.place,
           materials::rectangular_section(part.beam->material, part.beam->width, part.beam->height),
           part.beam->offset);
  }
}

} // namespace

std::vector<fem::Tie> set_off_bars(const Case& one, meshing::Mesh& mesh) {
  std::vector<fem::Tie> links;
  for_each_set_of_bars(one, mesh, [&](const SetOfBars& bars) {
    if (bars.offset == 0) return;
    meshing::CellBlock& lines = *std::ranges::find_if(
        mesh.blocks, [](const meshing::CellBlock& block) { return meshing::is_line(block.type); });
    const Eigen::Vector3d arm(0, 0, bars.offset);
    std::map<int, int> set_off;
    const auto per_line = static_cast<std::size_t>(meshing::nodes_per_cell(lines.type));
    for (const int line : bars.lines)
      for (std::size_t a = 0; a < per_line; ++a) {
        int& node = lines.nodes[static_cast<std::size_t>(line) * per_line + a];
        const auto [entry, fresh] = set_off.try_emplace(node, mesh.node_count());
        if (fresh) {
          mesh.nodes.emplace_back(mesh.nodes[static_cast<std::size_t>(node)] + arm);
          links.push_back({entry->second, node, arm});
        }
        node = entry->second;
      }
  });
  return links;
}

void link_bars(const std::vector<fem::Tie>& links, fem::Dimension dimension, fem::DofMap& dofs) {
  for (const fem::Tie& link : links) {
    for (int c = 0; c < fem::DofMap::components; ++c)
      if (fem::moves(dimension, c)) dofs.add(link.master, c);
    dofs.tie(link);
  }
}

void add_bars(const Case& one, const meshing::Mesh& mesh, fem::Model& model) {
  for_each_set_of_bars(one, mesh, [&](const SetOfBars& bars) {
    model.blocks.push_back(fem::make_beam_block(mesh, meshing::subset(*mesh.walls(), bars.lines),
                                                bars.section, Eigen::Vector3d::UnitZ(), bars.lines));
  });
}

Bars bars(const Case& one, const meshing::Mesh& mesh) {
  const std::size_t count = mesh.walls() ? static_cast<std::size_t>(mesh.walls()->size()) : 0;
  Bars all{std::vector<double>(count), std::vector<double>(count), std::vector<int>(count)};
  for_each_set_of_bars(one, mesh, [&](const SetOfBars& bars) {
    for (const int number : bars.lines) {
      const auto line = static_cast<std::size_t>(number);
      all.widths[line] = 2 * bars.section.half_width;
      all.heights[line] = 2 * bars.section.half_height;
      all.parts[line] = static_cast<int>(bars.part);
    }
  });
  return all;
}

} // namespace dielast::cases
