// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/elements/beam_block.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/model/assembler.hpp"
#include "fem/model/model.hpp"

#include <Eigen/Dense>

#include <memory>
#include <random>
#include <utility>

namespace dielast::fem::test {

/// The honeycomb's film: mu = 45 kPa, eps = 4e-11 F/m, H = 1 mm.
inline MembraneSection vhb(double prestretch_1 = 1, double prestretch_2 = 1) {
  return {.material = {.law = materials::NeoHookean{45e3},
                       .dielectric = {.permittivity = 4e-11, .breakdown_field = 100e6},
                       .density = 960},
          .thickness = 1e-3,
          .prestretch = {prestretch_1, prestretch_2}};
}

/// The same film with branches: neo-Hookean, Gent, and a nominal dashpot along x.
inline MembraneSection viscoelastic_vhb() {
  MembraneSection section = vhb();
  section.material.branches = {
      {materials::NeoHookean{30e3}, materials::Dashpot::log, 30e3 * 0.5},
      {materials::Gent{20e3, 80}, materials::Dashpot::log, 20e3 * 7},
      {materials::NeoHookean{10e3}, materials::Dashpot::nominal, 10e3 * 2, {true, false}}};
  return section;
}

/// A section whose six stiffnesses differ, of order one on elements of unit length.
inline materials::BeamSection uneven_section() {
  return {.EA = 5, .GA2 = 2, .GA3 = 3, .GJ = 0.7, .EI2 = 1.1, .EI3 = 0.4};
}

inline Dimension dimension(bool planar) { return planar ? Dimension::planar : Dimension::spatial; }

/// A model of these blocks, every unknown free; hold() and number() are left to the caller.
template<class... Blocks>
std::unique_ptr<Model> unnumbered_model(int nodes, Dimension dimension, Blocks&&... blocks) {
  auto model =
      std::make_unique<Model>(Model{.dofs = DofMap(nodes), .blocks = {}, .electrodes = {"electrode"}});
  (model->blocks.push_back(std::forward<Blocks>(blocks)), ...);
  for (const auto& block : model->blocks) {
    block->place_scalars(model->dofs);
    block->claim_dofs(model->dofs, dimension);
  }
  model->place_histories();
  return model;
}
template<class... Blocks>
std::unique_ptr<Model> unnumbered_model(int nodes, bool planar, Blocks&&... blocks) {
  return unnumbered_model(nodes, dimension(planar), std::forward<Blocks>(blocks)...);
}

template<class... Blocks>
std::unique_ptr<Model> free_model(int nodes, Dimension dimension, Blocks&&... blocks) {
  auto model = unnumbered_model(nodes, dimension, std::forward<Blocks>(blocks)...);
  model->dofs.number();
  return model;
}
template<class... Blocks>
std::unique_ptr<Model> free_model(int nodes, bool planar, Blocks&&... blocks) {
  return free_model(nodes, dimension(planar), std::forward<Blocks>(blocks)...);
}

inline Eigen::MatrixXd dense(const SparseSymmetric& matrix) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(matrix.size, matrix.size);
  for (int c = 0; c < matrix.size; ++c)
    for (int k = matrix.column_start[c]; k < matrix.column_start[c + 1]; ++k)
      full(matrix.rows[k], c) = full(c, matrix.rows[k]) = matrix.values[k];
  return full;
}

inline Eigen::VectorXd random_vector(std::mt19937& random, Eigen::Index size, double amplitude = 1) {
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
}

inline Eigen::Quaterniond random_rotation(std::mt19937& random, double largest_angle) {
  const Eigen::Vector3d axis = random_vector(random, 3).normalized();
  return rotation_of(largest_angle * std::uniform_real_distribution<double>(-1, 1)(random) * axis);
}

/// Moves the state as a rigid body: x -> Q x + c.
inline State moved(const State& state, const meshing::Mesh& mesh, const Eigen::Quaterniond& Q,
                   const Eigen::Vector3d& c) {
  State result = state;
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    result.displacement[a] = Q * (mesh.nodes[a] + state.displacement[a]) + c - mesh.nodes[a];
    result.rotation[a] = Q * state.rotation[a];
  }
  return result;
}

/// Deforms the mesh homogeneously: x = F X.
inline State homogeneous(const Model& model, const meshing::Mesh& mesh, const Eigen::Matrix3d& F) {
  State state = model.initial_state();
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    state.displacement[a] = F * mesh.nodes[a] - mesh.nodes[a];
  return state;
}

} // namespace dielast::fem::test
