// SPDX-License-Identifier: GPL-3.0-or-later
// The spring-rolled muscle as a film of revolution against its lumped equations, and what these neglect.
#include "cases/readers/reader.hpp"
#include "tests/cases/values_at_end.hpp"

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

} // namespace
} // namespace dielast::cases
