// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/inertia.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/elements/distance_block.hpp"
#include "tests/fem/diaphragm.hpp"
#include "tests/fem/timed_run.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace dielast::fem::inertia_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double mass = 0.3, omega = 2 * pi, stiffness = mass * omega * omega; ///< a period of 1 s

/// A mass at x = 1 m (node 0) on a spring, relaxed as drawn, to a support with a mass too (node 1).
struct Oscillator {
  explicit Oscillator(double damping = 0, double drag = 0) {
    const meshing::Mesh mesh{{{1, 0, 0}, {0, 0, 0}}, {}, {}, {}};
    model = test::unnumbered_model(
        2, true, make_distance_block(mesh, {{{{{1}, {1}}, {{0}, {1}}}}, 0}, Spring{stiffness, 1}),
        make_point_mass_block({{.node = 0, .axis = 0, .mass = mass, .damping = damping, .drag = drag}}),
        make_point_mass_block({{.node = 1, .axis = 0, .mass = 0.7}}));
    model->dofs.hold(1, 0);
    model->dofs.number();
    equilibrium = std::make_unique<Equilibrium>(*model, 1);
  }
  /// Let go from x at rest.
  test::TimedRun let_go(double x, const RampOptions& options) {
    State start = model->initial_state();
    start.displacement[0].x() = x;
    return test::run_in_time(*equilibrium, start, test::constant_loads(model->dofs, start), options);
  }

  std::unique_ptr<Model> model;
  std::unique_ptr<Equilibrium> equilibrium;
};

double x_of(const State& state) { return state.displacement[0].x(); }

RampOptions equal_steps(int steps, double duration, double rho = 0.8) {
  RampOptions options = test::equal_steps(steps, duration);
  options.inertia = true;
  options.high_frequencies = rho;
  return options;
}

RampOptions resolved(double duration, double tolerance) {
  return {.newton = {.tolerance = 1e-12},
          .increments = 10,
          .duration = duration,
          .time_tolerance = tolerance,
          .first_time_step = 1e-4 * duration,
          .inertia = true};
}

TEST(Inertia, free_vibration_converges_with_second_order) {
  Oscillator oscillator;
  for (const double rho : {0.0, 0.8, 1.0}) {
    const auto error = [&](int steps) {
      return x_of(oscillator.let_go(0.01, equal_steps(steps, 1.3, rho)).end()) - 0.01 * std::cos(1.3 * omega);
    };
    const double coarse = error(200), fine = error(400);
    EXPECT_LT(std::abs(fine), 2e-3 * 0.01) << rho;
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << rho;
  }
}

/// What a step does to (u, dt v, dt^2 a) of an oscillator, by the method's equations (Chung & Hulbert 1993,
/// eqs. 6-11).
Eigen::Matrix3d amplification(double rho, double step_angle) {
  const double am = (2 * rho - 1) / (rho + 1), af = rho / (rho + 1);
  const double gamma = 0.5 - am + af, beta = std::pow(1 - am + af, 2) / 4, w = step_angle * step_angle;
  const Eigen::Matrix3d after{{(1 - af) * w, 0, 1 - am}, {1, 0, -beta}, {0, 1, -gamma}};
  const Eigen::Matrix3d before{{-af * w, 0, -am}, {1, 1, 0.5 - beta}, {0, 1, 1 - gamma}};
  return after.partialPivLu().solve(before);
}

TEST(Inertia, numerical_damping_is_that_of_generalised_alpha) {
  Oscillator oscillator;
  for (const double rho : {0.0, 0.5, 0.8, 1.0}) {
    const double at_infinity = eigenvalues(amplification(rho, 1e5)).cwiseAbs().maxCoeff();
    EXPECT_NEAR(at_infinity, rho, 2e-3) << rho;
    for (const double step_angle : {0.1, 1.0, 10.0}) {
      const double dt = step_angle / omega;
      const auto states = oscillator.let_go(0.01, equal_steps(30, 30 * dt, rho)).states;
      const auto vector_of = [&](const State& s) {
        return Eigen::Vector3d(x_of(s), dt * s.motion->velocity[0], dt * dt * s.motion->acceleration[0]);
      };
      Eigen::Vector3d expected = vector_of(states[1]); // after the backward Euler step
      for (std::size_t n = 2; n < states.size(); ++n) {
        expected = amplification(rho, step_angle) * expected;
        EXPECT_LT((vector_of(states[n]) - expected).norm(), 1e-10 * 0.01) << rho << " " << n;
      }
    }
  }
}

