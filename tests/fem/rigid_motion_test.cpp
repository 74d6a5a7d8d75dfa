// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/honeycomb_mesh.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::rigid_motion_test {
namespace {

/// One honeycomb cell: prestretched, charged film and walls that share their nodes; element order and
/// planarity.
class RigidMotion : public ::testing::TestWithParam<std::tuple<int, bool>> {};

// A finite rotation and translation of any deformed state keeps the energy and turns forces and moments with
// it.
TEST_P(RigidMotion, keeps_the_energy_and_turns_residual_and_tangent) {
  const auto [order, planar] = GetParam();
  const double size = 8e-3;
  const meshing::Mesh mesh = meshing::honeycomb_mesh({150 * std::numbers::pi / 180, {1}, size},
                                                     {.order = order, .wall_elements = 2});
  const auto model = test::free_model(
      mesh.node_count(), planar,
      make_membrane_block(mesh, mesh.blocks[0], test::vhb(4, 2.5),
                          std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0),
                          test::dimension(planar), order == 1 ? 1 : 3),
      make_beam_block(mesh, mesh.blocks[1],
                      materials::rectangular_section({78e6, 0.36, 0.55}, 0.8e-3, 2e-3)));
  std::mt19937 random(81);
  State state = model->initial_state();
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    state.displacement[a] = test::random_vector(random, 3, 0.03 * size);
    state.rotation[a] = test::random_rotation(random, 0.5);
    if (planar) {
      state.displacement[a].z() = 0;
      state.rotation[a] = rotation_of({0, 0, test::random_vector(random, 1, 0.5)[0]});
    }
  }
  state.voltage = {5e3};

  const Eigen::Quaterniond Q =
      rotation_of(planar ? Eigen::Vector3d(0, 0, 2.2) : Eigen::Vector3d(1.3, -0.9, 1.7));
  const Eigen::Vector3d shift(0.05, -0.02, planar ? 0 : 0.03);
  const State turned = test::moved(state, mesh, Q, shift);
  Eigen::MatrixXd turn =
      Eigen::MatrixXd::Zero(model->dofs.count(), model->dofs.count()); // Q for every node's vectors
  for (int a = 0; a < mesh.node_count(); ++a)
    for (int part = 0; part < 6; part += 3)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const int row = model->dofs.equation(a, part + i), column = model->dofs.equation(a, part + j);
          if (row != DofMap::absent && column != DofMap::absent)
            turn(row, column) = Q.toRotationMatrix()(i, j);
        }

  Assembler assembler(*model, 1);
  Eigen::VectorXd before, after;
  const Evaluation here = assembler.residual(state, before);
  ASSERT_TRUE(here.feasible);
  assembler.tangent(state);
  const Eigen::MatrixXd K = test::dense(assembler.matrix());
  const Evaluation there = assembler.residual(turned, after);
  assembler.tangent(turned);
  EXPECT_NEAR(there.energy, here.energy, 1e-12 * std::abs(here.energy));
  EXPECT_LT((after - turn * before).norm(), 1e-12 * before.norm());
  EXPECT_LT((test::dense(assembler.matrix()) - turn * K * turn.transpose()).norm(), 1e-12 * K.norm());

  Eigen::Vector3d force = Eigen::Vector3d::Zero(); // internal forces are in balance with themselves
  for (int a = 0; a < mesh.node_count(); ++a)
    for (int c = 0; c < 3; ++c)
      if (const int e = model->dofs.equation(a, c); e != DofMap::absent) force[c] += before[e];
  EXPECT_LT(force.norm(), 1e-12 * before.norm());
}

INSTANTIATE_TEST_SUITE_P(FilmAndWalls, RigidMotion,
                         ::testing::Combine(::testing::Values(1, 2), ::testing::Bool()), [](const auto& one) {
                           return std::string(std::get<0>(one.param) == 1 ? "linear" : "quadratic") +
                                  (std::get<1>(one.param) ? "_planar" : "_spatial");
                         });

TEST(CurvedBeam, rigid_motion_makes_no_stress) {
  for (const int order : {1, 2}) {
    const meshing::Mesh mesh = test::line(
        5, order, [](double s) { return Eigen::Vector3d(std::sin(2 * s), 1 - std::cos(2 * s), s); });
    const auto model = test::free_model(mesh.node_count(), false,
                                        make_beam_block(mesh, mesh.blocks[0], test::uneven_section()));
    Assembler assembler(*model, 1);
    Eigen::VectorXd residual;
    const State state = test::moved(model->initial_state(), mesh, rotation_of({2, 1, -1.5}), {3, 4, 5});
    EXPECT_LT(assembler.residual(state, residual).energy, 1e-27);
    EXPECT_LT(residual.norm(), 1e-12);
  }
}

} // namespace
} // namespace dielast::fem::rigid_motion_test
