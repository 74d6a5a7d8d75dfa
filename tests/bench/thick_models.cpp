// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/models.hpp"

#include "fem/films/membrane_block.hpp"
#include "fem/shells/shell_block.hpp"
#include "fem/solids/solid_block.hpp"
#include "meshing/solids/slab.hpp"

namespace dielast::bench {

Task plate_diaphragm_shell(int k) {
  constexpr double thickness = 0.01;
  auto mesh = diaphragm_mesh(k);
  std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks.front().size()), 0);
  auto block = fem::make_shell_block(mesh, mesh.blocks.front(),
                                     {.layers = {{film, thickness * 1e-3}}, .prestretch = {2, 2}},
                                     {std::move(electrodes)});
  return diaphragm(std::move(mesh), std::move(block), thickness);
}

Task stack_on_table(int across) {
  Task task{.mesh = meshing::block_mesh({{24e-3, 0.6e-3, 0, {4e-3, 20e-3}, 50e-6}, 13e-3, 10e-3}, across, 6),
            .model = {.dofs = fem::DofMap(0)}};
  fem::Model& model = task.model;
  model.dofs = fem::DofMap(task.mesh.node_count());
  model.ports = {{"film"}};
  model.extent = 24e-3;
  model.length_scale = 0.6e-3 / across;
  const meshing::CellBlock& cells = task.mesh.blocks.front();
  const auto count = static_cast<std::size_t>(cells.size());
  fem::SolidCells solid{cells, std::vector<int>(count, fem::passive), std::vector<int>(count, 0)};
  for (const int cell : task.mesh.cell_sets.at("electrode").cells)
    solid.electrodes[static_cast<std::size_t>(cell)] = 0;
  const materials::Material silicone{materials::NeoHookean{0.4e6}, materials::Dielectric{2.48e-11, 100e6},
                                     960};
  model.blocks.push_back(fem::make_solid_block(task.mesh, std::move(solid),
                                               {{.material = silicone, .thickness = 50e-6}}, {},
                                               fem::Dimension::spatial));
  model.blocks.front()->place_scalars(model.dofs);
  model.blocks.front()->claim_dofs(model.dofs, fem::Dimension::spatial);
  hold(task, "bottom", {0, 1, 2});
  model.dofs.number();
  model.place_histories();
  task.node = task.mesh.node_sets.at("upper_electrode").front();
  task.component = 1;
  fem::Loads voltage = fem::Loads::of(model.initial_state(), model.dofs);
  voltage.voltage = {750};
  task.steps = {{voltage, 1}};
  return task;
}

} // namespace dielast::bench
