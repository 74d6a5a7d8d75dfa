// SPDX-License-Identifier: GPL-3.0-or-later
// Bars beside the film: printed on one face, or on both.
#include "tests/cases/case_test.hpp"

#include <fmt/format.h>

namespace dielast::cases::bars_test {
namespace {

class Bars : public test::CaseTest {};

constexpr double length = 0.1, width = 4e-3, height = 2e-3, modulus = 78e6;

/// A cantilever beside a film that has nothing to do with it, pulled along a line below its axis.
std::string pulled_cantilever(double offset, double force) {
  return fmt::format(R"(
model = "3d"
[film]
thickness = "1 mm"
[film.material]
shear_modulus = "45 kPa"
relative_permittivity = 4
[patch]
length = "10 mm"
[part.bar.line]
from = [0, "50 mm", 0]
to = ["{} m", "50 mm", 0]
[part.bar.beam]
width = "{} m"
height = "{} m"
offset = "{} m"
[[support]]
place = "film"
fix = ["z"]
[[support]]
place = "bar.start"
fix = ["x", "y", "z", "turn_x", "turn_y", "turn_z"]
[[load]]
place = "bar.end"
force = ["{} N", 0, 0]
[[step]]
kind = "force"
increments = 1
[[quantity]]
name = "rise"
kind = "displacement"
of = "bar.end"
along = "z"
[[quantity]]
name = "stretch"
kind = "displacement"
of = "bar.end"
along = "x"
)",
                     length, width, height, offset, force);
}

// The pull F at the distance e below the axis bends the bar by the moment F e: its end rises by F e L^2/(2 E
// I) and turns by F e L/(E I), which takes the line's end along by e times that.
TEST_F(Bars, ABarBesideItsLineBendsUnderAPullAlongTheLine) {
  const double force = 1e-6, EI = modulus * width * height * height * height / 12;
  for (const double offset : {3e-3, -3e-3}) {
    const auto found = values(pulled_cantilever(offset, force));
    const double up = force * offset * length * length / (2 * EI);
    EXPECT_NEAR(found.at("rise"), up, 1e-4 * std::abs(up));
    const double along = force * length / (modulus * width * height) + force * offset * offset * length / EI;
    EXPECT_NEAR(found.at("stretch"), along, 1e-4 * along);
  }
  EXPECT_EQ(values(pulled_cantilever(0, force)).at("rise"), 0);
}

std::string released_cells(const std::string& walls) {
  return R"toml(
model = "3d"
[film]
material = "VHB 4910 (honeycomb)"
thickness = "1 mm"
prestretch = [3.0, 3.0]
[honeycomb]
angle = "120 deg"
columns = [2, 1]
wall_length = "8 mm"
wall_width = "0.8 mm"
)toml" + walls +
         R"toml(
[mesh]
wall_elements = 2
[drive]
voltage = "1 kV"
[[step]]
kind = "release"
on_bifurcation = "switch"
[[quantity]]
name = "depth"
kind = "size"
of = "walls"
along = "z"
[[quantity]]
name = "twist"
kind = "modal stiffness"
)toml";
}

TEST_F(Bars, WallsOnOneFaceCurlAndWallsOnBothStayFlat) {
  const auto curled = values(released_cells("wall_height = \"2 mm\"\nwall_print = \"one face\"\n"));
  EXPECT_GT(curled.at("depth"), 1e-4);
  EXPECT_GT(curled.at("twist"), 0);
  for (const std::string print : {"merged", "both faces"}) {
    const auto flat = values(released_cells("wall_height = \"2 mm\"\nwall_print = \"" + print + "\"\n"));
    EXPECT_LT(flat.at("depth"), 1e-12) << print;
    EXPECT_GT(flat.at("twist"), 0) << print;
    EXPECT_NEAR(flat.at("released_length_x"), curled.at("released_length_x"),
                0.1 * curled.at("released_length_x"));
  }
}

/// Prestretched film between the ends of a bar that buckles to a bow as the film is cut free.
std::string bow(int increments) {
  return R"toml(
model = "3d"
[film]
thickness = "0.1 mm"
prestretch = [2.5, 4]
[film.material]
law = "gent"
shear_modulus = "60 kPa"
stretch_limit = 90
permittivity = "4.5e-11 F/m"
[patch]
length = "12 mm"
width = "5 mm"
mode = "pure-shear"
[part.bar]
at = [0, "10 mm", 0]
[part.bar.line]
to = ["30 mm", 0, 0]
[part.bar.mesh]
wall_elements = 12
[part.bar.beam]
width = "3 mm"
height = "0.3 mm"
material = { youngs_modulus = "1.1 GPa", poisson_ratio = 0.3 }
[[tie]]
between = ["left", "bar.start"]
[[tie]]
between = ["right", "bar.end"]
[[support]]
place = "left"
fix = ["x", "y", "z", "turn_x", "turn_z"]
[[support]]
place = "right"
fix = ["y", "z", "turn_x", "turn_z"]
[drive]
voltage = "0.9 kV"
[[step]]
kind = "release"
on_bifurcation = "switch"
increments = 5
[[step]]
kind = "voltage"
increments = )toml" +
         std::to_string(increments) + R"toml(
[[quantity]]
name = "released_chord"
kind = "distance"
between = ["left", "right"]
along = "x"
at = "release"
[[quantity]]
name = "chord"
kind = "distance"
between = ["left", "right"]
along = "x"
[[quantity]]
name = "force"
kind = "film force"
of = "right"
along = "x"
)toml";
}

// The voltage takes the film's pull below the bar's buckling load (at 392 V): the bow lies flat, however
// large the increments are; there its way runs into that of the straight bar with an infinite slope.
TEST_F(Bars, ABowThatOpensLiesFlat) {
  for (const int increments : {6, 7, 15}) {
    const auto found = values(bow(increments));
    EXPECT_NEAR(found.at("released_chord"), 27.2862e-3, 1e-6); // own solution of the elastica by shooting
    EXPECT_NEAR(found.at("force"), -22.3663e-3, 1e-7);
    EXPECT_NEAR(found.at("chord"), 30e-3 * (1 - 22.3663e-3 / (1.1e9 * 3e-3 * 0.3e-3)), 1e-9);
  }
}

} // namespace
} // namespace dielast::cases::bars_test
