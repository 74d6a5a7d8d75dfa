// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies that may turn freely, on film that resists nothing.
#include "tests/cases/film_cases.hpp"

#include <cmath>

namespace dielast::cases::free_bodies_test {
namespace {

class FreeBodies : public FilmCases {};

const std::string square = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 1 "film"
$EndPhysicalNames
$Nodes
9
1 0 0 0
2 10 0 0
3 10 10 0
4 5 0 0
5 10 5 0
6 5 5 0
7 0 10 0
8 5 10 0
9 0 5 0
$EndNodes
$Elements
2
1 9 2 1 1 1 2 3 4 5 6
2 9 2 1 1 1 3 7 6 8 9
$EndElements
)";

/// All of a square film on a body with a pivot, its centre 10 mm below.
std::string pendulum(const std::string& rest) {
  return "model = \"planar\"\n[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"1 MPa\"\n"
         "permittivity = \"4e-11 F/m\"\ndensity = \"0 kg/m^3\"\n"
         "[mesh]\nfile = \"square.msh\"\nunit = \"1 mm\"\n"
         "[[body]]\nname = \"hub\"\nplaces = [\"film\"]\nmass = \"10 g\"\n"
         "centre = [\"0 mm\", \"-10 mm\", \"0 mm\"]\npivot = [\"0 mm\", \"0 mm\", \"0 mm\"]\n"
         "[gravity]\ndirection = [0, -1, 0]\n[[load]]\nplace = \"hub\"\n"
         "moment = [\"0 N m\", \"0 N m\", \"0.5e-3 N m\"]\n"
         "[output]\nfields = false\nerror_estimate = false\n"
         "[[step]]\nkind = \"weight\"\n[[step]]\nkind = \"force\"\n" +
         rest;
}

// The film resists nothing and pulls at nothing: its rounding was taken for tension that is let go.
TEST_F(FreeBodies, film_on_a_body_alone_is_a_pendulum) {
  write("square.msh", square);
  const Ran ran =
      run(pendulum("[[quantity]]\nname = \"angle\"\nkind = \"angle\"\nof = \"hub\"\nalong = \"z\"\n"));
  EXPECT_NEAR(ran.last("angle"), std::asin(0.5e-3 / (10e-3 * 9.81 * 10e-3)), 1e-4);
}

// In space nothing keeps a pendulum from turning about the vertical, which is no instability.
TEST_F(FreeBodies, what_may_turn_freely_is_told) {
  write("square.msh", square);
  write("film.toml", R"(model = "3d"
[part.far]
at = ["50 mm", "0 mm", "0 mm"]
[part.far.film]
thickness = "1 mm"
[part.far.film.material]
shear_modulus = "1 MPa"
permittivity = "4e-11 F/m"
density = "0 kg/m^3"
[part.far.mesh]
file = "square.msh"
unit = "1 mm"
[[support]]
place = "far"
fix = ["x", "y", "z"]
[part.bob]
[part.bob.line]
from = ["0 mm", "-10 mm", "0 mm"]
to = ["0 mm", "-12 mm", "0 mm"]
[part.bob.beam]
width = "1 mm"
height = "1 mm"
[part.bob.beam.material]
youngs_modulus = "1 MPa"
poisson_ratio = 0.3
density = "1e-6 kg/m^3"
[[body]]
name = "hub"
places = ["bob"]
mass = "10 g"
centre = ["0 mm", "-10 mm", "0 mm"]
pivot = ["0 mm", "0 mm", "0 mm"]
[gravity]
direction = [0, -1, 0]
[[step]]
kind = "weight"
)");
  const Case one = read_case(directory / "film.toml");
  const Outcome stopped = Simulation(one, 1).run({});
  EXPECT_EQ(stopped.kind, "singular tangent") << stopped.message;
  EXPECT_NE(stopped.message.find("can move freely"), std::string::npos) << stopped.message;
}

} // namespace
} // namespace dielast::cases::free_bodies_test
