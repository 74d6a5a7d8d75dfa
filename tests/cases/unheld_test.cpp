// SPDX-License-Identifier: GPL-3.0-or-later
// What nothing holds, or what is held beside the film: it is pinned, refused or told.
#include "cases/devices/device.hpp"
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::cases::unheld_test {
namespace {

class Unheld : public Paths {};

// mu (l - l^-5) = eps E0^2 l^3 along x and z, l^-2 along y. The block is pinned in such a way that its strain
// does not turn it.
TEST_F(Unheld, ABlockDoesNotTurnAsItSwells) {
  const double mu = 40e3, eps = 4e-11, field = 12e3 / 2e-3;
  double l = 1;
  for (int i = 0; i < 60; ++i)
    l -= (mu * (l - std::pow(l, -5)) - eps * field * field * std::pow(l, 3)) /
         (mu * (1 + 5 * std::pow(l, -6)) - 3 * eps * field * field * l * l);
  std::string text = R"toml(
model = "3d"
[film]
thickness = "2 mm"
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
[slab]
length = "20 mm"
height = "4 mm"
width = "10 mm"
[mesh]
across = 1
[drive]
voltage = "12 kV"
[[step]]
kind = "voltage"
increments = 2
[output]
error_estimate = false
)toml";
  for (const char* axis : {"x", "y", "z"})
    text += fmt::format("[[quantity]]\nname = \"g{0}\"\nkind = \"growth\"\nof = \"film\"\nalong = \"{0}\"\n",
                        axis);
  const auto found = values(text);
  EXPECT_NEAR(found.at("gx"), l - 1, 1e-8);
  EXPECT_NEAR(found.at("gz"), l - 1, 1e-8);
  EXPECT_NEAR(found.at("gy"), 1 / (l * l) - 1, 1e-8);
}

// A strip that swings about its edge: Newton's method finds it somewhere.
TEST_F(Unheld, AShellThatMaySwingIsNoResult) {
  const auto ended = [&](const std::string& turns, const std::string& then = "") {
    return run(R"toml(
model = "3d"
[film]
thickness = "0.2 mm"
section = "shell"
[film.material]
shear_modulus = "300 kPa"
permittivity = "3e-11 F/m"
[[film.layer]]
name = "top"
thickness = "0.2 mm"
[film.layer.material]
shear_modulus = "300 kPa"
permittivity = "3e-11 F/m"
[rectangle]
length = "40 mm"
width = "10 mm"
[mesh]
across = 1
[output]
error_estimate = false
[[electrode]]
name = "e"
place = "film"
layer = "top"
[drive]
voltage = "1 kV"
[[step]]
kind = "voltage"
increments = 4
[[support]]
place = "left"
fix = ["x", "y", "z")toml" +
                   turns + "]\n" + then,
               "capacitance")
        .outcome;
  };
  const Outcome swings = ended("");
  EXPECT_EQ(swings.ending, Ending::gave_up);
  EXPECT_NE(swings.message.find("can move freely"), std::string::npos) << swings.message;
  EXPECT_EQ(ended(", \"turn_y\"").ending, Ending::complete);
  const std::string hold = "[[step]]\nkind = \"hold\"\nduration = \"1 s\"\n";
  EXPECT_EQ(ended("", hold).ending, Ending::gave_up);
  EXPECT_EQ(ended(", \"turn_y\"", hold).ending, Ending::complete);
}

// One that swings so far that Newton's method finds it no longer stops on its way, and is told of alike.
TEST_F(Unheld, AShellThatSwingsTooFarIsToldToBeLoose) {
  const Outcome outcome = run(R"toml(
model = "3d"
[film]
thickness = "0.1 mm"
section = "shell"
[film.material]
shear_modulus = "100 kPa"
relative_permittivity = 3
[[film.layer]]
name = "passive"
thickness = "0.05 mm"
material = { shear_modulus = "400 kPa", relative_permittivity = 3 }
[rectangle]
length = "30 mm"
width = "6 mm"
[mesh]
across = 6
[[electrode]]
name = "e"
place = "film"
[[support]]
place = "left"
fix = ["x", "y", "z"]
[drive]
voltage = "400 V"
)toml",
                              "capacitance")
                              .outcome;
  EXPECT_EQ(outcome.ending, Ending::gave_up);
  EXPECT_NE(outcome.message.find("can move freely"), std::string::npos) << outcome.message;
}

// Lines with nodes of their own, drawn a second time: what is said of "frame" is not said of the film.
TEST_F(Unheld, LinesThatAreNotJoinedToTheFilmAreTold) {
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"frame\"\n2 2 "
                           "\"film\"\n$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 60 0 0\n3 60 60 0\n4 0 60 0\n"
                           "5 0 0 0\n6 0 60 0\n$EndNodes\n$Elements\n3\n1 1 2 1 1 ";
  const auto told = [&](const std::string& line) {
    write("own.msh", head + line + "\n2 2 2 2 5 1 2 3\n3 2 2 2 5 1 3 4\n$EndElements\n");
    const Device device = build_device(
        read("[film]\nmaterial = \"VHB 4910 (honeycomb)\"\nthickness = \"1 mm\"\n[mesh]\nfile = \"own.msh\"\n"
             "unit = \"1 mm\"\n[[support]]\nplace = \"frame\"\nfix = [\"x\", \"y\"]\n"));
    return std::ranges::any_of(device.warnings, [](const std::string& warning) {
      return warning.starts_with("lines or places are not joined to the film: 2 of their nodes");
    });
  };
  EXPECT_TRUE(told("5 6"));
  EXPECT_FALSE(told("1 4"));
}

} // namespace
} // namespace dielast::cases::unheld_test
