// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/circuit.hpp"

#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"
#include "tests/fem/timed_run.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::fem::circuit_test {
namespace {

constexpr double side = 0.01, resistance = 1e9, source = 5e3; ///< m, Ohm, V
constexpr double capacitance = 4e-12;                         ///< F, of the undeformed film
constexpr double constant = resistance * capacitance;         ///< s

/// A square film behind a circuit, held along its edge, where nothing moves, or free.
struct ChargedFilm {
  explicit ChargedFilm(Circuit circuit, bool free = false) {
    circuit.resistance = resistance;
    circuit.charge_scale = capacitance * source;
    model = free ? test::square_film(mesh, side, test::Held::at_corners, {}, test::viscoelastic_vhb())
                 : test::square_film(mesh, side, test::Held::along_edge);
    model->ports[0].circuit = circuit;
    model->place_histories();
    equilibrium = std::make_unique<Equilibrium>(*model, 1);
  }
  /// From rest, the source at `volts` from the beginning.
  test::TimedRun charge(double volts, const RampOptions& options) {
    State start = model->initial_state();
    start.supply = {Supply::circuit};
    LoadPath path = test::constant_loads(model->dofs, start);
    path.apply = [volts](State& state, double) { state.source = {volts}; };
    return test::run_in_time(*equilibrium, start, path, options);
  }
  double held(const State& state) const { return model->charges(state, false).charge[0]; }
  double current(const State& state) const {
    return model->ports[0].circuit->current(state.source[0], state.voltage[0]);
  }

