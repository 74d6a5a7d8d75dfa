// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/film_cells.hpp"
#include "cases/devices/sections.hpp"
#include "cases/language/conditions.hpp"
#include "cases/parts/shells.hpp"
#include "fem/shells/shell_block.hpp"
#include "meshing/normals.hpp"

#include <map>
#include <set>

namespace dielast::cases {

std::vector<MassOfShells> add_mass_nodes(const Case& one, const std::vector<int>& parts,
                                         meshing::Mesh& mesh) {
  const bool matters = masses_accelerate(one) || film_weighs(one);
  std::vector<MassOfShells> all;
  for (std::size_t p = 0; p < one.parts.size(); ++p) {
    if (!one.parts[p].film || one.parts[p].film->section != FilmSection::shell) continue;
    MassOfShells shells{shell_mass(one.parts[p]), cells_of_part(parts, p), {}};
    if (shells.mass.per_area == 0) continue;
    const meshing::CellBlock film = meshing::subset(*mesh.film(), shells.cells);
    if (shells.mass.lever == 0 || !matters) {
      shells.carriers = film.nodes;
    } else {
      const std::vector<Eigen::Vector3d> normal = meshing::node_normals(mesh, film);
      std::map<int, int> carrier; // of each node
      for (const int node : film.nodes) {
        const auto [entry, fresh] = carrier.try_emplace(node, mesh.node_count());
        if (const auto n = static_cast<std::size_t>(node); fresh)
          mesh.nodes.emplace_back(mesh.nodes[n] + shells.mass.lever * normal[n]);
        shells.carriers.push_back(entry->second);
      }
    }
    all.push_back(std::move(shells));
  }
  return all;
}

void add_masses_of_shells(const std::vector<MassOfShells>& shells, const meshing::Mesh& mesh,
                          fem::Model& model) {
  for (const MassOfShells& own : shells)
    model.blocks.push_back(
        fem::make_shell_mass_block(mesh, meshing::subset(*mesh.film(), own.cells), own.mass, own.carriers));
}

void tie_mass_nodes(const std::vector<MassOfShells>& shells, const meshing::Mesh& mesh, fem::DofMap& dofs) {
  const auto drawn = [&mesh](int node) { return mesh.nodes[static_cast<std::size_t>(node)]; };
  for (const MassOfShells& own : shells) {
    const meshing::CellBlock cells = meshing::subset(*mesh.film(), own.cells);
    std::set<int> tied;
    for (std::size_t i = 0; i < own.carriers.size(); ++i) {
      const int carrier = own.carriers[i], node = cells.nodes[i];
      if (carrier != node && tied.insert(carrier).second)
        dofs.tie({carrier, node, drawn(carrier) - drawn(node)});
    }
  }
}

} // namespace dielast::cases
