// SPDX-License-Identifier: GPL-3.0-or-later
// Cables against closed forms: behind a rod of film, along the edge of a film, and in what weighs on them.
#include "cases/devices/device.hpp"
#include "cases/runs/simulation.hpp"
#include "meshing/gmsh/gmsh_text.hpp"
#include "tests/cases/case_test.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace dielast::cases::cables_test {
namespace {

constexpr double shear_modulus = 50e3, film_permittivity = 3 * 8.8541878128e-12;
constexpr double stiffness = 20e6 * std::numbers::pi / 4 * 0.5e-3 * 0.5e-3, crimp = 0.01; // N
constexpr const char* threads =
    "yield_strain = \"20 %\"\ndiameter = \"0.5 mm\"\nyoungs_modulus = \"20 MPa\"\ncrimp = \"1 %\"\n";

double tension(double strain) {
  if (strain <= 0) return 0;
  return strain < crimp ? stiffness * strain * strain / (2 * crimp) : stiffness * (strain - crimp / 2);
}

constexpr const char* middle =
    "[\"13.333333333333333333 mm\", \"26.666666666666666667 mm\", \"26.666666666666666667 mm\"]";

class Cables : public test::CaseTest {
 protected:
  /// A rod of film of 40 mm, prestretched by 1.3, pulls a tendon of 60 mm: in space along (1, 2, 2),
  /// otherwise along x.
  static std::string muscle(const std::string& voltage, double prestretch, int order, bool in_space) {
    return fmt::format(R"toml(
model = "{}"
[part.muscle.film]
thickness = "0.1 mm"
prestretch = 1.3
[part.muscle.film.material]
shear_modulus = "50 kPa"
relative_permittivity = 3
[part.muscle.line]
to = {}
[part.muscle.rod]
width = "100 mm"
[part.tendon]
at = {}
[part.tendon.line]
to = {}
[part.tendon.mesh]
order = {}
[part.tendon.cable]
{}prestretch = {}
[[tie]]
between = ["muscle.end", "tendon.start"]
[[electrode]]
name = "film"
place = "muscle.film"
[[support]]
place = "muscle.start"
fix = ["x", "y", "z"]
[[support]]
place = "tendon.end"
fix = ["x", "y", "z"]
{}[drive]
voltage = "{}"
[[step]]
kind = "release"
[[step]]
kind = "voltage"
[[quantity]]
name = "length"
kind = "distance"
between = ["muscle.start", "muscle.end"]
[[quantity]]
name = "pull"
kind = "extreme"
of = "axial_force"
extreme = "maximum"
[[quantity]]
name = "use"
kind = "extreme"
of = "yield_ratio"
extreme = "maximum"
[[quantity]]
name = "strain"
kind = "extreme"
of = "axial_strain"
extreme = "maximum"
)toml",
                       in_space ? "3d" : "planar", in_space ? middle : "[\"40 mm\", 0, 0]",
                       in_space ? middle : "[\"40 mm\", 0, 0]",
                       in_space ? "[\"20 mm\", \"40 mm\", \"40 mm\"]" : "[\"60 mm\", 0, 0]", order, threads,
                       prestretch, in_space ? "" : "[[support]]\nplace = \"muscle.end\"\nfix = [\"y\"]\n",
                       voltage);
  }
};

double film_force(double stretch, double voltage) { // of 0.1 x 100 mm at rest
  const double field = voltage / 0.1e-3;
  return 1e-5 * (shear_modulus * (stretch - 1 / (stretch * stretch)) - film_permittivity * field * field / 2);
}

/// Length of the muscle at which both pull alike, m.
double balance(double voltage, double prestretch) {
  double low = 0.02, high = 0.1;
  for (int i = 0; i < 100; ++i) {
    const double length = (low + high) / 2;
    const double own = film_force(1.3 * length / 40e-3, voltage);
    (own < tension((100e-3 - length) * prestretch / 60e-3 - 1) ? low : high) = length;
  }
  return low;
}

TEST_F(Cables, PullWhatPullsThem) {
  for (const int order : {1, 2}) {
    const auto end = values(muscle("2 kV", 1, order, true));
    const double length = balance(2000, 1);
    EXPECT_NEAR(end.at("length"), length, 1e-9 * length);
    EXPECT_NEAR(end.at("pull"), film_force(1.3 * length / 40e-3, 2000), 1e-9);
    EXPECT_NEAR(end.at("use"), end.at("pull") / stiffness / 0.2, 1e-12);
    EXPECT_NEAR(end.at("strain"), (100e-3 - length) / 60e-3 - 1, 1e-9);
  }
}

/// At a joint it is the rod's end that its film pulls on, not the cable's.
TEST_F(Cables, EndWhereNoFilmPulls) {
  const auto pulled = [&](const std::string& place) {
    return values(muscle("2 kV", 1, 2, false) + "[[quantity]]\nname = \"pulled\"\nkind = \"film force\"\n" +
                  "along = \"x\"\nof = \"" + place + "\"\n")
        .at("pulled");
  };
  EXPECT_NEAR(pulled("muscle.end"), -film_force(1.3 * balance(2000, 1) / 40e-3, 2000), 1e-9);
  EXPECT_THROW(pulled("tendon.start"), CaseError);
}

