// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/dense_algebra.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::convexity_test {
namespace {

class Convexity : public ::testing::TestWithParam<bool> {};

// Random films, held at their edge, shaken, some of them compressed or near pull-in: what is said to be
// convex has no negative eigenvalue, and enough of both kinds are met.
TEST_P(Convexity, is_told_of_positive_definite_tangents_only) {
  const bool planar = GetParam();
  const auto mesh = test::distorted_square(3, 2);
  auto model = test::unnumbered_model(
      mesh.node_count(), planar,
      make_membrane_block(mesh, mesh.blocks[0], test::vhb(2.5, 2.5),
                          std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0),
                          test::dimension(planar), 6));
  for (const int n : mesh.node_sets.at("edge"))
    for (int c = 0; c < (planar ? 2 : 3); ++c) model->dofs.hold(n, c);
  model->dofs.number();
  Assembler assembler(*model, 1);
  std::mt19937 random(71);
  std::uniform_real_distribution<double> stretch(0.3, 1.6), voltage(0, 12e3);
  int convex = 0, definite = 0, indefinite = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F(0, 0) = stretch(random);
    F(1, 1) = stretch(random);
    F(0, 1) = stretch(random) - 1;
    State state = test::homogeneous(*model, mesh, F);
    for (auto& u : state.displacement) {
      u += test::random_vector(random, 3, 0.02);
      if (planar) u.z() = 0;
    }
    state.voltage = {voltage(random)};
    assembler.tangent(state);
    const double lowest = symmetric_eigen(test::dense(assembler.matrix())).values[0];
    if (lowest > 0)
      ++definite;
    else
      ++indefinite;
    if (!assembler.convex()) continue;
    ++convex;
    EXPECT_GT(lowest, 0) << "trial " << trial;
  }
  EXPECT_GT(convex, definite / 3) << "of " << definite;
  EXPECT_GT(indefinite, 30);
}

INSTANTIATE_TEST_SUITE_P(Films, Convexity, ::testing::Values(true, false));

} // namespace
} // namespace dielast::fem::convexity_test
