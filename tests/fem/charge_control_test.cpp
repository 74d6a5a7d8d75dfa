// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"

#include "tests/fem/material_point_block.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::charge_control_test {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

// Limit points of the Gent film (J = 100) under voltage: stretches 1.2638044 (peak) and 5.07426 (valley).
TEST(ChargeControl, the_whole_voltage_stretch_curve_is_stable_and_its_falling_part_has_a_negative_pivot) {
  for (const double J : {no_limit, 100.0}) {
    const auto model = test::material_point(J);
    Equilibrium equilibrium(*model, 1);
    State state = model->initial_state();
    state.supply[0] = Supply::charge;
    const double peak = J == no_limit ? std::cbrt(2.0) : 1.2638044443828862;
    const double valley = J == no_limit ? no_limit : 5.07426;
    for (double l = 1.05; l < 7; l += 0.05) {
      const double phi = test::equilibrium_voltage(J, l);
      state.charge[0] = phi * std::pow(l, 4);
      const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-12});
      ASSERT_EQ(result.outcome, Outcome::converged) << J << " " << l;
      EXPECT_NEAR(1 + state.displacement[0].x(), l, 1e-9) << J;
      EXPECT_NEAR(state.voltage[0], phi, 1e-9) << J;
      EXPECT_EQ(result.unstable_modes, 0) << J << " " << l;
      EXPECT_EQ(result.negative_pivots, l > peak && l < valley) << J << " " << l;
    }
  }
}

TEST(ChargeControl, finds_the_limit_point_itself) {
  const auto model = test::material_point(no_limit);
  Equilibrium equilibrium(*model, 1);
  State state = model->initial_state();
  state.supply[0] = Supply::charge;
  const double l = std::cbrt(2.0), phi = test::equilibrium_voltage(no_limit, l);
  state.charge[0] = phi * std::pow(l, 4);
  const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-14});
  ASSERT_EQ(result.outcome, Outcome::converged);
  EXPECT_EQ(result.unstable_modes, 0);
  EXPECT_NEAR(1 + state.displacement[0].x(), l, 1e-12);
  EXPECT_NEAR(state.voltage[0], 0.6873648184993013, 1e-12);
}

TEST(ChargeControl, an_electrode_without_film_has_no_voltage_for_its_charge) {
  auto model = test::material_point(no_limit);
  model->ports.push_back({"nowhere"});
  Equilibrium equilibrium(*model, 1);
  State state = model->initial_state();
  state.supply[1] = Supply::charge;
  state.charge[1] = 1;
  EXPECT_EQ(equilibrium.solve(state, {}).outcome, Outcome::infeasible);
}

TEST(ChargeControl, gives_back_the_states_of_voltage_control_when_two_electrodes_are_cut_off) {
  const double side = 0.01;
  const meshing::Mesh mesh = test::distorted_square(4, 2, side);
  std::vector<int> electrodes(32);
  for (std::size_t e = 0; e < electrodes.size(); ++e) electrodes[e] = e % 7 == 0 ? passive : e < 16 ? 0 : 1;
  const auto model = test::square_film(mesh, side, test::Held::at_corners, electrodes);
  model->ports = {{"left"}, {"right"}};
  Equilibrium equilibrium(*model, 1);
  State driven = model->initial_state();
  driven.voltage = {14e3, 17e3};
  const NewtonOptions tight{.tolerance = 1e-12};
  ASSERT_EQ(equilibrium.solve(driven, tight).outcome, Outcome::converged);
  const Charges held = model->charges(driven, false);
  for (const Supply left : {Supply::voltage, Supply::charge}) {
    State state = model->initial_state();
    state.voltage = {14e3, 0};
    state.supply = {left, Supply::charge};
    state.charge = held.charge;
    ASSERT_EQ(equilibrium.solve(state, tight).outcome, Outcome::converged);
    for (const std::size_t e : {0, 1}) EXPECT_NEAR(state.voltage[e], driven.voltage[e], 1e-6);
    for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
      EXPECT_LT((state.displacement[a] - driven.displacement[a]).norm(), 1e-9 * side);

    state.charge = {0, 0}; // discharged
    state.voltage[0] = left == Supply::charge ? state.voltage[0] : 0;
    ASSERT_EQ(equilibrium.solve(state, tight).outcome, Outcome::converged);
    EXPECT_EQ(state.voltage, (std::vector{0.0, 0.0}));
  }
}

} // namespace
} // namespace dielast::fem::charge_control_test
