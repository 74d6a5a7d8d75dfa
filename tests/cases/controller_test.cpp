// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace dielast::cases::controller_test {
namespace {

constexpr double mu = 40e3, permittivity = 4 * 8.8541878128e-12, thickness = 1e-3, size = 10e-3, across = 2;
constexpr double stress = 60e3, mass = 0.01, damping = 0.2;

/// Nominal stress along x of a film whose width is held, Pa.
double film_stress(double stretch, double voltage) {
  const double field = voltage * stretch * across / thickness;
  return (mu * (stretch * stretch - 1 / std::pow(stretch * across, 2)) - permittivity * field * field) /
         stretch;
}

struct Loop {
  double target = 1.7, gain = 2e4, integral_gain = 2e5, every = 0.01, highest = 6e3, drive = 500;

  std::string text() const {
    return fmt::format(
        "[[controller]]\nelectrode = \"film\"\nquantity = \"stretch_x\"\ntarget = {}\ngain = {}\n"
        "integral_gain = {}\nevery = \"{} s\"\nhighest = \"{} V\"\n",
        target, gain, integral_gain, every, highest);
  }
};

/// Where the film is at rest under the stress.
double rest(double voltage) {
  double low = 0.5, high = 4;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (film_stress(middle, voltage) < stress ? low : high) = middle;
  }
  return low;
}

/// A block of film with a mass at its side: one degree of freedom, pulled by a stress. The width is held.
class ControllerTest : public test::ScratchTest {
 protected:
  Case read(const Loop& loop, const std::string& steps) const {
    write("loop.toml",
          fmt::format(
              "[film]\nthickness = \"1 mm\"\nprestretch = {}\n[film.material]\nshear_modulus = \"40 kPa\"\n"
              "relative_permittivity = 4\ndensity = 0\n[patch]\nlength = \"10 mm\"\nmode = \"pure-shear\"\n"
              "stress_x = \"60 kPa\"\n[[point_mass]]\nmass = \"10 g\"\ndamping = \"0.2 N.s/m\"\n"
              "place = \"right\"\n[drive]\nvoltage = \"{} V\"\n[solver]\ntime_tolerance = 1e-9\n",
              across, loop.drive) +
              loop.text() + steps);
    return read_case(directory / "loop.toml");
  }
  struct Row {
    double time, voltage, stretch;
  };
  /// Rows of the transient.
  static std::vector<Row> run(Simulation& simulation, const Case& one, int stop_after = -1) {
    std::vector<Row> rows;
    SimulationObserver observer;
    const auto at = static_cast<std::size_t>(std::ranges::find(one.quantities, "stretch_x", &Quantity::name) -
                                             one.quantities.begin());
    observer.on_accept = [&](const Frame& frame) {
      if (frame.record.step.starts_with("transient") && !frame.record.jumped)
        rows.push_back({frame.record.time, frame.record.voltages[0], frame.values[at]});
      return static_cast<int>(rows.size()) != stop_after;
    };
    const Outcome outcome = simulation.run(observer);
    EXPECT_EQ(outcome.ending, stop_after < 0 ? Ending::complete : Ending::interrupted) << outcome.message;
    return rows;
  }
};

const std::string force = "[[step]]\nkind = \"force\"\n";
const std::string half_second = "[[step]]\nkind = \"transient\"\nduration = \"0.5 s\"\nrecord = \"0.005 s\"\n"
                                "increments = 4000\n"; // a step behind a break has no estimate of its error

/// The same loop by Runge and Kutta's method of fourth order.
std::vector<double> stretches_of(const Loop& loop, double start, double duration, double between) {
  const double section = size * thickness; // W0 H
  double stretch = start, speed = 0, voltage = 0, integral = 0;
  const int parts = 400; // of the time between two values
  const int per_sample = static_cast<int>(std::lround(loop.every / between));
  std::vector<double> values;
  const auto rate = [&](const std::array<double, 2>& y) {
    const double pull = section * (stress - film_stress(y[0], voltage)) - damping * y[1] * size;
    return std::array{y[1], pull / (mass * size)};
  };
  for (int k = 0; k * between < duration - 1e-9; ++k) {
    if (k % per_sample == 0) {
      const double lack = loop.target - stretch;
      const double wanted = loop.drive + loop.gain * lack + loop.integral_gain * integral;
      voltage = std::clamp(wanted, 0.0, loop.highest);
      if (!(wanted > loop.highest && lack > 0) && !(wanted < 0 && lack < 0)) integral += lack * loop.every;
    }
    for (int i = 0; i < parts; ++i) {
      const double h = between / parts;
      const std::array y{stretch, speed};
      const auto moved = [&](const std::array<double, 2>& slope, double by) {
        return std::array{y[0] + by * slope[0], y[1] + by * slope[1]};
      };
      const auto a = rate(y), b = rate(moved(a, h / 2)), c = rate(moved(b, h / 2)), d = rate(moved(c, h));
      stretch += h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]);
      speed += h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1]);
    }
    values.push_back(stretch);
  }
  return values;
}

