// SPDX-License-Identifier: GPL-3.0-or-later
// Controllers of forces, displacements, pressures and volumes, as maps from measurement to measurement:
// nothing takes time, so that every load has its equilibrium at once, in closed form.
#include "cases/runs/simulation.hpp"
#include "tests/cases/case_test.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace dielast::cases::controlled_loads_test {
namespace {

constexpr double modulus = 50e3;

class ControlledLoads : public test::CaseTest {
 protected:
  struct Row {
    double time, driven, measured;
  };
  /// Values of two quantities in the rows of the transient.
  std::vector<Row> rows(const std::string& text) const {
    const Case one = read(text);
    EXPECT_TRUE(one.warnings.empty()) << (one.warnings.empty() ? "" : one.warnings[0].text());
    const auto number = [&](const char* name) {
      return static_cast<std::size_t>(std::ranges::find(one.quantities, name, &Quantity::name) -
                                      one.quantities.begin());
    };
    const std::size_t driven = number("driven"), measured = number("measured");
    std::vector<Row> rows;
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      if (frame.record.step == "transient" && !frame.record.jumped)
        rows.push_back({frame.record.time, frame.values[driven], frame.values[measured]});
      return true;
    };
    Simulation simulation(one, 1);
    const Outcome outcome = simulation.run(observer);
    EXPECT_EQ(outcome.ending, Ending::complete) << outcome.message;
    return rows;
  }
  /// Every row between two measurements has what the controller made of the row before them.
  static void expect_loop(const std::vector<Row>& rows, double start, double said, double target, double gain,
                          const std::function<double(double)>& rest, double tolerance) {
    double measured = start;
    std::size_t compared = 0;
    for (int k = 0; k < 4; ++k) {
      const double driven = said + gain * (target - measured);
      measured = rest(driven);
      for (const Row& row : rows)
        if (row.time > 0.1 * k + 1e-6 && row.time < 0.1 * (k + 1) + 1e-6) {
          EXPECT_NEAR(row.driven, driven, tolerance * std::abs(driven)) << row.time;
          EXPECT_NEAR(row.measured, measured, tolerance * std::abs(measured)) << row.time;
          ++compared;
        }
    }
    EXPECT_EQ(compared, rows.size());
    EXPECT_GT(compared, 3U);
  }
};

constexpr const char* loop = "every = \"0.1 s\"\n[[step]]\nkind = \"transient\"\nduration = \"0.4 s\"\n"
                             "record = \"0.05 s\"\ninertia = false\n";

/// A rod of film, 40 mm long at rest, of 0.1 x 100 mm.
std::string rod(const std::string& rest) {
  return R"toml(
model = "planar"
[film]
thickness = "0.1 mm"
[film.material]
shear_modulus = "50 kPa"
relative_permittivity = 3
[line]
to = ["40 mm", 0, 0]
[rod]
width = "100 mm"
[[support]]
place = "start"
fix = ["x", "y"]
)toml" + rest;
}

double rod_force(double stretch) { return 1e-5 * modulus * (stretch - 1 / (stretch * stretch)); }

double stretch_at(double force) {
  double low = 0.5, high = 20;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (rod_force(middle) < force ? low : high) = middle;
  }
  return low;
}

TEST_F(ControlledLoads, AForceFollowsALength) {
  const auto found = rows(rod(R"toml(
[[support]]
place = "end"
fix = ["y"]
[[load]]
place = "end"
force = ["0.1 N", 0, 0]
[[quantity]]
name = "driven"
kind = "film force"
of = "start"
along = "x"
[[quantity]]
name = "measured"
kind = "distance"
between = ["start", "end"]
[[controller]]
drives = "force"
place = "end"
along = "x"
quantity = "measured"
target = "60 mm"
gain = 5
highest = "1 N"
)toml") + loop);
  expect_loop(
      found, 40e-3, 0.1, 60e-3, 5, [](double force) { return 40e-3 * stretch_at(force); }, 1e-8);
}

TEST_F(ControlledLoads, ADisplacementFollowsAForce) {
  const auto found = rows(rod(R"toml(
[[support]]
place = "end"
fix = ["x", "y"]
[[quantity]]
name = "driven"
kind = "displacement"
of = "end"
along = "x"
[[quantity]]
name = "measured"
kind = "force"
of = "end"
along = "x"
[[controller]]
drives = "displacement"
place = "end"
along = "x"
quantity = "measured"
target = "0.3 N"
gain = 0.02
highest = "30 mm"
)toml") + loop);
  expect_loop(
      found, 0, 0, 0.3, 0.02, [](double moved) { return rod_force(1 + moved / 40e-3); }, 1e-8);
}

/// Of an incompressible sphere of film: p = 2 modulus H/R (1/l - 1/l^7).
std::string balloon(const std::string& rest) {
  return R"toml(
model = "axisymmetric"
[film]
thickness = "0.2 mm"
[film.material]
shear_modulus = "50 kPa"
relative_permittivity = 3
[balloon]
radius = "20 mm"
[mesh]
rings = 64
)toml" + rest;
}

double balloon_pressure(double stretch) {
  return 2 * modulus * 0.2e-3 / 20e-3 * (1 / stretch - std::pow(stretch, -7));
}

TEST_F(ControlledLoads, APressureFollowsASize) {
  const auto found = rows(balloon(R"toml(
[chamber]
pressure = "200 Pa"
[[quantity]]
name = "driven"
kind = "pressure"
[[quantity]]
name = "measured"
kind = "radius"
of = "equator"
[[controller]]
drives = "pressure"
quantity = "measured"
target = "22 mm"
gain = 5e4
highest = "400 Pa"
)toml") + loop);
  const auto rest = [](double pressure) {
    double low = 1, high = std::pow(7, 1.0 / 6); // where the pressure is largest
    for (int i = 0; i < 200; ++i) {
      const double middle = (low + high) / 2;
      (balloon_pressure(middle) < pressure ? low : high) = middle;
    }
    return 20e-3 * low;
  };
  expect_loop(found, 20e-3, 200, 22e-3, 5e4, rest, 1e-5);
}

TEST_F(ControlledLoads, AVolumeFollowsAPressure) {
  const auto found = rows(balloon(R"toml(
[chamber]
volume = "40 ml"
[[quantity]]
name = "driven"
kind = "pumped volume"
[[quantity]]
name = "measured"
kind = "pressure"
[[step]]
kind = "inflate"
[[controller]]
drives = "volume"
quantity = "measured"
target = "350 Pa"
gain = 3e-8
highest = "100 ml"
)toml") + loop);
  const auto rest = [](double pumped) {
    double low = 1, high = 2;
    for (int i = 0; i < 200; ++i) {
      const double middle = (low + high) / 2;
      const double own = 4 * std::numbers::pi / 3 * std::pow(20e-3 * middle, 3);
      (own * (1 + balloon_pressure(middle) / 2.2e9) < pumped ? low : high) = middle;
    }
    return balloon_pressure(low);
  };
  expect_loop(found, rest(40e-6), 40e-6, 350, 3e-8, rest, 1e-5);
}

} // namespace
} // namespace dielast::cases::controlled_loads_test
