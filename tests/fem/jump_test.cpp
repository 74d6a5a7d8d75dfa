// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/jump.hpp"

#include "fem/paths/instability.hpp"
#include "tests/fem/material_point_block.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::jump_test {
namespace {

State at_stretch(const Model& model, double J, double l) {
  State state = model.initial_state();
  state.displacement[0].x() = l - 1;
  state.voltage[0] = test::equilibrium_voltage(J, l);
  return state;
}

// From the peak of a Gent film's curve (J = 100, stretch 1.2638) at the same voltage.
TEST(Jump, lands_on_the_upper_branch_after_the_peak) {
  const auto model = test::material_point(100);
  Equilibrium equilibrium(*model, 1);
  State state = at_stretch(*model, 100, 1.2638044443828862);
  const double voltage = state.voltage[0];
  const JumpResult result =
      jump(equilibrium, state, Eigen::VectorXd::Ones(1), {.newton = {.tolerance = 1e-12}});
  ASSERT_EQ(result.end, JumpEnd::landed);
  EXPECT_NEAR(1 + state.displacement[0].x(), 7.026280627848488, 1e-8);
  EXPECT_EQ(state.voltage[0], voltage);
  EXPECT_EQ(result.newton.unstable_modes, 0);
  const auto energy = [&](double l) {
    const double I = 2 * l * l + std::pow(l, -4);
    return -50 * std::log(1 - (I - 3) / 100) - voltage * voltage * std::pow(l, 4) / 2;
  };
  EXPECT_NEAR(result.energy_released, energy(1.2638044443828862) - energy(7.026280627848488), 1e-4);
  EXPECT_LT(result.steps, 200);
}

// Back from the valley, downwards in stretch.
TEST(Jump, lands_on_the_lower_branch_after_the_valley) {
  const auto model = test::material_point(100);
  Equilibrium equilibrium(*model, 1);
  State state = at_stretch(*model, 100, 5.07426);
  state.voltage[0] *= 1 - 1e-9;
  ASSERT_EQ(jump(equilibrium, state, Eigen::VectorXd::Ones(1), {}).end, JumpEnd::landed);
  EXPECT_NEAR(1 + state.displacement[0].x(), 1.0135277, 1e-6);
}

TEST(Jump, finds_nothing_to_land_on_without_a_stretch_limit) {
  const double none = std::numeric_limits<double>::infinity();
  const auto model = test::material_point(none);
  Equilibrium equilibrium(*model, 1);
  State state = at_stretch(*model, none, 1.5);
  EXPECT_EQ(jump(equilibrium, state, Eigen::VectorXd::Ones(1), {.push = 0.01}).end, JumpEnd::ran_away);
  EXPECT_GT(state.displacement[0].x(), 100);
}

TEST(Jump, can_be_interrupted_on_its_way) {
  const auto model = test::material_point(100);
  Equilibrium equilibrium(*model, 1);
  State state = at_stretch(*model, 100, 1.2638044443828862);
  int asked = 0;
  const JumpResult left =
      jump(equilibrium, state, Eigen::VectorXd::Ones(1), {.goes_on = [&] { return ++asked < 4; }});
  EXPECT_EQ(left.end, JumpEnd::interrupted);
  EXPECT_EQ(left.steps, 3);
}

// A column's straight state beyond its buckling load falls to the bent one.
TEST(Jump, lets_a_column_buckle) {
  const meshing::Mesh mesh = test::line(8, 2, [](double s) { return Eigen::Vector3d(s, 0, 0); });
  const auto model = test::column(mesh);
  Equilibrium equilibrium(*model, 1);
  const int tip = mesh.node_count() - 1;
  State state = model->initial_state();
  state.dead_force[model->dofs.equation(tip, 0)] = -1.063 * 2.4674011;
  ASSERT_EQ(equilibrium.solve(state, {}).unstable_modes, 1);
  const auto mode = lowest_mode(equilibrium, state);
  ASSERT_TRUE(mode);
  EXPECT_LT(mode->eigenvalue, 0);
  for (const double side : {1.0, -1.0}) { // both as good: the mode decides
    State bent = state;
    ASSERT_EQ(jump(equilibrium, bent, side * mode->direction, {}).end, JumpEnd::landed);
    EXPECT_NEAR(side * bent.displacement[tip].y(), 0.422, 2e-3); // elastica
  }
}

} // namespace
} // namespace dielast::fem::jump_test