// 3 kV for each mm, 40 kV for each mm and second.
TEST_F(ControllerTest, GainsAreAsLargeAsKilovoltsForMillimetresMakeThem) {
  const Case one = read({.gain = 3e6, .integral_gain = 4e7}, force + half_second);
  EXPECT_EQ(one.controllers.at(0).gain, 3e6);
  EXPECT_EQ(one.controllers.at(0).integral_gain, 4e7);
}

TEST_F(ControllerTest, AgreesWithAnIntegrationOfTheClosedLoop) {
  for (const Loop& loop : {Loop{}, Loop{.gain = 4e4, .integral_gain = 0}, Loop{.highest = 4e3}}) {
    const Case one = read(loop, force + half_second);
    ASSERT_TRUE(one.warnings.empty()) << one.warnings[0].text();
    Simulation simulation(one, 1);
    const std::vector<Row> rows = run(simulation, one);
    ASSERT_EQ(rows.size(), 100U);
    double start = across; // where the stress alone leads
    for (int i = 0; i < 100; ++i)
      start -= (film_stress(start, 0) - stress) / (mu * (1 + 0.75 / std::pow(start, 4)));
    const std::vector<double> expected = stretches_of(loop, start, 0.5, 0.005);
    double moved = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      EXPECT_NEAR(rows[k].time, 0.005 * static_cast<double>(k + 1), 1e-9);
      EXPECT_NEAR(rows[k].stretch, expected[k], 2e-5) << k;
      moved = std::max(moved, std::abs(expected[k] - start));
    }
    EXPECT_GT(moved, 0.05);
  }
}

// Without mass and dashpots each voltage has its stretch at once: the loop is a map.
TEST_F(ControllerTest, IsAMapWhereNothingTakesTime) {
  const Loop loop{.gain = 1e4, .integral_gain = 0, .every = 0.1};
  const Case one = read(loop, force + half_second + "inertia = false\n");
  Simulation simulation(one, 1);
  const std::vector<Row> rows = run(simulation, one);
  double stretch = rest(0);
  std::size_t compared = 0;
  for (int k = 0; k < 5; ++k) {
    const double voltage = std::clamp(loop.drive + loop.gain * (loop.target - stretch), 0.0, loop.highest);
    stretch = rest(voltage);
    for (const Row& row : rows)
      if (row.time > 0.1 * k + 1e-6 && row.time < 0.1 * (k + 1) + 1e-6) { // a row shows what holds before
        EXPECT_NEAR(row.voltage, voltage, 1e-6 * voltage) << row.time;
        EXPECT_NEAR(row.stretch, stretch, 1e-8) << row.time;
        ++compared;
      }
  }
  EXPECT_EQ(compared, rows.size());
  EXPECT_EQ(compared, 100U);
}

