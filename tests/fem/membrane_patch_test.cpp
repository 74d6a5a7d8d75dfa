// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"
#include "materials/laws/plane_stress.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::membrane_patch_test {
namespace {

struct Kind {
  int order, points;
  bool planar;
};

std::string name(const ::testing::TestParamInfo<Kind>& info) {
  return std::string(info.param.order == 1 ? "t3" : "t6") + (info.param.planar ? "_planar" : "_spatial") +
         (info.param.points == 6 ? "_six_points" : "");
}

class MembranePatch : public ::testing::TestWithParam<Kind> {};

// A film of distorted triangles whose edge is moved as x = F X must follow inside, under one stress
// everywhere.
TEST_P(MembranePatch, homogeneous_deformation_is_exact_and_found_from_a_perturbed_start) {
  const auto [order, points, planar] = GetParam();
  const double side = 0.02, voltage = 3e3;
  const meshing::Mesh mesh = test::distorted_square(4, order, side, 0.35);
  const MembraneSection section = test::vhb(2.0, 1.5);
  const std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks[0].size()), 0);
  auto model = test::unnumbered_model(
      mesh.node_count(), planar,
      make_membrane_block(mesh, mesh.blocks[0], section, electrodes, test::dimension(planar), points));
  for (const int a : mesh.node_sets.at("edge"))
    for (int c = 0; c < 3; ++c) model->dofs.hold(a, c);
  model->dofs.number();
  model->length_scale = model->extent = side;

  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.topLeftCorner<2, 2>() << 1.2, 0.35, -0.1, 0.9;
  if (!planar) F = rotation_of({0.5, -1.1, 0.8}) * F;
  const State exact = test::homogeneous(*model, mesh, F);
  State state = exact;
  std::mt19937 random(71);
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    for (int c = 0; c < (planar ? 2 : 3); ++c)
      if (model->dofs.equation(static_cast<int>(a), c) < model->dofs.free_count())
        state.displacement[a][c] += test::random_vector(random, 1, 0.05 * side / 4)[0];
  state.voltage = {voltage};

  Equilibrium equilibrium(*model, 1);
  const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-13, .max_iterations = 15});
  ASSERT_EQ(result.outcome, Outcome::converged);
  EXPECT_EQ(result.negative_pivots, 0);
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    EXPECT_LT((state.displacement[a] - exact.displacement[a]).norm(), 1e-12 * side);

  const Eigen::Matrix2d prestretch = Eigen::Vector2d(2.0, 1.5).asDiagonal();
  const Eigen::Matrix<double, 3, 2> total = F.leftCols<2>() * prestretch;
  const Eigen::Matrix2d C = total.transpose() * total;
  const double k = 4e-11 * voltage * voltage / 1e-6;
  // Neo-Hookean sheet: S = mu (1 - C^-1/det C) - k det C C^-1.
  const Eigen::Matrix2d S = 45e3 * (Eigen::Matrix2d::Identity() - C.inverse() / C.determinant()) -
                            k * C.determinant() * C.inverse();
  double volume = 0;
  for (const MembraneSample& sample : model->sample(state).film) {
    EXPECT_LT((sample.F - total).norm(), 1e-10);
    EXPECT_LT((sample.S - S).norm(), 1e-10 * S.norm());
    EXPECT_EQ(sample.voltage, voltage);
    volume += sample.volume;
  }
  EXPECT_NEAR(volume, side * side * 1e-3 / 3.0, 1e-12 * volume);

  // Virial of the nodal forces: sum_a f_a X_a^T = V F S F0^T. Inside nothing is left.
  Eigen::VectorXd force;
  equilibrium.internal_force(state, force);
  Eigen::Matrix<double, 3, 2> virial = Eigen::Matrix<double, 3, 2>::Zero();
  for (int a = 0; a < mesh.node_count(); ++a)
    for (int c = 0; c < 3; ++c)
      if (const int e = model->dofs.equation(a, c); e != DofMap::absent)
        virial.row(c) += force[e] * mesh.nodes[static_cast<std::size_t>(a)].head<2>().transpose();
  const Eigen::Matrix<double, 3, 2> expected = volume * total * S * prestretch;
  EXPECT_LT((virial - expected).norm(), 1e-11 * expected.norm());
  EXPECT_LT(force.head(model->dofs.free_count()).norm(), 1e-12 * force.norm());
}

INSTANTIATE_TEST_SUITE_P(All, MembranePatch,
                         ::testing::Values(Kind{1, 1, true}, Kind{1, 1, false}, Kind{2, 3, true},
                                           Kind{2, 6, true}, Kind{2, 3, false}, Kind{2, 6, false}),
                         name);

} // namespace
} // namespace dielast::fem::membrane_patch_test
