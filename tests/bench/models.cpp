// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/models.hpp"

#include "fem/elements/beam_block.hpp"
#include "fem/elements/distance_block.hpp"
#include "fem/films/membrane_block.hpp"
#include "materials/catalog.hpp"
#include "meshing/meridian.hpp"
#include "meshing/patch.hpp"
#include "meshing/rings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::bench {

namespace {

constexpr int order = 2, integration_points = 6;
constexpr bool curved = false;

int node_on_x_axis(const meshing::Mesh& mesh, const std::string& place) {
  for (const int n : mesh.node_sets.at(place)) {
    const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(n)];
    if (x.x() > 0 && std::abs(x.y()) < 1e-9) return n;
  }
  return -1;
}

Task begin(meshing::Mesh mesh, std::unique_ptr<fem::ElementBlock> block, fem::Dimension dimension,
           double extent) {
  Task task{.mesh = std::move(mesh), .model = {.dofs = fem::DofMap(0)}};
  fem::Model& model = task.model;
  model.dofs = fem::DofMap(task.mesh.node_count());
  model.ports = {{"film"}};
  model.extent = model.length_scale = extent;
  model.blocks.push_back(std::move(block));
  model.blocks.front()->claim_dofs(model.dofs, dimension);
  return task;
}

std::unique_ptr<fem::ElementBlock> membrane(const meshing::Mesh& mesh, double prestretch,
                                            std::vector<int> electrodes, fem::Dimension dimension) {
  return fem::make_membrane_block(
      mesh, mesh.blocks.front(),
      {.material = film, .thickness = 1e-3, .prestretch = {prestretch, prestretch}}, std::move(electrodes),
      dimension, dimension == fem::Dimension::axisymmetric ? 3 : integration_points);
}

} // namespace

void hold(Task& task, const std::string& place, std::initializer_list<int> components) {
  for (const int n : task.mesh.node_sets.at(place))
    for (const int c : components) task.model.dofs.hold(n, c);
}

Task partial_electrode_disc(int rings) {
  auto mesh = meshing::disc_mesh(0.09, 0.03, rings, order, curved);
  std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks.front().size()), fem::passive);
  for (const int cell : mesh.cell_sets.at("electrode").cells) electrodes[static_cast<std::size_t>(cell)] = 0;
  auto block = membrane(mesh, 3, std::move(electrodes), fem::Dimension::planar);
  Task task = begin(std::move(mesh), std::move(block), fem::Dimension::planar, 0.09);
  hold(task, "rim", {0, 1});
  task.model.dofs.number();
  task.node = node_on_x_axis(task.mesh, "electrode_edge");
  fem::Loads voltage = fem::Loads::of(task.model.initial_state(), task.model.dofs);
  voltage.voltage = {5e3};
  task.steps = {{voltage, 10}};
  return task;
}

constexpr double diaphragm_extent = 0.06858;

meshing::Mesh diaphragm_mesh(int k) {
  return meshing::annulus_mesh(12.7e-3, diaphragm_extent, 22 * k, order, curved);
}

Task diaphragm(meshing::Mesh mesh, std::unique_ptr<fem::ElementBlock> block, double thickness) {
  Task task = begin(std::move(mesh), std::move(block), fem::Dimension::spatial, diaphragm_extent);
  hold(task, "outer", {0, 1, 2});
  hold(task, "inner", {0, 1});
  const auto& inner = task.mesh.node_sets.at("inner");
  for (const int n : inner) task.model.dofs.share(inner.front(), n, 2);
  task.model.dofs.number();
  task.node = inner.front();
  task.component = 2;
  fem::Loads weight = fem::Loads::of(task.model.initial_state(), task.model.dofs);
  weight.dead_force[task.model.dofs.equation(inner.front(), 2)] = 0.981 * thickness;
  fem::Loads voltage = weight;
  voltage.voltage = {5e3 * thickness};
  task.steps = {{weight, 5}, {voltage, 10}};
  return task;
}

Task plate_diaphragm(int k) {
  auto mesh = diaphragm_mesh(k);
  std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks.front().size()), 0);
  auto block = membrane(mesh, 2, std::move(electrodes), fem::Dimension::spatial);
  return diaphragm(std::move(mesh), std::move(block), 1);
}

