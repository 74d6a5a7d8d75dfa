// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/dofs.hpp"

#include <gtest/gtest.h>

namespace dielast::fem {
namespace {

TEST(DofMap, free_unknowns_come_first_in_the_order_of_the_nodes_then_held_ones) {
  DofMap dofs(3);
  for (const int c : {0, 1, 5}) dofs.add(0, c);
  for (const int c : {0, 1}) dofs.add(2, c);
  dofs.add(0, 5); // again: no second unknown
  dofs.hold(0, 1);
  dofs.hold(2, 0);
  dofs.hold(2, 5); // not there: ignored
  dofs.hold(1, 0);
  dofs.add(0, 1); // stays held
  dofs.number();
  EXPECT_EQ(dofs.node_count(), 3);
  EXPECT_EQ(dofs.free_count(), 3);
  EXPECT_EQ(dofs.count(), 5);
  EXPECT_EQ(dofs.equation(0, 0), 0);
  EXPECT_EQ(dofs.equation(0, 5), 1);
  EXPECT_EQ(dofs.equation(2, 1), 2);
  EXPECT_EQ(dofs.equation(0, 1), 3);
  EXPECT_EQ(dofs.equation(2, 0), 4);
  for (int c = 0; c < DofMap::components; ++c) EXPECT_EQ(dofs.equation(1, c), DofMap::absent);
  EXPECT_EQ(dofs.equation(2, 5), DofMap::absent);
}

TEST(DofMap, shared_unknowns_are_one_equation_and_held_together) {
  DofMap dofs(4);
  for (int node = 0; node < 4; ++node)
    for (const int c : {0, 1}) dofs.add(node, c);
  dofs.share(3, 1, 0);
  dofs.share(1, 2, 0); // 1, 2 and 3 move together in x
  dofs.share(0, 2, 1);
  dofs.hold(2, 1); // and with it 0
  dofs.number();
  EXPECT_EQ(dofs.count(), 5);
  EXPECT_EQ(dofs.free_count(), 4);
  EXPECT_EQ(dofs.equation(1, 0), dofs.equation(2, 0));
  EXPECT_EQ(dofs.equation(1, 0), dofs.equation(3, 0));
  EXPECT_NE(dofs.equation(0, 0), dofs.equation(1, 0));
  EXPECT_EQ(dofs.equation(0, 1), 4);
  EXPECT_EQ(dofs.equation(2, 1), 4);
}

TEST(DofMap, displacements_along_different_axes_can_be_one_unknown) {
  DofMap dofs(3);
  for (int node = 0; node < 3; ++node)
    for (const int c : {0, 1}) dofs.add(node, c);
  dofs.share(1, 0, 2, 1);
  dofs.hold(0, 0);
  dofs.number();
  EXPECT_EQ(dofs.count(), 5);
  EXPECT_EQ(dofs.equation(1, 0), dofs.equation(2, 1));
  EXPECT_NE(dofs.equation(1, 0), dofs.equation(2, 0));
}

TEST(DofMap, advance_adds_displacements_and_turns_in_space) {
  DofMap dofs(2);
  for (int c = 0; c < DofMap::components; ++c) dofs.add(1, c);
  dofs.hold(1, 2);
  dofs.number();
  const Eigen::Quaterniond before = rotation_of({0.3, -0.2, 1});
  State state{
      .displacement = {{1, 2, 3}, {4, 5, 6}}, .rotation = {before, before}, .voltage = {}, .dead_force = {}};
  const Eigen::VectorXd increment = (Eigen::VectorXd(5) << 1, -1, 0.4, 0.6, -0.8).finished();
  dofs.advance(state, increment, 0.5);
  EXPECT_EQ(state.displacement[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(state.displacement[1], Eigen::Vector3d(4.5, 4.5, 6)); // held at 6
  EXPECT_EQ(state.rotation[0].coeffs(), before.coeffs());
  const Eigen::Vector3d spin(0.2, 0.3, -0.4);
  const Eigen::Matrix3d expected =
      Eigen::AngleAxisd(spin.norm(), spin.normalized()).toRotationMatrix() * before.toRotationMatrix();
  EXPECT_LT((state.rotation[1].toRotationMatrix() - expected).norm(), 1e-15);
  EXPECT_NEAR(state.rotation[1].norm(), 1, 1e-15);
}

TEST(DofMap, a_held_spin_keeps_its_component_of_the_increment_zero) {
  DofMap dofs(1);
  for (const int c : {3, 4, 5}) dofs.add(0, c);
  dofs.hold(0, 3);
  dofs.hold(0, 4);
  dofs.number();
  State state{.displacement = {Eigen::Vector3d::Zero()},
              .rotation = {Eigen::Quaterniond::Identity()},
              .voltage = {},
              .dead_force = {}};
  for (int step = 0; step < 100; ++step) dofs.advance(state, Eigen::VectorXd::Constant(1, 0.1), 1);
  const Eigen::Matrix3d expected = Eigen::AngleAxisd(10.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_LT((state.rotation[0].toRotationMatrix() - expected).norm(), 1e-13);
}

} // namespace
} // namespace dielast::fem
