// SPDX-License-Identifier: GPL-3.0-or-later
// The spring-rolled muscle as a film of revolution against its lumped equations, and what these neglect.
#include "cases/readers/reader.hpp"
#include "tests/cases/values_at_end.hpp"

#include <algorithm>
#include <array>

namespace dielast::cases {
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
  const auto free =
      roll({"support=[{ place = 'lower_end', fix = ['x', 'z'] }, { place = 'upper_end', fix = ['x'] }]",
            "drive.voltage=0", "mesh.rings=64"});
  EXPECT_GT(free.at("length") / unstretched, 1.9501);
  EXPECT_LT(free.at("length") / unstretched, 1.96);
  EXPECT_GT(free.at("min_principal_stress"), -1); // nothing is left around it
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
} // namespace dielast::cases