Task rolled_muscle() {
  const auto found = std::ranges::find(materials::named_films(), "VHB F9473PC", &materials::NamedFilm::name);
  Task task{.mesh = meshing::patch_mesh(muscle_prestretch * muscle_length, 0.25),
            .model = {.dofs = fem::DofMap(0)}};
  fem::Model& model = task.model;
  model.dofs = fem::DofMap(task.mesh.node_count());
  model.ports = {{"film"}};
  model.extent = model.length_scale = 0.25;
  model.blocks.push_back(fem::make_membrane_block(
      task.mesh, task.mesh.blocks.front(),
      {.material = found->material, .thickness = 0.254e-3, .prestretch = {muscle_prestretch, 1}}, {0, 0},
      fem::Dimension::planar, 1));
  const auto& sets = task.mesh.node_sets;
  const auto end = [&sets](const char* place) {
    const auto& nodes = sets.at(place);
    return fem::DistanceEnd{nodes, std::vector<double>(nodes.size(), 1 / static_cast<double>(nodes.size()))};
  };
  const fem::Distance along{{end("left"), end("right")}, 0};
  model.blocks.push_back(fem::make_distance_block(task.mesh, along, fem::Spring{180, 110e-3}));
  model.blocks.push_back(
      fem::make_distance_block(task.mesh, along, fem::Linkage{0.712206, 110e-3, 60e-3, 47.3e-3}));
  for (const auto& block : model.blocks) block->claim_dofs(model.dofs, fem::Dimension::planar);
  hold(task, "left", {0});
  hold(task, "bottom", {1});
  hold(task, "top", {1});
  for (const int n : sets.at("right")) model.dofs.share(sets.at("right").front(), n, 0);
  model.dofs.number();
  model.place_histories();
  task.node = sets.at("right").front();
  task.framed = true;
  task.steps = {{fem::Loads::of(model.initial_state(), model.dofs), 10}};
  return task;
}

Task film_in_a_ring() {
  auto mesh = meshing::disc_mesh(8e-3, 4e-3, 6, order, curved);
  meshing::CellBlock ring{meshing::CellType::line3, {}};
  const auto& rim = mesh.node_sets.at("rim");
  const auto on_rim = [&](int node) { return std::ranges::count(rim, node) > 0; };
  for (int cell = 0; cell < mesh.blocks.front().size(); ++cell) {
    const auto nodes = mesh.blocks.front().cell(cell);
    for (std::size_t i = 0; i < 3; ++i)
      if (const int a = nodes[i], b = nodes[(i + 1) % 3]; on_rim(a) && on_rim(b))
        ring.nodes.insert(ring.nodes.end(), {a, b, nodes[3 + i]});
  }
  std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks.front().size()), 0);
  auto block = membrane(mesh, 1.5, std::move(electrodes), fem::Dimension::planar);
  Task task = begin(std::move(mesh), std::move(block), fem::Dimension::planar, 8e-3);
  fem::Model& model = task.model;
  model.blocks.push_back(fem::make_beam_block(
      task.mesh, ring, materials::rectangular_section({78e6, 0.36, 0.55}, 1.6e-3, 2e-3)));
  model.blocks.back()->claim_dofs(model.dofs, fem::Dimension::planar);
  hold(task, "centre", {0, 1});
  task.node = node_on_x_axis(task.mesh, "rim");
  model.dofs.hold(task.node, 1);
  model.dofs.number();
  task.framed = true;
  const fem::Loads free = fem::Loads::of(model.initial_state(), model.dofs);
  fem::Loads voltage = free;
  voltage.voltage = {4e3};
  task.steps = {{free, 1}, {voltage, 4}};
  return task;
}

Task meridian_of_diaphragm() {
  auto mesh = meshing::annulus_meridian(12.7e-3, 68.58e-3, 40, order, 4);
  auto block = membrane(mesh, 2, std::vector<int>(40, 0), fem::Dimension::axisymmetric);
  Task task = begin(std::move(mesh), std::move(block), fem::Dimension::axisymmetric, diaphragm_extent);
  hold(task, "outer", {0, 2});
  hold(task, "inner", {0});
  task.model.dofs.number();
  task.node = task.mesh.node_sets.at("inner").front();
  task.component = 2;
  fem::Loads weight = fem::Loads::of(task.model.initial_state(), task.model.dofs);
  weight.dead_force[task.model.dofs.equation(task.node, 2)] = 0.981;
  fem::Loads voltage = weight;
  voltage.voltage = {5e3};
  task.steps = {{weight, 5}, {voltage, 10}};
  return task;
}

fem::State begun(const Task& task, fem::Equilibrium& equilibrium) {
  fem::State state = task.model.initial_state();
  if (task.framed) equilibrium.internal_force(state, state.dead_force);
  state.dead_force.tail(task.model.dofs.held_count()).setZero();
  return state;
}

fem::LoadPath rolled_muscle_cycles() {
  fem::LoadPath path;
  path.apply = [](fem::State& state, double s) {
    state.voltage = {4e3 * std::sin(2 * std::numbers::pi * 0.5 * muscle_duration * s)};
  };
  return path;
}

} // namespace dielast::bench
