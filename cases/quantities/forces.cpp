// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/quantities/forces.hpp"

#include "cases/devices/chamber.hpp"
#include "fem/elements/chamber_block.hpp"
#include "fem/model/contact_block.hpp"

#include <algorithm>
#include <set>
#include <span>

namespace dielast::cases {
namespace {

/// Sum of what is at the equations of a place's nodes, along each axis, as far as `counts` wants them.
template<class Rule>
Eigen::Vector3d sum_at(const Device& device, const std::string& place, const Eigen::VectorXd& values,
                       Rule counts) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    std::set<int> equations; // nodes that move as one share theirs
    for (const int node : device.mesh.node_sets.at(place))
      equations.insert(device.model.dofs.equation(node, c));
    for (const int e : equations)
      if (e != fem::DofMap::absent && counts(e)) sum[c] += values[e];
  }
  return sum;
}

/// Of some of a block's elements, at their equations.
void add_residual(const fem::ElementBlock& block, const std::vector<int>& elements, const fem::DofMap& dofs,
                  const fem::State& state, Eigen::VectorXd& residual) {
  const auto each = static_cast<std::size_t>(block.dofs_per_element());
  std::vector<int> equations(each * static_cast<std::size_t>(block.element_count()));
  for (const int element : elements) {
    block.element_equations(element, dofs,
                            std::span(equations).subspan(each * static_cast<std::size_t>(element), each));
    block.evaluate(state, element, element + 1, {.equation = equations.data(), .residual = residual.data()});
  }
}

} // namespace

Eigen::Vector3d support_force(const Device& device, const std::string& place,
                              const Eigen::VectorXd& reaction) {
  return sum_at(device, place, reaction, [&](int e) { return device.model.dofs.is_held(e); });
}

PullingFilm film_that_pulls(const std::string& place, const Case& one, const Device& device) {
  PullingFilm film{films_of(place, one, device), {}};
  if (std::ranges::all_of(film.elements, [](const FilmElements& f) { return f.elements.empty(); })) return {};
  if (!one.chamber) return film;
  const meshing::Mesh& mesh = device.mesh;
  const meshing::CellBlock wall = wall_of_chamber(one, mesh);
  const bool of_film = one.chamber->place.empty(); // and its cells are the film's
  const std::vector<int>* own = mesh.cells_of(place, mesh.film());
  const std::set<int> parts = film_parts_at(place, one, device);
  const auto is_beside = [&](int cell) {
    const auto there = std::ranges::count_if(wall.cell(cell), [&](int node) {
      return std::ranges::binary_search(mesh.node_sets.at(place), node);
    });
    if (!of_film) return there > 0 && there < std::ssize(wall.cell(cell));
    return there > 0 && parts.contains(device.film_parts[static_cast<std::size_t>(cell)]) &&
           !(own && std::ranges::binary_search(*own, cell));
  };
  std::vector<int> beside;
  for (int cell = 0; cell < wall.size(); ++cell)
    if (is_beside(cell)) beside.push_back(cell);
  film.pressed = meshing::subset(wall, beside);
  return film;
}

Eigen::Vector3d film_force(const Device& device, const std::string& place, const PullingFilm& film,
                           fem::Equilibrium& equilibrium, const fem::State& state) {
  const std::vector<FilmElements>& counted = film.elements;
  fem::Assembler& assembler = equilibrium.assembler();
  Eigen::VectorXd of_all, of_films = Eigen::VectorXd::Zero(device.model.dofs.count());
  assembler.residual(state, of_all);
  for (std::size_t b = 0; b < counted.size(); ++b)
    if (counted[b].all)
      of_films += assembler.block_residuals()[b];
    else
      add_residual(*device.model.blocks[b], counted[b].elements, device.model.dofs, state, of_films);
  Eigen::Vector3d force = -sum_at(device, place, of_films, [](int) { return true; });
  if (film.pressed.size() == 0) return force;
  const double pressure = state.voltage[device.model.ports.chamber()];
  const auto pressed = fem::pressure_forces(device.mesh, film.pressed, state, pressure);
  for (std::size_t n = 0; n < pressed.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (const int node = film.pressed.nodes[n];
          std::ranges::binary_search(device.mesh.node_sets.at(place), node) &&
          device.model.dofs.equation(node, c) != fem::DofMap::absent)
        force[c] += pressed[n][c];
  return force;
}

double largest_contact_pressure(const Device& device, const std::string& place, const fem::State& state) {
  const std::vector<double> pressure = fem::contact_pressure(device.model, state);
  if (place.empty()) return std::ranges::max(pressure);
  double largest = 0;
  for (const int node : device.mesh.node_sets.at(place))
    largest = std::max(largest, pressure[static_cast<std::size_t>(node)]);
  return largest;
}

} // namespace dielast::cases