// What is measured is given: the integral goes on until a sample is cut at the limit, and stays there (the
// last sample before the limit was left out of it, so that the source fell back to 860 V from 1015 V).
TEST_F(ControllerTest, AtALimitTheIntegralStays) {
  write("loop.toml", "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"50 kPa\"\n"
                     "relative_permittivity = 4\n[patch]\nlength = \"20 mm\"\nstretch_x = { wave = \"ramp\", "
                     "from = 1, to = 1.04, duration = \"2 s\" }\n[[controller]]\nelectrode = \"film\"\n"
                     "quantity = \"stretch_x\"\ntarget = 1.05\ngain = 2000\nintegral_gain = 40000\nevery = "
                     "\"0.5 s\"\nhighest = \"1015 V\"\n[[step]]\nkind = \"transient\"\nduration = \"6 s\"\n"
                     "increments = 120\n");
  const Case one = read_case(directory / "loop.toml");
  Simulation simulation(one, 1);
  const std::vector<Row> rows = run(simulation, one);
  double integral = 0;
  std::size_t compared = 0;
  for (int k = 0; k < 12; ++k) {
    const double lack = 1.05 - std::min(1 + 0.02 * 0.5 * k, 1.04);
    const double wanted = 2000 * lack + 40000 * integral;
    if (wanted <= 1015) integral += 0.5 * lack;
    for (const Row& row : rows)
      if (row.time > 0.5 * k + 1e-6 && row.time < 0.5 * (k + 1) + 1e-6) {
        EXPECT_NEAR(row.voltage, std::min(wanted, 1015.0), 1e-9) << row.time;
        ++compared;
      }
  }
  EXPECT_GE(compared, 120U);
}

// A step may end between two measurements; the next one measures as it begins.
TEST_F(ControllerTest, IntegratesAcrossStepsOfAnyLength) {
  const Loop loop{.gain = 1e4, .integral_gain = 1e4, .every = 0.1};
  const std::string quarter = "[[step]]\nkind = \"transient\"\nduration = \"0.25 s\"\ninertia = false\n";
  const Case one =
      read(loop, force + quarter + "name = \"transient_a\"\n" + quarter + "name = \"transient_b\"\n");
  Simulation simulation(one, 1);
  const std::vector<Row> rows = run(simulation, one);
  double stretch = rest(0), integral = 0, last = 0, lack = 0;
  const std::array times{0.0, 0.1, 0.2, 0.25, 0.35, 0.45, 0.5};
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    integral += lack * (times[k] - last);
    last = times[k], lack = loop.target - stretch;
    const double voltage = loop.drive + loop.gain * lack + loop.integral_gain * integral;
    stretch = rest(voltage);
    int compared = 0;
    for (const Row& row : rows)
      if (row.time > times[k] + 1e-6 && row.time < times[k + 1] + 1e-6) {
        EXPECT_NEAR(row.voltage, voltage, 1e-6 * voltage) << row.time;
        ++compared;
      }
    EXPECT_GT(compared, 0) << times[k];
  }
}

TEST_F(ControllerTest, GoesOnBitForBit) {
  const Case one = read({}, force + half_second);
  Simulation whole(one, 1);
  const std::vector<Row> all = run(whole, one);
  for (const int stop : {1, 14, 15, 16, 77}) {
    Simulation first(one, 1), second(one, 1);
    run(first, one, stop);
    second.enter(first.progress().step);
    second.resume(first.progress());
    const std::vector<Row> rest = run(second, one);
    ASSERT_EQ(rest.size() + static_cast<std::size_t>(stop), all.size());
    for (std::size_t k = 0; k < rest.size(); ++k) {
      EXPECT_EQ(rest[k].stretch, all[k + static_cast<std::size_t>(stop)].stretch) << stop << " " << k;
      EXPECT_EQ(rest[k].voltage, all[k + static_cast<std::size_t>(stop)].voltage) << stop << " " << k;
    }
  }
}

TEST_F(ControllerTest, WhatHasNoValueIsNotControlled) {
  Loop loop;
  const std::string never = "[[quantity]]\nname = \"late\"\nkind = \"elongation\"\nbetween = [\"left\", "
                            "\"right\"]\nsince = \"after\"\n";
  std::string steps =
      never + force + half_second + "[[step]]\nname = \"after\"\nkind = \"hold\"\nduration = \"1 s\"\n";
  const Case read_one = read(loop, steps);
  Case one = read_one;
  one.controllers[0].quantity = "late";
  Simulation simulation(one, 1);
  const Outcome outcome = simulation.run({});
  EXPECT_EQ(outcome.ending, Ending::gave_up);
  EXPECT_NE(outcome.message.find("quantity \"late\""), std::string::npos) << outcome.message;
}

TEST_F(ControllerTest, WithoutATransientItIsIdle) {
  const Case one = read({}, force);
  EXPECT_TRUE(std::ranges::any_of(one.warnings, [](const Diagnostic& warning) {
    return warning.text().find("controller[1]") != std::string::npos;
  }));
}

} // namespace
} // namespace dielast::cases::controller_test