TEST(Inertia, a_damper_lets_the_vibration_decay) {
  const double ratio = 0.1, damped = omega * std::sqrt(1 - ratio * ratio);
  Oscillator oscillator(2 * ratio * omega * mass);
  const test::TimedRun run = oscillator.let_go(0.01, resolved(3, 1e-9));
  for (const State& state : run.states) {
    const double t = state.time;
    EXPECT_NEAR(x_of(state),
                0.01 * std::exp(-ratio * omega * t) *
                    (std::cos(damped * t) + ratio * omega / damped * std::sin(damped * t)),
                2e-4 * 0.01)
        << t;
  }
  const double stored = stiffness * 1e-4 / 2;
  EXPECT_NEAR(run.balance.work().dissipated, stored * (1 - std::exp(-2 * ratio * omega * 3)), 0.01 * stored);
  EXPECT_LT(std::abs(run.balance.error()), 1e-4 * stored);
}

// Falls towards its terminal velocity, of a load that the spring does not carry: it moves with the mass.
TEST(Inertia, drag_lets_a_pulled_mass_reach_its_terminal_velocity) {
  constexpr double force = 2, drag = 8, duration = 0.6;
  const std::unique_ptr<Model> falling =
      test::free_model(1, true, make_point_mass_block({{.node = 0, .axis = 0, .mass = mass, .drag = drag}}));
  Model& model = *falling;
  Equilibrium equilibrium(model, 1);
  State start = model.initial_state();
  start.dead_force[0] = force;
  const double rate = std::sqrt(force * drag) / mass;
  const auto fallen = [=](double t) { return mass / drag * std::log(std::cosh(rate * t)); };
  const auto error = [&](int steps) {
    const test::TimedRun run = test::run_in_time(equilibrium, start, test::constant_loads(model.dofs, start),
                                                 equal_steps(steps, duration));
    EXPECT_NEAR(run.balance.work().dissipated,
                force * fallen(duration) - mass / 2 * force / drag * std::pow(std::tanh(rate * duration), 2),
                0.02 * force * fallen(duration));
    return x_of(run.end()) - fallen(duration);
  };
  const double coarse = error(100), fine = error(200);
  EXPECT_LT(std::abs(fine), 1e-4 * fallen(duration));
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.15);
}

TEST(Inertia, forces_of_drag_are_derivatives_of_their_energy_and_the_tangent_of_them) {
  Oscillator oscillator(0.4, 7);
  for (const double velocity : {0.3, -0.05, 0.0}) {
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(2);
    Motion start{rest, rest, rest, rest, rest};
    start.velocity[0] = velocity;
    start.acceleration[0] = -2;
    State state = oscillator.model->initial_state();
    state.motion = std::make_shared<const Motion>(start);
    state.motion_scheme = GeneralisedAlpha::of(0.02, 0.8);
    const auto at = [&](double x) {
      state.displacement[0].x() = x;
      Balance balance;
      oscillator.equilibrium->balance(state, balance);
      return std::pair{balance.energy, balance.force[0]};
    };
    constexpr double h = 1e-4;
    const double x = 0.004;
    const double slope =
        (8 * (at(x + h).first - at(x - h).first) - (at(x + 2 * h).first - at(x - 2 * h).first)) / (12 * h);
    EXPECT_NEAR(at(x).second, slope, 1e-9 * (1 + std::abs(slope))) << velocity;
    const double change = (at(x + h).second - at(x - h).second) / (2 * h);
    at(x);
    ASSERT_TRUE(oscillator.equilibrium->factor(state));
    Eigen::VectorXd step;
    oscillator.equilibrium->tangent().solve(Eigen::VectorXd::Ones(1), step);
    EXPECT_NEAR(1 / step[0], change, 1e-8 * change) << velocity;
  }
}

TEST(Inertia, what_drag_takes_is_what_the_oscillator_loses) {
  Oscillator oscillator(0, 20);
  const test::TimedRun run = oscillator.let_go(0.1, resolved(2, 1e-9));
  const double lost = stiffness * 0.01 / 2 - run.balance.stored();
  EXPECT_GT(lost, 0.5 * stiffness * 0.01 / 2);
  EXPECT_NEAR(run.balance.work().dissipated, lost, 1e-5 * lost);
  EXPECT_LT(run.balance.error(), 1e-4 * lost);
}

TEST(Inertia, a_load_that_jumps_overshoots_twofold_and_its_work_is_told) {
  Oscillator oscillator;
  const State rest = oscillator.model->initial_state();
  const double force = 0.02 * stiffness;
  LoadPath path = test::constant_loads(oscillator.model->dofs, rest);
  path.apply = [force](State& state, double) { state.dead_force[0] = force; };
  const test::TimedRun run = test::run_in_time(*oscillator.equilibrium, rest, path, resolved(1.5, 1e-9));
  double highest = 0;
  for (const State& state : run.states) {
    EXPECT_NEAR(x_of(state), 0.02 * (1 - std::cos(omega * state.time)), 2e-4 * 0.02) << state.time;
    highest = std::max(highest, x_of(state));
  }
  EXPECT_NEAR(highest, 0.04, 1e-3 * 0.04);
  EXPECT_NEAR(run.balance.work().mechanical, force * x_of(run.end()), 1e-12 * force);
  EXPECT_LT(std::abs(run.balance.error()), 1e-4 * force * 0.04);
}

