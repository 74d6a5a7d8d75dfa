// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/energy_balance.hpp"
#include "fem/paths/ramp.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"
#include "tests/fem/timed_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace dielast::fem::time_steps_test {
namespace {

/// A free square film of a Gent spring beside a Gent branch (Zhao, Koh & Suo 2011), mu_a = mu_b = 22.5 kPa,
/// J = 100, eta/mu_b = 1 s, which a voltage of Phi/H = 0.4 sqrt(mu/eps) spreads in both directions alike.
class CreepingFilm : public testing::Test {
 protected:
  static constexpr double side = 0.01;
  const double volts = 0.4 * 1e-3 * std::sqrt(45e3 / 4e-11);
  const meshing::Mesh mesh = test::distorted_square(1, 1, side);
  std::unique_ptr<Model> model = [this] {
    MembraneSection section = test::vhb();
    section.material.law = materials::Gent{22.5e3, 100};
    section.material.branches = {{materials::Gent{22.5e3, 100}, materials::Dashpot::log, 22.5e3}};
    return test::square_film(mesh, side, test::Held::at_corners, {}, section);
  }();
  Equilibrium equilibrium{*model, 1};
  EnergyBalance balance;
  int accepted = 0;

  /// The voltage jumps at t = 0 and stays for `duration` (s), or goes off after the part `off` of it.
  LoadPath step_voltage(double off = 2) const {
    LoadPath path;
    path.apply = [this, off](State& state, double s) { state.voltage = {s < off ? volts : 0.0}; };
    if (off < 1) path.breaks = {off};
    return path;
  }
  State run(const LoadPath& path, const RampOptions& options, std::map<double, double>* stretches = nullptr) {
    RampProgress progress = RampProgress::begin(model->initial_state(), model->dofs, options);
    balance = EnergyBalance();
    balance.add(energy_point(equilibrium, model->initial_state(), 0));
    RampObserver observer;
    State last = model->initial_state();
    observer.on_accept = [&](const RampProgress& at, const Increment& increment) {
      const State& state = at.points.back().state;
      test::account(balance, equilibrium, last, state, increment);
      last = state;
      if (stretches) (*stretches)[state.time] = stretch(state);
      ++accepted;
      return true;
    };
    EXPECT_EQ(ramp(equilibrium, path, options, progress, observer).end, RampEnd::complete);
    return progress.points.back().state;
  }
  double stretch(const State& state) const { return 1 + state.displacement[1].x() / side; }
};

TEST_F(CreepingFilm, follows_the_reference_creep) {
  // stretch at t/tau from an independent integration of the two-spring model
  const std::map<double, double> reference{{0.0, 1.031594},  {0.1, 1.0333496}, {0.25, 1.0358704},
                                           {0.5, 1.0397876}, {1.0, 1.0466555}, {2.0, 1.057203},
                                           {5.0, 1.0731949}, {10.0, 1.0798798}};
  std::map<double, double> found;
  const RampOptions options{
      .increments = 100, .landing = 0.005, .duration = 10, .time_tolerance = 1e-6, .first_time_step = 1e-3};
  run(step_voltage(), options, &found);
  for (const auto& [time, stretch] : reference) {
    const auto at = found.lower_bound(time - 1e-6);
    ASSERT_NE(at, found.end());
    EXPECT_NEAR(at->first, time, 1e-6);
    EXPECT_NEAR(at->second, stretch, 5e-6);
  }
  EXPECT_LT(std::abs(balance.error()), 1e-5 * balance.work().electrical);
  EXPECT_GT(balance.work().dissipated, 0.04 * balance.work().electrical);
}

TEST_F(CreepingFilm, fixed_steps_converge_with_second_order) {
  constexpr double exact = 1.0466555;
  std::vector<double> values;
  for (const int steps : {10, 20, 40, 80, 160, 1280}) {
    const RampOptions options{.increments = steps, .duration = 1, .time_tolerance = 1};
    values.push_back(stretch(run(step_voltage(), options)));
  }
  EXPECT_NEAR(values.back(), exact, 2e-7);
  const double order = std::log2((values[1] - values.back()) / (values[2] - values.back()));
  EXPECT_GT(order, 1.8);
  EXPECT_LT(order, 2.5);
}

TEST_F(CreepingFilm, the_tolerance_sets_the_steps) {
  std::vector<double> errors;
  std::vector<int> steps;
  for (const double tolerance : {1e-4, 1e-6}) {
    accepted = 0;
    const RampOptions options{.increments = 1,
                              .duration = 10,
                              .time_tolerance = tolerance,
                              .first_time_step = std::sqrt(2 * tolerance)};
    errors.push_back(std::abs(stretch(run(step_voltage(), options)) - 1.0798798));
    steps.push_back(accepted);
  }
  EXPECT_LT(errors[1], errors[0]);
  EXPECT_LT(errors[0], 1e-4);
  EXPECT_LT(steps[0], 80);
  EXPECT_GT(steps[1], 2 * steps[0]);
}

// Loads that bend within an increment bend the path, too: no reason to halve it.
TEST_F(CreepingFilm, a_wave_is_followed_in_steps_of_an_eighth_of_its_period) {
  LoadPath wave;
  wave.apply = [this](State& state, double s) { state.voltage = {volts * std::sin(10 * M_PI * s)}; };
  run(wave, {.increments = 80, .duration = 10, .time_tolerance = 1e9});
  EXPECT_EQ(accepted, 80);
}

TEST_F(CreepingFilm, a_voltage_that_goes_off_acts_at_once_and_the_rest_recovers) {
  std::map<double, double> found;
  const RampOptions options{
      .increments = 40, .duration = 20, .time_tolerance = 1e-6, .first_time_step = 1e-3};
  const State end = run(step_voltage(0.25), options, &found);
  // the last value at t = 5 is the one behind the jump: the spring of the branch is compressed
  const double behind = found.lower_bound(5 - 1e-6)->second;
  EXPECT_LT(behind, 1.05);
  EXPECT_GT(behind, 1.02);
  EXPECT_LT(stretch(end), behind);
  EXPECT_LT(std::abs(balance.error()), 1e-3 * balance.work().dissipated);
}

TEST_F(CreepingFilm, without_time_it_answers_at_once_or_relaxed) {
  for (const bool instantaneous : {true, false}) {
    const RampOptions options{.increments = 5, .instantaneous = instantaneous};
    RampProgress progress = RampProgress::begin(model->initial_state(), model->dofs, options);
    Loads target = progress.start;
    target.voltage = {volts};
    EXPECT_EQ(ramp(equilibrium, linear_path(model->dofs, progress.start, target), options, progress, {}).end,
              RampEnd::complete);
    EXPECT_NEAR(stretch(progress.points.back().state), instantaneous ? 1.031594 : 1.0811289, 1e-6);
  }
}

} // namespace
} // namespace dielast::fem::time_steps_test
