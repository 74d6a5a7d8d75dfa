// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/ramp.hpp"

#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::ramp_test {
namespace {

/// Free square film under voltage: pull-in at the equal-biaxial stretch 2^(1/3).
class FreeFilm : public ::testing::Test {
 protected:
  static constexpr double side = 0.01;
  /// Phi/H sqrt(eps/mu) at the limit point (closed form, Zhao & Suo 2007), times H sqrt(mu/eps): 23.055 kV.
  static constexpr double pull_in = 0.6873648184993013 * 1e-3 * 33541019.66249685;
  const meshing::Mesh mesh = test::distorted_square(3, 1, side);
  std::unique_ptr<Model> model = test::square_film(mesh, side, test::Held::at_corners);
  Equilibrium equilibrium{*model, 1};
  State state = model->initial_state();

  RampResult run(double volts, const RampOptions& options, RampProgress& progress,
                 const RampObserver& observer = {}) {
    Loads target = progress.start;
    target.voltage = {volts};
    const RampResult result =
        ramp(equilibrium, linear_path(model->dofs, progress.start, target), options, progress, observer);
    state = progress.points.back().state;
    return result;
  }
  RampResult run(double volts, const RampOptions& options, const RampObserver& observer = {}) {
    RampProgress progress = RampProgress::begin(state, model->dofs, options);
    return run(volts, options, progress, observer);
  }
  double stretch(const State& at) const { return 1 + at.displacement[3].x() / side; }
  static double voltage_at(double lambda) {
    return 1e-3 * std::sqrt(45e3 / 4e-11 * (std::pow(lambda, -2) - std::pow(lambda, -8)));
  }
};

TEST_F(FreeFilm, stops_a_step_that_does_not_come_to_its_end) {
  RampOptions options{.newton = {}, .increments = 50, .most_tries = 3};
  RampProgress progress = RampProgress::begin(state, model->dofs, options);
  EXPECT_EQ(run(22e3, options, progress).end, RampEnd::endless);
  EXPECT_NEAR(progress.load_factor, 0.06, 1e-12);
  options.most_tries = 6; // resumed, it goes on, by more than a tenth in as many
  EXPECT_EQ(run(22e3, options, progress).end, RampEnd::complete);
}

TEST_F(FreeFilm, follows_the_closed_form_in_equal_increments) {
  std::vector<double> factors;
  const auto accept = [&](const RampProgress& progress, const Increment& increment) {
    const State& at = progress.points.back().state;
    factors.push_back(increment.load_factor);
    EXPECT_EQ(progress.load_factor, increment.load_factor);
    EXPECT_NEAR(at.voltage[0], increment.load_factor * 22e3, 1e-9);
    EXPECT_NEAR(voltage_at(stretch(at)), at.voltage[0], 1e-6 * at.voltage[0]);
    EXPECT_EQ(increment.newton.negative_pivots, 0);
    return true;
  };
  EXPECT_EQ(run(22e3, {.newton = {}, .increments = 5}, {.on_accept = accept}).end, RampEnd::complete);
  ASSERT_EQ(factors.size(), 5U);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(factors[static_cast<std::size_t>(i)], (i + 1) / 5.0, 1e-12);
}

TEST_F(FreeFilm, gives_up_at_the_limit_point_and_keeps_the_last_accepted_state) {
  State accepted;
  int cutbacks = 0;
  const double target = 30e3;
  RampObserver observer;
  observer.on_accept = [&](const RampProgress& progress, const Increment&) {
    accepted = progress.points.back().state;
    return true;
  };
  observer.on_cutback = [&](double, const NewtonResult&) { ++cutbacks; };
  const RampOptions options{.newton = {}, .increments = 6, .smallest_increment = 1e-3};
  RampProgress progress = RampProgress::begin(state, model->dofs, options);
  const RampResult result = run(target, options, progress, observer);
  EXPECT_EQ(result.end, RampEnd::gave_up);
  EXPECT_GT(cutbacks, 3);
  EXPECT_LE(progress.load_factor * target, pull_in);
  EXPECT_GT(progress.load_factor * target, pull_in - 2e-3 * target);
  EXPECT_GT(result.failed_at * target, pull_in);
  EXPECT_LT(result.failed_at * target, pull_in + 2e-3 * target);
  EXPECT_NE(result.failure.outcome, Outcome::converged);
  EXPECT_EQ(state.displacement, accepted.displacement);
  EXPECT_EQ(state.voltage, accepted.voltage);
  EXPECT_NEAR(state.voltage[0], progress.load_factor * target, 1e-9);
  EXPECT_NEAR(voltage_at(stretch(state)), state.voltage[0], 1e-6 * target);
  EXPECT_LT(stretch(state), std::cbrt(2.0));
}

TEST_F(FreeFilm, stopped_by_its_observer_and_resumed_it_ends_in_the_same_bits) {
  const State at_rest = state;
  const RampOptions options{.newton = {}, .increments = 6};
  ASSERT_EQ(run(22e3, options).end, RampEnd::complete);
  const State straight_through = state;

  state = at_rest;
  RampProgress progress = RampProgress::begin(state, model->dofs, options);
  RampObserver observer;
  observer.on_accept = [](const RampProgress& at, const Increment&) { return at.load_factor < 0.49; };
  ASSERT_EQ(run(22e3, options, progress, observer).end, RampEnd::stopped);
  EXPECT_NEAR(progress.load_factor, 0.5, 1e-12);
  EXPECT_NEAR(state.voltage[0], 11e3, 1e-9);

  RampProgress restored = progress;
  int accepted = 0;
  observer.on_accept = [&](const RampProgress&, const Increment&) { return ++accepted > 0; };
  EXPECT_EQ(run(22e3, options, restored, observer).end, RampEnd::complete);
  EXPECT_EQ(accepted, 3);
  EXPECT_EQ(state.voltage, std::vector{22e3});
  EXPECT_EQ(state.displacement, straight_through.displacement);
}

TEST_F(FreeFilm, ramps_from_the_loads_that_the_state_has) {
  ASSERT_EQ(run(20e3, {.newton = {}, .increments = 2}).end, RampEnd::complete);
  std::vector<double> volts;
  RampObserver observer;
  observer.on_accept = [&](const RampProgress& progress, const Increment&) {
    volts.push_back(progress.points.back().state.voltage[0]);
    return true;
  };
  ASSERT_EQ(run(10e3, {.newton = {}, .increments = 2}, observer).end, RampEnd::complete);
  EXPECT_EQ(volts, (std::vector{15e3, 10e3}));
  EXPECT_NEAR(voltage_at(stretch(state)), 10e3, 1e-3);
}

// The predictor's parameter Phi^2 takes every value twice on the way.
TEST_F(FreeFilm, reversed_polarity_ends_in_the_same_stretch) {
  const RampOptions options{.newton = {.tolerance = 1e-11, .max_iterations = 25}, .increments = 8};
  ASSERT_EQ(run(20e3, options).end, RampEnd::complete);
  const State before = state;
  ASSERT_EQ(run(-20e3, options).end, RampEnd::complete);
  EXPECT_EQ(state.voltage, std::vector{-20e3});
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    EXPECT_LT((state.displacement[a] - before.displacement[a]).norm(), 1e-9 * side);
}

// A column's straight equilibrium goes on beyond its buckling load, but less stable: the ramp approaches the
// bifurcation by halved increments before it accepts that branch.
TEST(Ramp, closes_in_on_a_bifurcation) {
  const meshing::Mesh mesh = test::line(8, 2, [](double s) { return Eigen::Vector3d(s, 0, 0); });
  const auto model = test::column(mesh, true, 1e5);
  Equilibrium equilibrium(*model, 1);
  Loads target = Loads::of(model->initial_state(), model->dofs);
  const double euler = std::numbers::pi * std::numbers::pi / 4, load = 1.7 * euler;
  target.dead_force[model->dofs.equation(mesh.node_count() - 1, 0)] = -load;
  double last_stable = 0, first_unstable = 2;
  RampObserver observer;
  observer.on_accept = [&](const RampProgress&, const Increment& increment) {
    if (increment.newton.negative_pivots == 0)
      last_stable = increment.load_factor;
    else
      first_unstable = std::min(first_unstable, increment.load_factor);
    return true;
  };
  const RampOptions options{.newton = {}, .increments = 5, .smallest_increment = 1e-3};
  RampProgress progress = RampProgress::begin(model->initial_state(), model->dofs, options);
  EXPECT_EQ(
      ramp(equilibrium, linear_path(model->dofs, progress.start, target), options, progress, observer).end,
      RampEnd::complete);
  EXPECT_NEAR(last_stable, euler / load, 2e-3);
  EXPECT_NEAR(first_unstable, euler / load, 2e-3);
  EXPECT_LT(last_stable, first_unstable);
}

} // namespace
} // namespace dielast::fem::ramp_test
