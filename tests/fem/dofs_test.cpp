// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/dofs.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::dofs_test {
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
  State state{.displacement = {{1, 2, 3}, {4, 5, 6}},
              .rotation = {before, before},
              .angle = {2, spin_of(before)},
              .voltage = {},
              .dead_force = {}};
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
              .angle = {Eigen::Vector3d::Zero()},
              .voltage = {},
              .dead_force = {}};
  for (int step = 0; step < 100; ++step) dofs.advance(state, Eigen::VectorXd::Constant(1, 0.1), 1);
  EXPECT_LT((state.angle[0] - Eigen::Vector3d(0, 0, 10)).norm(), 1e-13);
  const Eigen::Matrix3d expected = Eigen::AngleAxisd(10.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_LT((state.rotation[0].toRotationMatrix() - expected).norm(), 1e-13);
}

// What may happen to a node that a shell turns, before and after the shell comes.
TEST(DofMap, a_node_tilts_where_a_director_is_all_that_counts) {
  const Eigen::Vector3d normal(0.6, 0, 0.8), beside = (normal + 1e-6 * Eigen::Vector3d::UnitY()).normalized();
  enum : int {
    alone,
    twice,
    fold,
    clamped,
    simply_held,
    beam_before,
    beam_after,
    asked,
    shared,
    other,
    tied,
    master,
    nothing,
    nodes
  };
  DofMap dofs(nodes);
  for (int c = 3; c < 6; ++c) dofs.add(beam_before, c);
  for (int n = 0; n < master; ++n) dofs.add_director(n, normal);
  dofs.add_director(master, normal);
  dofs.add_director(twice, normal + 1e-12 * Eigen::Vector3d::UnitY());
  dofs.add_director(fold, beside);
  dofs.add_director(fold, normal);
  for (const int c : {3, 4, 5}) dofs.hold(clamped, c);
  dofs.hold(simply_held, 4);
  for (int c = 3; c < 6; ++c) dofs.add(beam_after, c);
  dofs.add_director(beam_after, normal);
  dofs.keep_spins(asked);
  dofs.keep_spins(nothing);
  dofs.share(shared, other, 3);
  dofs.tie({tied, master, {1, 0, 0}});
  const auto axes = dofs.tilt_axes(); // as blocks ask
  for (int c = 3; c < 6; ++c) EXPECT_NE(dofs.equation(alone, c), DofMap::absent) << "spins until number()";
  dofs.number();
  for (int n = 0; n < nodes; ++n) {
    const bool tilts = n == alone || n == twice || n == clamped;
    EXPECT_EQ(dofs.tilts(n), tilts) << n;
    EXPECT_EQ(!axes->at(static_cast<std::size_t>(n)).isZero(0), tilts) << n;
    for (int c = 3; c < 8; ++c)
      EXPECT_EQ(dofs.equation(n, c) != DofMap::absent, n != nothing && (c >= DofMap::tilt) == tilts)
          << n << c;
  }
  EXPECT_TRUE(dofs.is_held(dofs.equation(clamped, 6)) && dofs.is_held(dofs.equation(clamped, 7)));
  EXPECT_TRUE(dofs.is_free(dofs.equation(simply_held, 3)) && dofs.is_held(dofs.equation(simply_held, 4)));
  EXPECT_EQ(dofs.held_count(), 2 + 1);
  EXPECT_EQ(dofs.free_count(), 2 * 2 + 3 + 2 + 3 * 3 + (3 + 3 - 1) + 3);
  const TiltAxes& A = axes->front();
  EXPECT_LT((A.transpose() * A - Eigen::Matrix2d::Identity()).norm(), 1e-15);
  EXPECT_LT((A.col(0).cross(A.col(1)) - normal).norm(), 1e-15);
}

TEST(DofMap, tilts_turn_with_the_node_and_never_about_the_director) {
  DofMap dofs(1);
  const Eigen::Vector3d director = Eigen::Vector3d(1, -2, 0.5).normalized();
  dofs.add_director(0, director);
  dofs.number();
  ASSERT_EQ(dofs.free_count(), 2);
  const Eigen::Quaterniond R = rotation_of({0.3, -0.2, 1});
  State state{.displacement = {Eigen::Vector3d::Zero()},
              .rotation = {R},
              .angle = {spin_of(R)},
              .voltage = {},
              .dead_force = {}};
  const Eigen::Vector2d a(0.4, -0.9);
  const Eigen::Vector3d spin = dofs.spin(state, 0, a);
  EXPECT_LT((spin - R * (dofs.tilt_axes()->front() * a)).norm(), 1e-15);
  EXPECT_NEAR(spin.dot(R * director), 0, 1e-15);
  State there = state;
  dofs.advance(there, 2 * a, 0.5);
  EXPECT_LT((there.rotation[0].coeffs() - (rotation_of(spin) * R).coeffs()).norm(), 1e-15);
  EXPECT_LT((dofs.increment(state, there) - a).norm(), 1e-15);
  // From any rotation to any other one the director is led.
  for (const Eigen::Vector3d& other : {Eigen::Vector3d(1, 0.7, -0.4), Eigen::Vector3d(1e-9, 0, 2e-9)}) {
    State goal = state, reached = state;
    goal.rotation = {rotation_of(other) * R};
    dofs.advance(reached, dofs.increment(state, goal), 1);
    EXPECT_LT((reached.rotation[0] * director - goal.rotation[0] * director).norm(), 1e-15);
  }
}

} // namespace
} // namespace dielast::fem::dofs_test