  meshing::Mesh mesh = test::distorted_square(2, 1, side);
  std::unique_ptr<Model> model;
  std::unique_ptr<Equilibrium> equilibrium;
};

RampOptions resolved(double duration, double tolerance = 1e-9) {
  return {.newton = {.tolerance = 1e-12},
          .increments = 10,
          .duration = duration,
          .time_tolerance = tolerance,
          .first_time_step = 1e-4 * duration};
}

TEST(Circuit, a_held_film_is_charged_exponentially_with_second_order) {
  ChargedFilm film({});
  const auto error = [&](int steps) {
    const State end = film.charge(source, test::equal_steps(steps, constant)).end();
    return end.voltage[0] / source - (1 - std::exp(-1.0));
  };
  const double coarse = error(40), fine = error(80);
  EXPECT_LT(std::abs(fine), 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TEST(Circuit, leakage_divides_the_voltage_and_shortens_the_time_constant) {
  ChargedFilm film({.leakage = 0.25 / resistance});
  EXPECT_DOUBLE_EQ(film.model->ports[0].circuit->steady_share(), 0.8);
  const State early = film.charge(source, resolved(0.8 * constant)).end();
  EXPECT_NEAR(early.voltage[0], 0.8 * source * (1 - std::exp(-1.0)), 1e-5 * source);
  const State late = film.charge(source, resolved(40 * constant)).end();
  EXPECT_NEAR(late.voltage[0], 0.8 * source, 1e-9 * source);
  EXPECT_NEAR(film.held(late), 0.8 * source * capacitance, 1e-9 * source * capacitance);
}

TEST(Circuit, a_limited_source_charges_linearly_then_exponentially) {
  constexpr double limit = 2e-6;                      // A: until 3 kV, for 1.5 RC
  constexpr double until = capacitance * 3e3 / limit; // s
  ChargedFilm film({.current_limit = limit});
  for (const double sign : {1.0, -1.0}) {
    const test::TimedRun run = film.charge(sign * source, resolved(3 * until));
    int limited = 0;
    for (const State& state : run.states) {
      const bool linear = state.time <= until;
      limited += linear;
      const double exact = linear ? limit * state.time / capacitance
                                  : source - 2e3 * std::exp(-(state.time - until) / constant);
      EXPECT_NEAR(sign * state.voltage[0], exact, (linear ? 1e-11 : 1e-5) * source) << state.time;
    }
    EXPECT_GT(limited, 5);
  }
}

// Isolated, a held film loses its charge with C/G, whatever its source; what it stored is heat in the leak.
TEST(Circuit, an_isolated_film_loses_its_charge_through_the_leak) {
  constexpr double leakage = 0.25 / resistance, lasts = capacitance / leakage;
  ChargedFilm film({.leakage = leakage});
  State start = film.model->initial_state();
  start.voltage = {source};
  start.supply = {Supply::leak};
  film.model->charge_circuits(start);
  const double stored = capacitance * source * source / 2;
  const auto error = [&](int steps) {
    const test::TimedRun run =
        test::run_in_time(*film.equilibrium, start, test::constant_loads(film.model->dofs, start),
                          test::equal_steps(steps, lasts));
    const Work& work = run.balance.work();
    EXPECT_NEAR(work.electrical, -stored * (1 - std::exp(-2.0)), 1e-3 * stored);
    EXPECT_NEAR(work.source(), 0, 1.5 * stored / (steps * steps)); // of the second order
    EXPECT_EQ(work.resistance, 0);
    EXPECT_LT(run.balance.error(), 1e-3 * stored);
    return film.held(run.end()) / (capacitance * source) - std::exp(-1.0);
  };
  const double coarse = error(40), fine = error(80);
  EXPECT_LT(std::abs(fine), 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

/// Slope at the last of the parabola through three values, of the line where the first is missing.
double slope_at_the_last(const std::array<double, 3>& t, const std::array<double, 3>& y, bool line) {
  const double last = (y[2] - y[1]) / (t[2] - t[1]);
  if (line) return last;
  const double before = (y[1] - y[0]) / (t[1] - t[0]);
  return last + (t[2] - t[1]) * (last - before) / (t[2] - t[0]);
}

// Also where the film creeps and the source is at its limit at first: no charge is lost.
TEST(Circuit, what_flows_in_less_what_leaks_is_what_the_film_gains) {
  ChargedFilm film({.leakage = 0.1 / resistance, .current_limit = 4e-6}, true);
  const test::TimedRun run = film.charge(source, resolved(3 * constant, 1e-6));
  const auto& states = run.states;
  ASSERT_GT(states.size(), 20U);
  for (std::size_t n = 1; n < states.size(); ++n) {
    std::array<double, 3> time{}, charge{};
    for (std::size_t i = n == 1 ? 1 : 0; i < 3; ++i) {
      time[i] = states[n - 2 + i].time;
      charge[i] = film.held(states[n - 2 + i]);
    }
    const double leaks = 0.1 / resistance * states[n].voltage[0];
    EXPECT_NEAR(slope_at_the_last(time, charge, n == 1), film.current(states[n]) - leaks,
                1e-10 * source / resistance)
        << n;
  }
  EXPECT_EQ(film.current(states[1]), 4e-6);
  EXPECT_LT(film.current(run.end()), 1e-6);
}

// int U i dt = work on the film + heat in the resistance and the leak; the film's own balance closes too.
TEST(Circuit, the_source_pays_for_the_film_the_resistance_and_the_leak) {
  constexpr double leakage = 0.1 / resistance;
  ChargedFilm film({.leakage = leakage}, true);
  const auto unaccounted = [&](int steps) {
    const test::TimedRun run = film.charge(source, test::equal_steps(steps, 2 * constant));
    double delivered = 0, heat = 0;
    const auto add = [&](const State& state, double dt) {
      const double i = film.current(state), phi = state.voltage[0];
      delivered += dt * source * i;
      heat += dt * (resistance * i * i + leakage * phi * phi);
    };
    for (std::size_t n = 1; n < run.states.size(); ++n) {
      const double dt = run.states[n].time - run.states[n - 1].time;
      add(run.states[n - 1], dt / 2);
      add(run.states[n], dt / 2);
    }
    EXPECT_GT(heat, 0.3 * delivered);
    EXPECT_GT(run.balance.work().dissipated, 0);
    EXPECT_LT(std::abs(run.balance.error()), 1e-4 * delivered);
    return (delivered - heat - run.balance.work().electrical) / delivered;
  };
  const double coarse = unaccounted(100), fine = unaccounted(200);
  EXPECT_LT(std::abs(fine), 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.3);
}

} // namespace
} // namespace dielast::fem::circuit_test
