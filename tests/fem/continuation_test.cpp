// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/continuation.hpp"

#include "tests/fem/material_point_block.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace dielast::fem::continuation_test {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Voltage from 0 to `volts`, or charge where the electrode is isolated.
LoadPath path_to(const Model& model, double volts, double charge) {
  const Loads rest = Loads::of(model.initial_state(), model.dofs);
  Loads full = rest;
  full.voltage[0] = volts;
  full.charge[0] = charge;
  return linear_path(model.dofs, rest, full);
}

// The free Gent film's curve through both limit points, closed form; J = 100: peak 0.68936322 at stretch
// 1.2638044, valley 0.27460055 at 5.07426.
TEST(Continuation, follows_a_gent_film_through_both_limit_points) {
  const auto model = test::material_point(100);
  Equilibrium equilibrium(*model, 1);
  const LoadPath path = path_to(*model, 1, 0);
  const ContinuationOptions options{.largest_arc = 0.05};
  auto progress = begin_continuation(equilibrium, path, model->initial_state(), 0, options);
  ASSERT_TRUE(progress);
  double highest = 0, lowest = 1, largest = 0;
  ContinuationObserver observer;
  observer.on_accept = [&](const ContinuationProgress& at) {
    const double l = 1 + at.state.displacement[0].x(), phi = at.state.voltage[0];
    EXPECT_NEAR(phi, test::equilibrium_voltage(100, l), 1e-8);
    EXPECT_EQ(phi, at.load_factor);
    EXPECT_EQ(at.newton.unstable_modes, l > 1.2638044 && l < 5.07426) << l;
    EXPECT_EQ(at.load_direction < 0, at.newton.unstable_modes == 1) << l;
    EXPECT_GT(l, largest);
    largest = l;
    if (l < 3) highest = std::max(highest, phi);
    if (l > 3) lowest = std::min(lowest, phi);
    return true;
  };
  EXPECT_EQ(continuation(equilibrium, path, options, *progress, observer), ContinuationEnd::reached_load);
  EXPECT_EQ(progress->load_factor, 1);
  EXPECT_NEAR(highest, 0.68936322, 3e-3);
  EXPECT_NEAR(lowest, 0.27460055, 3e-3);
  EXPECT_GT(largest, 7);
}

TEST(Continuation, under_charge_control_sees_no_limit_point) {
  const auto model = test::material_point(no_limit);
  Equilibrium equilibrium(*model, 1);
  const double l = 4, charge = test::equilibrium_voltage(no_limit, l) * std::pow(l, 4);
  const LoadPath path = path_to(*model, 0, charge);
  State state = model->initial_state();
  state.supply[0] = Supply::charge;
  auto progress = begin_continuation(equilibrium, path, state, 0, {});
  ASSERT_TRUE(progress);
  int falling_voltage = 0;
  ContinuationObserver observer;
  observer.on_accept = [&](const ContinuationProgress& at) {
    EXPECT_GT(at.load_direction, 0);
    EXPECT_EQ(at.newton.unstable_modes, 0);
    EXPECT_NEAR(at.state.voltage[0], test::equilibrium_voltage(no_limit, 1 + at.state.displacement[0].x()),
                1e-8);
    falling_voltage += at.newton.negative_pivots;
    return true;
  };
  EXPECT_EQ(continuation(equilibrium, path, {}, *progress, observer), ContinuationEnd::reached_load);
  EXPECT_NEAR(1 + progress->state.displacement[0].x(), l, 1e-8);
  EXPECT_GT(falling_voltage, 5);
}

TEST(Continuation, returns_to_no_load_on_the_way_it_came) {
  const auto model = test::material_point(100);
  Equilibrium equilibrium(*model, 1);
  const LoadPath path = path_to(*model, 1, 0);
  ContinuationOptions options{.most_steps = 40};
  auto progress = begin_continuation(equilibrium, path, model->initial_state(), 0, options);
  ASSERT_TRUE(progress);
  ASSERT_EQ(continuation(equilibrium, path, options, *progress, {}), ContinuationEnd::took_all_steps);
  EXPECT_GT(progress->state.displacement[0].x(), 0.5);
  progress->direction *= -1;
  progress->load_direction *= -1;
  options.most_steps = 200;
  EXPECT_EQ(continuation(equilibrium, path, options, *progress, {}), ContinuationEnd::reached_load);
  EXPECT_EQ(progress->load_factor, 0);
  EXPECT_NEAR(progress->state.displacement[0].x(), 0, 1e-9);
}

TEST(Continuation, stopped_and_resumed_it_ends_in_the_same_bits) {
  const auto model = test::material_point(100);
  Equilibrium equilibrium(*model, 1);
  const LoadPath path = path_to(*model, 1, 0);
  const auto start = begin_continuation(equilibrium, path, model->initial_state(), 0, {});
  ContinuationProgress through = *start, resumed = *start;
  continuation(equilibrium, path, {}, through, {});
  ContinuationObserver observer;
  observer.on_accept = [](const ContinuationProgress& at) { return at.steps < 20; };
  ASSERT_EQ(continuation(equilibrium, path, {}, resumed, observer), ContinuationEnd::stopped);
  EXPECT_EQ(resumed.steps, 20);
  continuation(equilibrium, path, {}, resumed, {});
  EXPECT_EQ(resumed.steps, through.steps);
  EXPECT_EQ(resumed.state.displacement, through.state.displacement);
}

// mu = 45 kPa, eps = 4e-11 F/m, H = 1 mm; homogeneous, so that each point of the path has a closed form.
TEST(Continuation, follows_a_free_film_past_pull_in) {
  const double side = 0.01;
  const meshing::Mesh mesh = test::distorted_square(3, 2, side);
  const auto model = test::square_film(mesh, side, test::Held::at_corners);
  Equilibrium equilibrium(*model, 1);
  const LoadPath path = path_to(*model, 30e3, 0);
  auto progress = begin_continuation(equilibrium, path, model->initial_state(), 0, {});
  ASSERT_TRUE(progress);
  const double volt = 1e-3 * std::sqrt(45e3 / 4e-11);
  double highest = 0, stretch = 1;
  ContinuationObserver observer;
  observer.on_accept = [&](const ContinuationProgress& at) {
    stretch = 1 + at.state.displacement[3].x() / side;
    EXPECT_NEAR(at.state.voltage[0], volt * test::equilibrium_voltage(no_limit, stretch), 1e-5 * volt);
    EXPECT_EQ(at.load_direction<0, stretch> std::cbrt(2.0));
    EXPECT_EQ(at.newton.unstable_modes > 0, stretch > std::cbrt(2.0));
    highest = std::max(highest, at.state.voltage[0] / volt);
    return stretch < 1.8;
  };
  EXPECT_EQ(continuation(equilibrium, path, {}, *progress, observer), ContinuationEnd::stopped);
  EXPECT_NEAR(highest, 0.6873648, 1e-3);
  EXPECT_GT(stretch, 1.8);
}

} // namespace
} // namespace dielast::fem::continuation_test
