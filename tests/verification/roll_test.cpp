// SPDX-License-Identifier: GPL-3.0-or-later
// The spring-rolled muscle as a film of revolution against its lumped equations, and what these neglect.
#include "cases/readers/reader.hpp"
#include "tests/cases/values_at_end.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace dielast::cases::roll_test {
namespace {

constexpr double unstretched = 40e-3; ///< m

std::map<std::string, double> roll(std::vector<std::string> overrides) {
  for (const char* always :
       {"step=[{ kind = \"release\" }, { kind = \"voltage\", name = \"on\" }]", "check="})
    overrides.emplace_back(always);
  return test::values_at_end(read_case(
      std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/rolled_muscle/roll.toml", overrides));
}

// Branches relaxed, no load: the spring against the film in pure shear, at 0 and 4 kV.
TEST(Roll, OfHeldRadiusIsTheLumpedMuscle) {
  EXPECT_NEAR(roll({"drive.voltage=0"}).at("length") / unstretched, 1.94999, 2e-5);
  const auto charged = roll({});
  EXPECT_NEAR(charged.at("length") / unstretched, 2.0554957, 1e-5 * 2.0554957);
  EXPECT_GT(charged.at("min_principal_stress"), 0); // the film presses on its core everywhere
}

// Turns and radius matter only by their product where the radius is held.
TEST(Roll, IsMadeOfTurns) {
  const auto eight = roll({}), four = roll({"roll.turns=4", "roll.radius=9.94718 mm"});
  EXPECT_NEAR(four.at("length"), eight.at("length"), 1e-9 * eight.at("length"));
  EXPECT_NEAR(four.at("capacitance"), eight.at("capacitance"), 1e-9 * eight.at("capacitance"));
}

// Margins have no field: film without an electrode beside it gives the stroke of less.
TEST(Roll, MarginsAreNotCharged) {
  const auto covered = roll({}), half = roll({"roll.electrode_length=20 mm"});
  EXPECT_LT(half.at("stroke"), 0.6 * covered.at("stroke"));
  EXPECT_GT(half.at("stroke"), 0.4 * covered.at("stroke"));
  EXPECT_LT(half.at("capacitance"), 0.6 * covered.at("capacitance"));
}

// Without its core the film draws in between the end caps, and is then longer.
TEST(Roll, WithoutACoreDrawsIn) {
  const auto free = roll({"roll.core='none'", "drive.voltage=0", "mesh.rings=64"});
  EXPECT_GT(free.at("length") / unstretched, 1.9501);
  EXPECT_LT(free.at("length") / unstretched, 1.96);
  EXPECT_GT(free.at("min_principal_stress"), -1); // nothing is left around it
}

/// On a core that carries pressure only: the sum of what it carries, and the middle's stress around it.
std::map<std::string, double> on_one_side(std::vector<std::string> overrides) {
  for (const char* always :
       {"roll.core='one-sided'", "contact.thickness='0.5 um'",
        "quantity=[{ name = 'pressing', kind = 'contact force' }, { name = 'hoop', kind = 'value', of = "
        "'cauchy_stress.yy', point = ['4.97359 mm', '0 mm', '39 mm'] }]"})
    overrides.emplace_back(always);
  return roll(std::move(overrides));
}

// Where the film presses everywhere, it is the film whose radius is held, and the core bears its tension
// over its radius; lifted, it is the film without a core.
TEST(Roll, CoreCarriesPressureAndNoTension) {
  for (const char* voltage : {"drive.voltage=0", "drive.voltage='3 kV'", "drive.voltage='4 kV'"}) {
    const auto held = roll({voltage}), pressed = on_one_side({voltage});
    EXPECT_NEAR(pressed.at("length"), held.at("length"), 2e-6 * held.at("length")) << voltage;
    // Tension around the core per length, of eight turns stretched along it, also where the caps hold its
    // ends; what the film sinks into the barrier takes its part.
    const double tension = held.at("min_principal_stress") * 8 * 0.254e-3 * unstretched / held.at("length");
    constexpr double sinks = 0.5e-6 / 4.97359e-3 * 1.4e6 / 37e3 * 18.8;
    EXPECT_NEAR(pressed.at("pressing"), 2 * std::numbers::pi * held.at("length") * tension, sinks) << voltage;
    EXPECT_GT(pressed.at("pressing"), 0.1) << voltage;
  }
  for (const char* voltage : {"drive.voltage='4.1 kV'", "drive.voltage='5 kV'"}) {
    const auto held = roll({voltage}), lifted = on_one_side({voltage}),
               free = roll({"roll.core='none'", voltage});
    EXPECT_LT(held.at("min_principal_stress"), -1e3) << voltage; // it would pull
    EXPECT_NEAR(lifted.at("pressing"), 0, 1e-9) << voltage;
    EXPECT_NEAR(lifted.at("hoop"), 0, 1) << voltage;
    EXPECT_NEAR(lifted.at("length"), free.at("length"), 1e-9 * free.at("length")) << voltage;
    EXPECT_GT(lifted.at("length"), (1 + 1e-5) * held.at("length")) << voltage;
  }
}

// What the film pulls its caps together with is what the spring pushes them apart with.
TEST(Roll, ForceOfTheFilmIsThatOfTheSpring) {
  for (const char* core : {"roll.core='two-sided'", "roll.core='none'"}) {
    const auto charged = roll({core});
    EXPECT_NEAR(charged.at("roll_force"), 180 * (0.110 - charged.at("length")), 1e-6);
    EXPECT_NEAR(charged.at("strain"), charged.at("stroke") / (charged.at("length") - charged.at("stroke")),
                1e-9);
  }
}

// An end cap is a body: its weight hangs on the film, and its mass swings on the roll's stiffness.
TEST(Roll, EndCapsAreBodies) {
  const std::string cap = "body=[{ name = 'lower_cap', places = ['lower_end'], fix = ['z'] }, { name = "
                          "'upper_cap', places = ['upper_end'], mass = '50 g' }]";
  const auto values = test::values_at_end(
      read_case(std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/rolled_muscle/roll.toml",
                {cap, "film.material.density='0 kg/m^3'", "drive.voltage=0",
                 "check=", "step=[{ kind = 'release' }, { kind = 'weight' }]",
                 "quantity=[{ name = 'frequency', kind = 'natural frequency' }]"}));
  EXPECT_NEAR(values.at("roll_force") - 180 * (0.110 - values.at("length")), -0.05 * 9.81, 1e-3);
  EXPECT_NEAR(values.at("frequency"), std::sqrt(values.at("stiffness") / 0.05),
              1e-6 * values.at("frequency"));
}

/// Twenty minutes under load, four times a second: strokes of the first and the last two seconds, mm.
std::array<double, 2> strokes(const std::vector<std::string>& overrides) {
  const Case one = read_case(
      std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/rolled_muscle/roll_cycles.toml", overrides);
  const auto length = std::ranges::find(one.quantities, "length", &Quantity::name) - one.quantities.begin();
  std::vector<std::pair<double, double>> rows; // s, mm
  SimulationObserver observer;
  observer.on_accept = [&](const Frame& frame) {
    const double at = 1e3 * frame.values[static_cast<std::size_t>(length)];
    if (frame.record.step == "cycles" || frame.ends_step) rows.emplace_back(frame.record.time, at);
    return true;
  };
  EXPECT_EQ(Simulation(one, 1).run(observer).ending, Ending::complete);
  const auto stroke = [&](double from, double to) {
    double low = 1e3, high = 0;
    for (const auto& [time, at] : rows)
      if (time >= from - 1e-6 && time <= to + 1e-6) low = std::min(low, at), high = std::max(high, at);
    return high - low;
  };
  return {stroke(0, 2), stroke(1198, 1200)};
}

TEST(Roll, StrokesForTwentyMinutesAsTheLumpedMuscle) {
  const auto five = strokes({"check="});
  EXPECT_NEAR(five[0], 0.5190, 1e-3 * 0.5190);
  EXPECT_NEAR(five[1], 0.5289, 1e-3 * 0.5289);
  const auto two = strokes(
      {"check=",
       "film.material={ law = 'gent', shear_modulus = '49458 Pa', stretch_limit = 200, "
       "relative_permittivity = 4.08, branch = [{ law = 'gent', shear_modulus = '1 MPa', stretch_limit "
       "= 200, dashpot = 'nominal', directions = ['x'], viscosity = '1e7 Pa s' }] }"});
  EXPECT_NEAR(two[0], 0.6725, 1e-3 * 0.6725);
  EXPECT_NEAR(two[1], 0.6647, 1e-3 * 0.6647);
}

} // namespace
} // namespace dielast::cases::roll_test
