// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/sections.hpp"
#include "cases/language/conditions.hpp"
#include "cases/parts/part_kinds.hpp"
#include "meshing/normals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

namespace dielast::cases {
namespace {

constexpr std::array ribbons{"upper_ribbon", "lower_ribbon"};

/// Whether ribbons turn freely at their ends.
bool are_links(const Part& part) {
  const auto* rolls = std::get_if<AntagonisticRolls>(&part.geometry);
  return rolls && rolls->ribbons == RibbonBending::with_hinge;
}

materials::BeamSection section_of(const Leaf& leaf) {
  return materials::rectangular_section(leaf.beam.material, leaf.beam.width, leaf.beam.height);
}

/// Hinge and ribbons. Ribbons that turn freely at their ends keep a trace of their bending stiffness.
std::array<materials::BeamSection, 2> leaves(const Part& part) {
  constexpr double trace = 1e-6;
  materials::BeamSection hinge = section_of(*part.hinge), ribbon = section_of(*part.ribbon);
  if (are_links(part)) {
    hinge.EI3 += 2 * ribbon.EI3 * part.hinge->length / part.ribbon->length;
    for (double* stiffness : {&ribbon.EI2, &ribbon.EI3, &ribbon.GJ}) *stiffness *= trace;
    ribbon.rotary2 = ribbon.rotary3 = 0; // what turns against a trace of stiffness would swing slowly
  }
  return {hinge, ribbon};
}

/// A lattice's walls. Their axis may lie above the film's middle.
AlikeBars walls_of(const Honeycomb& lattice, const Film& film) {
  const Beam& wall = lattice.wall;
  const double printed_on = film.thickness / (film.prestretch[0] * film.prestretch[1]);
  if (lattice.print == WallPrint::both_faces)
    return beams_of(materials::two_faced_section(wall.material, wall.width, wall.height, printed_on));
  return beams_of(materials::rectangular_section(wall.material, wall.width, wall.height),
                  lattice.print == WallPrint::one_face ? (wall.height + printed_on) / 2 : 0);
}

/// Calls `use` with each lattice's walls, and with the bars of each part along lines of the mesh; `part`: a
/// number in Case::parts.
void for_each_set_of_bars(
    const Case& one, const meshing::Mesh& mesh,
    const std::function<void(const AlikeBars&, const std::vector<int>& lines, std::size_t part)>& use) {
  std::set<int> taken;
  const auto take = [&](std::size_t p, const std::string& place, const AlikeBars& bars) {
    const std::string key = one.parts[p].key_prefix() + "place";
    const std::vector<int>* lines = mesh.cells_of(place, mesh.walls());
    if (!lines) throw one.error_at(key, fmt::format("\"{}\" has no lines in the mesh", place));
    for (const int line : *lines)
      if (!taken.insert(line).second)
        throw one.error_at(key, fmt::format("a line of \"{}\" has a bar already", place));
    use(bars, *lines, p);
  };
  for (std::size_t p = 0; p < one.parts.size(); ++p) {
    const Part& part = one.parts[p];
    if (const auto* lattice = std::get_if<Honeycomb>(&part.geometry))
      take(p, part.called("walls"), walls_of(*lattice, *part.film));
    if (std::holds_alternative<AntagonisticRolls>(part.geometry)) {
      const auto [hinge, ribbon] = leaves(part);
      take(p, "hinge", beams_of(hinge));
      for (const char* place : ribbons) take(p, place, beams_of(ribbon));
    }
    if (const PartKind* kind = kind_of(part); kind && kind->bars)
      take(p, part.has_mesh() ? part.called("line") : part.place, kind->bars(part));
  }
}

/// Puts the end of a ribbon on the tip on a node of its own.
fem::Tie pinned(const std::string& ribbon, meshing::Mesh& mesh) {
  const int on_tip = mesh.node_sets.at(ribbon + ".start").front(), own = mesh.node_count();
  mesh.nodes.emplace_back(mesh.nodes[static_cast<std::size_t>(on_tip)]);
  const meshing::CellSet& set = mesh.cell_sets.at(ribbon);
  meshing::CellBlock& lines = mesh.blocks[static_cast<std::size_t>(set.block)];
  const int per_line = meshing::nodes_per_cell(lines.type);
  for (const int line : set.cells)
    std::replace(lines.nodes.begin() + line * per_line, lines.nodes.begin() + (line + 1) * per_line, on_tip,
                 own);
  return {own, on_tip, Eigen::Vector3d::Zero(), false};
}

/// Part of the load under which a ribbon between pins buckles that is none yet.
constexpr double next_to_nothing = 1e-3;

} // namespace

std::string pushed_ribbon(const Case& one, const Device& device, const fem::State& state) {
  const auto part = std::ranges::find_if(one.parts, are_links);
  if (part == one.parts.end()) return "";
  const double buckles = section_of(*part->ribbon).EI3 * std::pow(std::numbers::pi / part->ribbon->length, 2);
  const fem::Samples samples = device.model.sample(state);
  for (const std::string ribbon : ribbons) {
    const std::vector<int>* lines = device.mesh.cells_of(ribbon, device.mesh.walls());
    double tension = 0, length = 0;
    for (const fem::BeamSample& at : samples.walls)
      if (lines && std::ranges::count(*lines, at.cell) > 0) {
        tension += at.force.x() * at.length;
        length += at.length;
      }
    if (tension < -next_to_nothing * buckles * length)
      return fmt::format(
          "the {}, which turns freely at its ends, would be pushed by {:.3g} N. Keep it taut by more "
          "prestretch or less voltage, let it go slack by on_instability = \"jump\" and several elements "
          "along it "
          "(mesh.wall_elements), or let the ribbons bend (ribbons = \"beams\")",
          ribbon == ribbons[0] ? "upper ribbon" : "lower ribbon", -tension / length);
  }
  return "";
}

std::vector<fem::Tie> set_off_bars(const Case& one, meshing::Mesh& mesh) {
  std::vector<fem::Tie> links;
  std::vector<Eigen::Vector3d> normals(mesh.nodes.size(), Eigen::Vector3d::Zero());
  const auto may_be_tilted = [](const Film& film) { return film.section == FilmSection::shell; };
  if (one.any_film(may_be_tilted) && mesh.film() && meshing::is_triangle(mesh.film()->type))
    normals = meshing::node_normals(mesh, *mesh.film());
  for_each_set_of_bars(one, mesh, [&](const AlikeBars& bars, const std::vector<int>& own, std::size_t p) {
    const auto is_on_tilted_film = [&](int line) {
      return std::ranges::any_of(mesh.walls()->cell(line), [&](int node) {
        const Eigen::Vector3d& normal = normals[static_cast<std::size_t>(node)];
        return normal.head<2>().norm() > 1e-6;
      });
    };
    if (bars.rotary && std::ranges::any_of(own, is_on_tilted_film))
      throw one.error_at(one.parts[p].key_prefix() + "place",
                         "found a beam on film that does not lie across z: beams have their height along z");
    if (bars.offset == 0) return;
    meshing::CellBlock& lines = *std::ranges::find_if(
        mesh.blocks, [](const meshing::CellBlock& block) { return meshing::is_line(block.type); });
    const Eigen::Vector3d arm(0, 0, bars.offset);
    std::map<int, int> set_off;
    const auto per_line = static_cast<std::size_t>(meshing::nodes_per_cell(lines.type));
    for (const int line : own)
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
  for (const Part& part : one.parts)
    if (are_links(part))
      for (const std::string ribbon : ribbons) links.push_back(pinned(ribbon, mesh));
  return links;
}

void link_bars(const std::vector<fem::Tie>& links, fem::Dimension dimension, fem::DofMap& dofs) {
  for (const fem::Tie& link : links) {
    for (int c = 0; c < fem::DofMap::components; ++c)
      if (fem::moves(dimension, c) && (c < 3 || link.turns)) dofs.add(link.master, c);
    dofs.tie(link);
    if (!link.turns) dofs.hold(link.node, 3);
  }
}

void add_bars(const Case& one, const meshing::Mesh& mesh, fem::Model& model) {
  for_each_set_of_bars(one, mesh, [&](const AlikeBars& bars, const std::vector<int>& lines, std::size_t) {
    model.blocks.push_back(bars.block(mesh, lines));
  });
}

std::vector<fem::RelativeMass> add_rotary_nodes(const Case& one, meshing::Mesh& mesh) {
  std::vector<fem::RelativeMass> masses;
  if (!masses_accelerate(one)) return masses;
  fem::RotaryInertia inertia;
  for_each_set_of_bars(one, mesh, [&](const AlikeBars& bars, const std::vector<int>& lines, std::size_t) {
    if (bars.rotary) bars.rotary(mesh, lines, inertia);
  });
  for (const auto& [node, arms] : inertia)
    for (const auto& [arm, mass] : arms) {
      if (one.dimension == fem::Dimension::planar && arm.head<2>().isZero(0)) continue; // turns about itself
      mesh.nodes.emplace_back(mesh.nodes[static_cast<std::size_t>(node)] + arm);
      masses.push_back({mesh.node_count() - 1, node, mass});
    }
  return masses;
}

void tie_rotary_nodes(const std::vector<fem::RelativeMass>& masses, const meshing::Mesh& mesh,
                      fem::DofMap& dofs) {
  const auto drawn = [&mesh](int node) { return mesh.nodes[static_cast<std::size_t>(node)]; };
  for (const fem::RelativeMass& one : masses)
    dofs.tie({one.node, one.beside, drawn(one.node) - drawn(one.beside)});
}

Bars bars(const Case& one, const meshing::Mesh& mesh) {
  const std::size_t count = mesh.walls() ? static_cast<std::size_t>(mesh.walls()->size()) : 0;
  Bars all{std::vector<double>(count), std::vector<double>(count), std::vector<int>(count)};
  for_each_set_of_bars(one, mesh, [&](const AlikeBars& bars, const std::vector<int>& lines, std::size_t p) {
    for (const int number : lines) {
      const auto line = static_cast<std::size_t>(number);
      all.widths[line] = bars.width;
      all.heights[line] = bars.height;
      all.parts[line] = static_cast<int>(p);
    }
  });
  return all;
}

} // namespace dielast::cases