/// Its voltage lets the film grow longer than it is held: the tendon hangs slack, and the film is as long as
/// it likes. In between it is where its fibres are crimped.
TEST_F(Cables, HangSlackWhereNothingPulls) {
  for (const double prestretch : {1.0, 1.02, 0.97, 0.8}) {
    const auto end = values(muscle("5 kV", prestretch, 2, false));
    const double length = balance(5000, prestretch);
    EXPECT_NEAR(end.at("length"), length, 1e-8 * length) << prestretch;
    EXPECT_NEAR(end.at("pull"), tension((100e-3 - length) * prestretch / 60e-3 - 1), 1e-8) << prestretch;
  }
}

/// A film in pure shear with threads along its upper edge, from a mesh of the user's.
TEST_F(Cables, HoldAnEdgeOfTheFilmInTensionOnly) {
  const std::string film = R"toml(
model = "planar"
[film]
thickness = "0.5 mm"
[film.material]
shear_modulus = "50 kPa"
relative_permittivity = 3
)toml";
  meshing::Mesh mesh = build_mesh(
      read(film + "[rectangle]\nlength = \"40 mm\"\nwidth = \"20 mm\"\n[mesh]\nacross = 4\norder = 1\n"));
  std::vector<int> top = mesh.node_sets.at("top");
  std::ranges::sort(top, {}, [&](int n) { return mesh.nodes[static_cast<std::size_t>(n)].x(); });
  meshing::CellSet edge{static_cast<int>(mesh.blocks.size()), {}};
  meshing::CellBlock lines{meshing::CellType::line2, {}};
  for (std::size_t i = 0; i + 1 < top.size(); ++i) {
    edge.cells.push_back(lines.size());
    lines.nodes.insert(lines.nodes.end(), {top[i], top[i + 1]});
  }
  mesh.blocks.push_back(lines);
  mesh.cell_sets["top"] = edge;
  write("film.msh", meshing::gmsh_text(mesh));
  for (const double moved : {4e-3, -4e-3}) {
    const auto end = values(film + fmt::format(R"toml(
[mesh]
file = "film.msh"
unit = "1 m"
[part.threads]
place = "top"
[part.threads.cable]
{}
[[support]]
place = "left"
fix = ["x", "y"]
[[support]]
place = "bottom"
fix = ["y"]
[[support]]
place = "top"
fix = ["y"]
[[support]]
place = "right"
fix = ["x", "y"]
[support.displacement]
x = {}
[[step]]
kind = "move"
[[quantity]]
name = "force"
kind = "force"
of = "right"
along = "x"
)toml",
                                               threads, fmt::format("\"{} mm\"", 1e3 * moved)));
    const double stretch = 1 + moved / 40e-3;
    const double force =
        0.5e-3 * 20e-3 * shear_modulus * (stretch - std::pow(stretch, -3)) + tension(stretch - 1);
    EXPECT_NEAR(end.at("force"), force, 1e-9 * std::abs(force)) << moved;
  }
}

/// What hangs from a taut cable rings at sqrt(k/m), k that of its length at rest.
TEST_F(Cables, CarryAWeightThatRings) {
  const auto end = values(fmt::format(R"toml(
model = "3d"
[part.p]
at = ["50 mm", 0, 0]
[part.p.film]
thickness = "1 mm"
prestretch = 1.2
[part.p.film.material]
shear_modulus = "50 kPa"
relative_permittivity = 4
[part.p.rectangle]
length = "10 mm"
[part.p.mesh]
across = 2
[part.c.line]
to = [0, 0, "-100 mm"]
[part.c.cable]
{}density = "0 kg/m^3"
prestretch = 1.001
[gravity]
acceleration = 10
[[support]]
place = "p.frame"
fix = ["x", "y", "z"]
[[support]]
place = "c.start"
fix = ["x", "y", "z"]
[[support]]
place = "c.end"
fix = ["x", "y"]
[[point_mass]]
place = "c.end"
mass = "20 g"
[[step]]
kind = "weight"
[[quantity]]
name = "pull"
kind = "extreme"
of = "axial_force"
extreme = "maximum"
[[quantity]]
name = "sag"
kind = "displacement"
of = "c.end"
along = "gravity"
[[quantity]]
name = "rings"
kind = "natural frequency"
)toml",
                                      threads));
  const double length = 100e-3 / 1.001;
  EXPECT_NEAR(end.at("pull"), 0.2, 1e-10);
  EXPECT_NEAR(end.at("sag"), length * (1 + 0.2 / stiffness + crimp / 2) - 100e-3, 1e-11);
  EXPECT_NEAR(end.at("rings"), std::sqrt(stiffness / length / 20e-3), 1e-8);
}

/// In space nothing keeps the joint of a slack tendon and slack film on its line: no state is made up.
TEST_F(Cables, WhatASlackCableLeavesFreeIsTold) {
  const Case one = read(muscle("5 kV", 0.97, 2, true));
  Simulation simulation(one, 1);
  const Outcome outcome = simulation.run({});
  EXPECT_EQ(outcome.ending, Ending::gave_up);
  EXPECT_NE(outcome.message.find("can move freely"), std::string::npos) << outcome.message;
}

} // namespace
} // namespace dielast::cases::cables_test
