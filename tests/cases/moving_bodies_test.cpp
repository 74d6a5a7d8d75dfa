// SPDX-License-Identifier: GPL-3.0-or-later
// What bodies that move press on their pivots with.
#include "tests/cases/film_cases.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::cases::moving_bodies_test {
namespace {

constexpr double mass = 10e-3, arm = 50e-3, g = 9.81, moment = 2.4525e-3;
constexpr double inertia = 4e-7 + mass * arm * arm;

class MovingBodies : public FilmCases {
 protected:
  /// A pendulum that a moment begins to turn at once.
  Ran pendulum(const std::string& rest) {
    return run(R"(model = "planar"
[part.d.line]
to = ["20 mm", 0, 0]
[part.d.rod]
width = "1 mm"
[part.d.film]
thickness = "0.1 mm"
[part.d.film.material]
shear_modulus = "50 kPa"
relative_permittivity = 4
density = 0
[[support]]
place = "d.end"
fix = ["x", "y"]
[[body]]
name = "hub"
places = ["d.start"]
mass = "10 g"
inertia = "400 g.mm^2"
centre = ["50 mm", 0, 0]
pivot = [0, 0, 0]
[gravity]
direction = [1, 0, 0]
[[load]]
place = "hub"
moment = [0, 0, { wave = "step", to = "2.4525 mN m" }]
[[step]]
kind = "weight"
[[step]]
kind = "transient"
duration = "0.8 s"
increments = 400
[output]
fields = false
error_estimate = false
[[quantity]]
name = "x"
kind = "force"
of = "hub"
along = "x"
[[quantity]]
name = "y"
kind = "force"
of = "hub"
along = "y"
)" + rest);
  }
};

// Its weight hangs along x; the moment is met by what turns faster.
TEST_F(MovingBodies, are_met_by_their_inertia_from_the_moment_at_which_a_load_jumps) {
  const Ran ran = pendulum("");
  const auto behind = std::ranges::find_if(ran.time, [](double t) { return t > 0; }) - ran.time.begin() - 1;
  EXPECT_NEAR(ran.values.at("x")[static_cast<std::size_t>(behind)], -mass * g, 1e-6);
  EXPECT_NEAR(ran.values.at("y")[static_cast<std::size_t>(behind)], mass * arm * moment / inertia, 1e-6);
}

// Corners of a fin have no unknowns: their velocities tell nothing of how a body turns.
TEST_F(MovingBodies, go_around_as_fast_with_a_fin_that_no_fluid_meets) {
  const Ran bare = pendulum("");
  const Ran finned =
      pendulum("[[fin]]\nname = \"tail\"\nbody = \"hub\"\nfrom = [0, 0, 0]\nto = [\"60 mm\", 0, 0]\n"
               "added_mass_coefficient = 0\ndrag_coefficient = 0\nheight = \"10 mm\"\nalong = \"y\"\n");
  const auto &with = finned.values.at("x"), &without = bare.values.at("x");
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t row = 0; row < with.size(); ++row) EXPECT_NEAR(with[row], without[row], 1e-7) << row;
  EXPECT_LT(*std::ranges::min_element(without), -0.12);
}

} // namespace
} // namespace dielast::cases::moving_bodies_test
