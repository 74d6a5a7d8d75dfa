// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/elements/beam_block.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/model/assembler.hpp"
#include "fem/model/model.hpp"
#include "materials/laws/dual.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

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
  auto model = std::make_unique<Model>(Model{.dofs = DofMap(nodes), .blocks = {}, .ports = {{"electrode"}}});
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

enum class Held { at_corners, along_edge };

/// Film of a distorted_square() of `side` (m) in its plane, numbered: clamped along its edge, or free but for
/// a corner and the height of the next one. `electrodes`: of its triangles; empty: all under the first one.
inline std::unique_ptr<Model> square_film(const meshing::Mesh& mesh, double side, Held held,
                                          std::vector<int> electrodes = {},
                                          const MembraneSection& section = vhb()) {
  const meshing::CellBlock& triangles = mesh.blocks[0];
  if (electrodes.empty()) electrodes.resize(static_cast<std::size_t>(triangles.size()), 0);
  auto model =
      unnumbered_model(mesh.node_count(), Dimension::planar,
                       make_membrane_block(mesh, triangles, section, std::move(electrodes), Dimension::planar,
                                           triangles.type == meshing::CellType::triangle3 ? 1 : 3));
  if (held == Held::along_edge)
    for (const int a : mesh.node_sets.at("edge"))
      for (const int c : {0, 1}) model->dofs.hold(a, c);
  else
    for (const auto& [a, c] :
         {std::pair{0, 0}, {0, 1}, {static_cast<int>(std::sqrt(triangles.size() / 2)), 1}})
      model->dofs.hold(a, c);
  model->dofs.number();
  model->length_scale = model->extent = side;
  return model;
}

/// A straight beam of unit length and EI = 1 that is clamped at its first node, numbered; it buckles at
/// pi^2/4 and a little more, by its shortening.
inline std::unique_ptr<Model> column(const meshing::Mesh& mesh, bool planar = true, double EA = 1e6) {
  auto model = unnumbered_model(
      mesh.node_count(), planar,
      make_beam_block(mesh, mesh.blocks[0], {.EA = EA, .GA2 = 1e6, .GA3 = 1e6, .GJ = 1, .EI2 = 1, .EI3 = 1}));
  for (int c = 0; c < DofMap::components; ++c) model->dofs.hold(0, c);
  model->dofs.number();
  return model;
}

inline Eigen::MatrixXd dense(const SparseSymmetric& matrix) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(matrix.size, matrix.size);
  matrix.for_each_entry([&](std::size_t k, int c, int r) { full(r, c) = full(c, r) = matrix.values[k]; });
  return full;
}

/// Energy, residual and tangent of a model whose unknowns are all free are those of a dual number in these
/// unknowns, to `tolerance` of its second derivatives, the tangent to 1e-12.
template<int N>
void expect_equal(Assembler& assembler, const State& state, const materials::Dual<N>& expected,
                  double tolerance = 1e-12) {
  const double scale = expected.hessian.norm();
  Eigen::VectorXd residual;
  EXPECT_NEAR(assembler.residual(state, residual).energy, expected.value, tolerance * scale);
  EXPECT_LT((residual - expected.gradient).norm(), tolerance * scale);
  assembler.tangent(state);
  EXPECT_LT((dense(assembler.matrix()) - expected.hessian).norm(), 1e-12 * scale);
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