TEST(Inertia, a_moving_support_drags_the_mass_along) {
  Oscillator oscillator;
  const State rest = oscillator.model->initial_state();
  const double shaken = 0.6 * omega, duration = 2;
  LoadPath path = test::constant_loads(oscillator.model->dofs, rest);
  path.apply = [=](State& state, double s) {
    state.displacement[1].x() = 0.01 * (1 - std::cos(shaken * duration * s));
  };
  const test::TimedRun run = test::run_in_time(*oscillator.equilibrium, rest, path, resolved(duration, 1e-9));
  const double gain = 1 / (1 - 0.36);
  for (const State& state : run.states)
    EXPECT_NEAR(x_of(state),
                0.01 * (1 - gain * std::cos(shaken * state.time) + (gain - 1) * std::cos(omega * state.time)),
                5e-4 * 0.01)
        << state.time;
  EXPECT_GT(run.balance.stored(), 0.1 * stiffness * 1e-4 / 2);
  EXPECT_LT(std::abs(run.balance.error()), 1e-3 * run.balance.stored());
}

// A diaphragm with everything that has a memory: branches, circuit, inertia.
TEST(Inertia, a_run_goes_on_from_a_copied_state_bit_for_bit) {
  test::DiaphragmData data;
  data.elements = 8;
  data.damping = 1;
  data.branches = {{materials::NeoHookean{20e3}, materials::Dashpot::log, 20e3 * 0.05}};
  data.circuit = {.resistance = 1e6, .leakage = 1e-8, .charge_scale = 1e-5};
  const test::Diaphragm diaphragm(data);
  Equilibrium equilibrium(diaphragm.model, 1);
  const State settled = diaphragm.settled(equilibrium, 1e3);
  LoadPath path = test::constant_loads(diaphragm.model.dofs, settled);
  path.apply = [](State& state, double s) { state.source = {s < 0.7 ? 4e3 : 2e3}; };
  path.breaks = {0.7};
  const RampOptions options = resolved(0.3, 1e-5);
  RampProgress progress = RampProgress::begin(settled, diaphragm.model.dofs, options), copied = progress;
  std::vector<double> times, again;
  RampObserver observer;
  observer.on_accept = [&](const RampProgress& at, const Increment&) {
    if (at.load_factor < 0.4) copied = at;
    times.push_back(at.points.back().state.time);
    return true;
  };
  ASSERT_EQ(ramp(equilibrium, path, options, progress, observer).end, RampEnd::complete);
  EXPECT_GT(copied.load_factor, 0.3);
  Equilibrium other(diaphragm.model, 1);
  observer.on_accept = [&](const RampProgress& at, const Increment&) {
    again.push_back(at.points.back().state.time);
    return true;
  };
  ASSERT_EQ(ramp(other, path, options, copied, observer).end, RampEnd::complete);
  ASSERT_GT(again.size(), 10U);
  ASSERT_GT(times.size(), again.size() + 5);
  EXPECT_TRUE(std::equal(again.rbegin(), again.rend(), times.rbegin()));
  const State &straight = progress.points.back().state, &resumed = copied.points.back().state;
  EXPECT_EQ(straight.displacement, resumed.displacement);
  EXPECT_EQ(straight.voltage, resumed.voltage);
  EXPECT_EQ(straight.motion->velocity, resumed.motion->velocity);
  EXPECT_EQ(straight.motion->acceleration, resumed.motion->acceleration);
  EXPECT_EQ(straight.history->now, resumed.history->now);
}

// A state that an observer stores behind a jump leads on from a corner of the path, as for the ramp itself.
TEST(Inertia, what_is_stored_behind_a_jump_knows_of_the_corner) {
  test::DiaphragmData data;
  data.elements = 4;
  const test::Diaphragm diaphragm(data);
  Equilibrium equilibrium(diaphragm.model, 1);
  const State settled = diaphragm.settled(equilibrium, 1e3);
  LoadPath path = test::constant_loads(diaphragm.model.dofs, settled);
  path.apply = [](State& state, double) { state.voltage = {2e3}; };
  const RampOptions options = resolved(1e-3, 1e-2);
  RampProgress progress = RampProgress::begin(settled, diaphragm.model.dofs, options), stored = progress;
  std::vector<char> turns; // of the increment behind the jump
  bool is_behind = false;
  RampObserver observer;
  observer.on_accept = [&](const RampProgress& at, const Increment& increment) {
    if (is_behind) turns.push_back(increment.turns);
    if (increment.jumped) stored = at;
    return !std::exchange(is_behind, is_behind || increment.jumped);
  };
  ASSERT_EQ(ramp(equilibrium, path, options, progress, observer).end, RampEnd::stopped);
  ASSERT_EQ(ramp(equilibrium, path, options, stored, observer).end, RampEnd::stopped);
  EXPECT_EQ(turns, (std::vector<char>{1, 1}));
}

} // namespace
} // namespace dielast::fem::inertia_test
