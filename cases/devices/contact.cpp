// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/sections.hpp"
#include "fem/elements/plane_contact_block.hpp"
#include "fem/elements/wall_contact.hpp"
#include "fem/elements/wall_contact_block.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/solids/sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace dielast::cases {

namespace {

/// What a contact does as the mesh is drawn.
fem::Evaluation as_drawn(const fem::ElementBlock& block, const meshing::Mesh& mesh) {
  fem::State state;
  state.displacement.assign(mesh.nodes.size(), Eigen::Vector3d::Zero());
  return block.evaluate(state, 0, block.element_count(), {});
}

void add_walls(const Case& one, const meshing::Mesh& mesh, fem::Model& model) {
  const meshing::CellBlock& lines = *mesh.walls();
  const std::vector<double> widths = bars(one, mesh).widths;
  const fem::WallContactSearch walls(mesh, lines, widths);
  const auto at = [&](int node) -> const Eigen::Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(node)];
  };
  std::map<int, std::vector<int>> lines_at;
  for (int line = 0; line < lines.size(); ++line)
    for (const int node : lines.cell(line)) lines_at[node].push_back(line);
  std::vector<fem::ContactPair> pairs;
  for (const auto& place : mesh.node_sets) {
    if (!place.first.starts_with("cell[")) continue;
    const std::vector<int>& nodes = place.second;
    std::vector<int> around;
    std::map<int, double> length; // that a node stands for, by Simpson's rule
    for (int line = 0; line < lines.size(); ++line) {
      const auto own = lines.cell(line);
      if (!std::ranges::all_of(own, [&](int node) { return std::ranges::binary_search(nodes, node); }))
        continue;
      around.push_back(line);
      const double whole = (at(own[1]) - at(own[0])).norm();
      for (const int end : {own[0], own[1]}) length[end] += own.size() == 3 ? whole / 6 : whole / 2;
      if (own.size() == 3) length[own[2]] += whole * 4 / 6;
    }
    for (const auto& [node, stands_for] : length) {
      const std::vector<int>& meeting = lines_at.at(node);
      std::map<int, int> beams_at; // how many that it may touch have this end
      for (const int line : around) {
        if (!std::ranges::all_of(meeting, [&](int other) { return walls.may_touch(line, other); })) continue;
        const double touching =
            (widths[static_cast<std::size_t>(line)] + widths[static_cast<std::size_t>(meeting.front())]) / 2;
        constexpr int none = fem::ContactPair::none;
        const auto own = lines.cell(line);
        pairs.push_back({node, {own[0], own[1], own.size() == 3 ? own[2] : none}, touching, stands_for});
        for (const int end : {own[0], own[1]})
          if (++beams_at[end] > 1) pairs.push_back({node, {end, none, none}, touching, -stands_for});
      }
    }
  }
  const Beam& wall = std::get<Honeycomb>(one.unnamed()->geometry).wall;
  const double thickness = one.contact->thickness;
  // A gap of half the barrier's thickness carries about what strains a wall across itself by 1 %.
  model.blocks.push_back(fem::make_wall_contact_block(
      mesh, std::move(pairs), {thickness, 0.01 * wall.material.youngs_modulus * wall.height / thickness}));
  const fem::Evaluation drawn = as_drawn(*model.blocks.back(), mesh);
  if (!drawn.feasible || drawn.energy > 0)
    throw meshing::MeshError(fmt::format(
        "walls of a cell are closer as drawn than the {:.6g} mm of contact.thickness", 1e3 * thickness));
}

/// The plane is where the barrier of the surface's lowest node begins.
void add_table(const Case& one, const meshing::Mesh& mesh, fem::Model& model) {
  const bool of_revolution = one.dimension == fem::Dimension::axisymmetric;
  const int up = of_revolution ? 2 : 1;
  const double thickness = one.contact->thickness;
  const Film& film = *one.unnamed()->film;
  const meshing::CellBlock sides = meshing::sides_at(mesh, one.table->place, meshing::CellType::meridian3);
  fem::PlaneContact contact =
      fem::surface_of(mesh, sides, of_revolution ? std::nullopt : std::optional(film.width));
  double lowest = std::numeric_limits<double>::infinity();
  for (const int node : contact.nodes)
    lowest = std::min(lowest, mesh.nodes[static_cast<std::size_t>(node)][up]);
  const double modulus = 3 * materials::initial_shear_modulus(film.material.law);
  contact.normal = Eigen::Vector3d::Unit(up);
  contact.origin = (lowest - thickness) * contact.normal;
  // A gap of half the barrier's thickness bears about 1 % of Young's modulus.
  contact.barrier = {.thickness = thickness, .stiffness = 0.01 * modulus / thickness, .foot = 1};
  contact.friction = one.table->friction;
  model.blocks.push_back(fem::make_plane_contact_block(mesh, std::move(contact)));
}

/// The core is where the barrier of the film as drawn begins.
void add_core(const Case& one, const Roll& roll, const meshing::Mesh& mesh, fem::Model& model) {
  const Film& film = *one.unnamed()->film;
  const double thickness = one.contact->thickness;
  fem::PlaneContact contact = fem::surface_of(mesh, *mesh.film(), std::nullopt);
  contact.normal = Eigen::Vector3d::UnitX();
  contact.origin = (roll.radius - thickness) * contact.normal;
  const double modulus = 3 * materials::initial_shear_modulus(film.material.law);
  const double wound = roll.turns * film.thickness / (film.prestretch[0] * film.prestretch[1]);
  // A gap of half the barrier's thickness bears the film's tension around the core at 1.7 times its modulus.
  contact.barrier = {
      .thickness = thickness, .stiffness = modulus * wound / roll.radius / thickness, .foot = 1};
  model.blocks.push_back(fem::make_plane_contact_block(mesh, std::move(contact)));
}

} // namespace

void hold_radii(const Case& one, const meshing::Mesh& mesh, fem::DofMap& dofs) {
  const auto* roll = one.geometry<Roll>();
  if (!roll || roll->core != RollCore::two_sided) return;
  std::set<int> carried; // by end caps, which keep their radius
  for (const fem::Tie& tie : dofs.ties()) carried.insert(tie.node);
  for (const int node : mesh.node_sets.at("film"))
    if (!carried.contains(node)) dofs.hold(node, 0);
}

void add_contact(const Case& one, const meshing::Mesh& mesh, fem::Model& model) {
  if (!one.contact) return;
  if (one.table)
    add_table(one, mesh, model);
  else if (const auto* roll = one.geometry<Roll>())
    add_core(one, *roll, mesh, model);
  else
    add_walls(one, mesh, model);
}

} // namespace dielast::cases
