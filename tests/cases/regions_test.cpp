// SPDX-License-Identifier: GPL-3.0-or-later
// Regions drawn in discs and annuli, electrodes on them, and a plate that tilts on a pivot.
#include "cases/case/quantities.hpp"
#include "cases/readers/resolved.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/case_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

namespace dielast::cases::regions_test {
namespace {

constexpr double pi = std::numbers::pi;

const std::string film = R"(
[film]
thickness = "1 mm"
prestretch = 2
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
)";
const std::string disc = film + "[disc]\nradius = \"30 mm\"\n[mesh]\nrings = 8\n";
const std::string annulus =
    film + "[annulus]\ninner_radius = \"12.7 mm\"\nouter_radius = \"68.58 mm\"\n[mesh]\nrings = 8\n";

class Regions : public test::CaseTest {};

std::vector<std::string> electrodes_of(const Case& one) {
  std::vector<std::string> names;
  for (const Electrode& electrode : one.electrodes) {
    EXPECT_EQ(electrode.place, electrode.name);
    names.push_back(electrode.name);
  }
  return names;
}

using Names = std::vector<std::string>;

TEST_F(Regions, SectorsAreCountedToo) {
  const auto charged = [&](const std::string& place) {
    return values(annulus + "[sectors]\n[[electrode]]\nname = \"one\"\nplace = \"" + place +
                  "\"\n[drive]\nvoltage = \"1 kV\"\n[output]\nerror_estimate = false\n");
  };
  EXPECT_EQ(charged("sector[1]"), charged("b"));
}

TEST_F(Regions, AreElectrodesWhereTheCaseHasNoOthers) {
  const std::string spot = "[[region]]\nname = \"spot\"\nkind = \"ring\"\nouter_radius = \"5 mm\"\n";
  EXPECT_EQ(electrodes_of(read(disc + spot)), Names{"spot"});
  EXPECT_EQ(electrodes_of(read(annulus + "[sectors]\n")), (Names{"a", "b", "c", "d"}));
  EXPECT_EQ(electrodes_of(read(annulus + "[sectors]\n", {"sectors.count=3"})), (Names{"a", "b", "c"}));
  const Case named = read(disc + spot + "[[electrode]]\nname = \"all\"\nplace = \"film\"\n");
  EXPECT_EQ(named.electrodes.size(), 1U);
  EXPECT_EQ(named.electrodes[0].place, "film");
}

// As any other; without such a region it is the whole disc.
TEST_F(Regions, MayBeCalledElectrode) {
  const std::string ring = "[[region]]\nname = \"{}\"\nkind = \"ring\"\ninner_radius = \"10 mm\"\n";
  const auto capacitance = [&](const std::string& name) {
    return values(disc + fmt::format(fmt::runtime(ring), name) + "[output]\nerror_estimate = false\n")
        .at("capacitance");
  };
  EXPECT_DOUBLE_EQ(capacitance("electrode"), capacitance("a"));
}

// Of film that is held where it is drawn: permittivity times area over the stretched thickness.
TEST_F(Regions, WithTheNameOfAnotherPlaceAreToldAtTheirLine) {
  const Case one = read(disc + "[[region]]\nname = \"rim\"\nkind = \"ring\"\nouter_radius = \"5 mm\"\n");
  try {
    build_mesh(one);
    ADD_FAILURE();
  } catch (const CaseError& error) {
    const auto& [at, key, message, severity] = error.diagnostics().front();
    EXPECT_EQ(fmt::format("{}: {}: {}", at.line, key, message),
              "13: region[1].name: there is a place \"rim\" already; call the region otherwise");
  }
}

TEST_F(Regions, HaveTheCapacitanceOfTheirArea) {
  const std::string drawn = R"(
[[region]]
name = "edge"
kind = "ring"
inner_radius = "26 mm"
gap = "1 mm"
[[region]]
name = "slice"
kind = "sector"
inner_radius = "20 mm"
outer_radius = "25 mm"
from = "20 deg"
to = "110 deg"
[[region]]
name = "bar"
kind = "rectangle"
centre = ["2 mm", "1 mm"]
length = "12 mm"
width = "6 mm"
turned = "30 deg"
gap = "0.5 mm"
[[region]]
name = "wedge"
kind = "polygon"
x = ["-12 mm", "-8 mm", "-12 mm"]
y = ["-4 mm", "0 mm", "4 mm"]
)";
  const std::map<std::string, double> areas{{"edge", pi * (29.0 * 29 - 27 * 27)},
                                            {"slice", pi / 4 * (25 * 25 - 20 * 20)},
                                            {"bar", 11 * 5},
                                            {"wedge", 16}};
  for (const char* model : {"planar", "3d"}) {
    const auto values = this->values(fmt::format("model = \"{}\"\n", model) + disc + drawn);
    for (const auto& [name, area] : areas) {
      const double expected = 4e-11 * area * 1e-6 / 0.25e-3;
      EXPECT_NEAR(values.at("capacitance_" + name), expected, 1e-5 * expected) << model << " " << name;
    }
  }
}

TEST_F(Regions, FilmBesideThemIsPassive) {
  const Case one = read(annulus + "[sectors]\ngap = \"5 mm\"\n[drive.b]\nvoltage = \"1 kV\"\n");
  Simulation simulation(one, 1);
  ASSERT_EQ(simulation.run({}).ending, Ending::complete);
  double charged = 0, all = 0;
  for (const fem::MembraneSample& sample : simulation.device().model.sample(simulation.state()).film) {
    all += sample.volume;
    if (sample.voltage != 0) charged += sample.volume;
    EXPECT_TRUE(sample.voltage == 0 || sample.electrode == 1) << sample.voltage;
  }
  EXPECT_LT(charged, 0.24 * all); // a quarter less its half of two strips
  EXPECT_GT(charged, 0.21 * all);
}

TEST_F(Regions, AResolvedCaseIsTheSameCase) {
  for (const std::string& text :
       {annulus + "[sectors]\ncount = 5\ngap = \"2 mm\"\n[pivot]\nheight = \"4 mm\"\n",
        disc + "[[region]]\nname = \"bar\"\nkind = \"polygon\"\nx = [\"0 mm\", \"5 mm\", \"5 mm\"]\ny = [\"0 "
               "mm\", \"0 mm\", \"5 mm\"]\n"}) {
    const std::string resolved = resolved_text(read(text));
    EXPECT_EQ(resolved_text(read(resolved)), resolved);
  }
}

TEST_F(Regions, ACircuitMayBeAtSomeOfTheElectrodes) {
  const Case one = read(annulus + "[sectors]\n[circuit.b]\nresistance = \"1 MOhm\"\n[drive.b]\nvoltage = \"1 "
                                  "kV\"\n[[step]]\nkind = \"voltage\"\nduration = \"1 s\"\n");
  ASSERT_EQ(one.circuits.size(), 1U);
  EXPECT_EQ(one.circuits.begin()->first, "b");
  const std::string resolved = resolved_text(one);
  EXPECT_EQ(resolved_text(read(resolved)), resolved);
}

TEST_F(Regions, FilmUnderAWallMovesWithItsSections) {
  const Case one = read(test::small_honeycomb, {"honeycomb.wall_bond=width"});
  Simulation simulation(one, 1);
  ASSERT_EQ(simulation.run({}).ending, Ending::complete);
  const Device& device = simulation.device();
  const auto& under = device.mesh.node_sets.at("under_walls");
  const auto& walls = device.mesh.node_sets.at("walls");
  std::set<int> tied;
  double turned = 0;
  for (const fem::Tie& tie : device.model.dofs.ties()) {
    tied.insert(tie.node);
    EXPECT_TRUE(std::ranges::binary_search(walls, tie.master));
    EXPECT_LE(tie.arm.norm(), 2 * one.geometry<Honeycomb>()->wall.width);
    const auto place = [&](int node) -> Eigen::Vector3d {
      const auto n = static_cast<std::size_t>(node);
      return device.mesh.nodes[n] + simulation.state().displacement[n];
    };
    const Eigen::Vector3d now = place(tie.node) - place(tie.master);
    EXPECT_NEAR(now.norm(), tie.arm.norm(), 1e-12);
    turned = std::max(turned, (now - tie.arm).norm());
  }
  EXPECT_GT(turned, 1e-5); // sections turn
  for (const int node : under) EXPECT_NE(tied.contains(node), std::ranges::binary_search(walls, node));
}

// The faces of two walls meet at a corner that must move with both of them, or film would be compressed there
// by more the smaller its elements are.
TEST_F(Regions, FilmBetweenWideWallsConvergesInTheirCorners) {
  std::vector<double> least;
  for (const int elements : {16, 32})
    least.push_back(values(fmt::format(R"toml([film]
thickness = "1 mm"
prestretch = [3, 3.5]
material = {{ law = "neo-hookean", shear_modulus = "45 kPa", permittivity = "4e-11 F/m" }}
[honeycomb]
angle = "85 deg"
columns = [1]
wall_length = "8 mm"
wall_width = "1.2 mm"
wall_height = "1.5 mm"
wall_material = {{ youngs_modulus = "78 MPa", poisson_ratio = 0.36 }}
wall_bond = "width"
[mesh]
wall_elements = {}
[[step]]
kind = "release"
)toml",
                                       elements))
                        .at("min_principal_stress"));
  EXPECT_NEAR(least[1], least[0], 0.1 * least[0]);
}

TEST_F(Regions, ElectrodesKeepTheirGapToTheWalls) {
  const auto capacitance = [&](const std::vector<std::string>& overrides) {
    const Case one = read(test::small_honeycomb, overrides);
    const fem::Model model = build_device(one).model;
    return model.charges(model.initial_state(), false).capacitance.at(0);
  };
  const double whole = capacitance({}), height = 4.0, apex = 4 + 8 * std::sqrt(0.75); // mm, half a cell's
  const auto cell = [&](double inwards) { // of straight sides, moved inwards: perimeter 48 mm
    const double tangents = 4 * std::tan(15 * pi / 180) + 2 / std::tan(30 * pi / 180);
    return (8 + 2 * apex) * height - 48 * inwards + tangents * inwards * inwards;
  };
  EXPECT_NEAR(capacitance({"honeycomb.electrode_gap=1.5 mm"}) / whole, cell(1.5) / cell(0), 1e-9);
  EXPECT_NEAR(capacitance({"honeycomb.wall_bond=width"}) / whole, cell(0.4) / cell(0), 1e-9);
  EXPECT_NEAR(capacitance({"honeycomb.wall_bond=width", "honeycomb.electrode_gap=1.5 mm"}) / whole,
              cell(1.9) / cell(0), 1e-9);
}

// What the film pulls the plate with balances: it is held in its prestretch.
TEST_F(Regions, APlateInTheMiddleIsHeldWhereItIsDrawn) {
  const Case one = read(annulus + "[pivot]\nheight = \"1 mm\"\n");
  const Simulation simulation(one, 1);
  EXPECT_EQ(simulation.warnings(), std::vector<std::string>{});
}

const std::string manipulator = annulus + "[sectors]\nfirst = \"90 deg\"\n[drive.a]\nvoltage = \"1 kV\"\n";

// Tension T and stretched thickness h as drawn: small tilts of a plate pushed up by d.
TEST_F(Regions, APlateOnALowPivotTiltsAsTheClosedFormSays) {
  const double a = 12.7e-3, b = 68.58e-3, d = 0.05e-3, tension = 40e3 * 1e-3 * (4 - 1 / 16.0) / 4;
  const double K = 2 * pi * tension * a * a * b * b / (b * b - a * a);
  const double charge = 4e-11 * 1e6 / 0.25e-3; // eps V^2 / h
  const auto values = this->values(manipulator + "[pivot]\nheight = \"0.05 mm\"\n");
  const double tilt = std::sqrt(2.0) * charge * d * a / (std::log(b / a) * K);
  EXPECT_NEAR(values.at("tilt_x"), tilt, 0.01 * tilt);
  EXPECT_NEAR(values.at("tilt_y"), 0, 1e-6 * tilt);
  const double force = 2 * pi * tension / std::log(b / a) * d;
  EXPECT_NEAR(values.at("pivot_force"), force, 0.01 * force);
}

// Its pivot is on the axis, wherever regions put the nodes of its edge (at the nodes' mean the pin turned it
// by 9e-3).
TEST_F(Regions, APlateStandsUprightWithoutVoltage) {
  const std::string device = film + "[annulus]\ninner_radius = \"10 mm\"\nouter_radius = \"40 mm\"\n"
                                    "[mesh]\nrings = 6\n[pivot]\nheight = \"8 mm\"\n";
  const auto region = [](const char* name, int from, int to) {
    return fmt::format("[[region]]\nname = \"{}\"\nkind = \"sector\"\nfrom = \"{} deg\"\nto = \"{} deg\"\n",
                       name, from, to);
  };
  for (const std::string& regions : {std::string("[sectors]\ncount = 3\nfirst = \"20 deg\"\n"),
                                     region("a", 20, 120) + region("b", 160, 340)}) {
    const auto end =
        values(device + regions + "[[step]]\nkind = \"move\"\n[output]\nerror_estimate = false\n");
    EXPECT_NEAR(end.at("tilt_x"), 0, 1e-4);
    EXPECT_NEAR(end.at("tilt_y"), 0, 1e-4);
  }
}

// I x'' + r I x' + K x: a body alone, on film without a mass.
TEST_F(Regions, ABodysDampersActInProportionToItsMass) {
  write("case.toml", manipulator + R"(
[pivot]
height = "10 mm"
[[body]]
name = "plate"
places = ["inner"]
mass = "10 g"
inertia = "7 kg.mm^2"
damping_rate = "195 1/s"
[[step]]
kind = "move"
[[step]]
kind = "voltage"
[[step]]
kind = "harmonic"
from = "0.01 Hz"
to = "100 Hz"
points = 5
response_of = "tilt_x"
)");
  const Case one = read_case(directory / "case.toml", {"film.material.density=0 kg/m^3"});
  Simulation simulation(one, 1);
  std::vector<std::complex<double>> response;
  std::vector<double> omega;
  SimulationObserver observer;
  observer.on_analysis = [&](const Analysis& analysis, const fem::State&) {
    response = analysis.values(1);
    for (const double hertz : analysis.column(0)) omega.push_back(2 * pi * hertz);
    EXPECT_EQ(analysis.columns[1], "tilt_x_per_volt[rad/V]");
  };
  ASSERT_EQ(simulation.run(observer).ending, Ending::complete);
  ASSERT_EQ(response.size(), 5U);
  // One stiffness, from the second frequency, fits all others; mass and damping are those of the case.
  const auto per_stiffness = [&](std::size_t i) {
    return std::complex<double>(-omega[i] * omega[i], 195 * omega[i]) * 7e-6;
  };
  const std::complex<double> K =
      (response[2] * per_stiffness(2) - response[0] * per_stiffness(0)) / (response[0] - response[2]);
  EXPECT_NEAR(K.imag(), 0, 1e-6 * K.real());
  EXPECT_NEAR(K.real(), 0.0413, 0.001);
  for (std::size_t i = 0; i < 5; ++i) {
    const std::complex<double> expected = response[0] * (K + per_stiffness(0)) / (K + per_stiffness(i));
    EXPECT_LT(std::abs(response[i] - expected), 1e-6 * std::abs(response[0])) << omega[i];
  }
}

// They were valid, and without any effect: electrodes were made anew of the regions.
TEST_F(Regions, OverridesReachTheirElectrodes) {
  const std::string text = manipulator + "[pivot]\nheight = \"10 mm\"\n";
  const Case one = read(text, {"electrode[1].stray_capacitance=1 nF", "electrode.c.stray_capacitance=2 nF"});
  EXPECT_EQ(electrodes_of(one), (Names{"a", "b", "c", "d"}));
  EXPECT_EQ(one.electrodes[0].stray_capacitance, 1e-9);
  EXPECT_EQ(one.electrodes[1].stray_capacitance, 0);
  EXPECT_EQ(one.electrodes[2].stray_capacitance, 2e-9);
  for (const char* wrong : {"electrode[1].banana=1", "electrode.a.stray_capacitance=banana",
                            "electrode.a=", "electrode=", "electrode.e.stray_capacitance=1 nF"})
    EXPECT_THROW(read(text, {wrong}), CaseError) << wrong;
  const Case three = read(text, {"electrode.d.stray_capacitance=1 nF", "sectors.count=3"}); // it has no place
  EXPECT_EQ(three.electrodes.size(), 4U);
  EXPECT_THROW(build_device(three), CaseError);
}

// Differences of the solved tilts under voltages a little apart.
TEST_F(Regions, TheResponseOfATiltIsItsSlope) {
  const std::string text = manipulator + "[pivot]\nheight = \"10 mm\"\n";
  const auto tilt = [&](const char* volts) {
    return test::values_at_end(
        read(text, {fmt::format("drive.a.voltage={} V", volts), "drive.b.voltage=3 kV"}));
  };
  const auto above = tilt("4010"), below = tilt("3990");
  const Case one = read(text, {"drive.a.voltage=4 kV", "drive.b.voltage=3 kV"});
  Simulation simulation(one, 1);
  ASSERT_EQ(simulation.run({}).ending, Ending::complete);
  const Device& device = simulation.device();
  const fem::Linearisation linear(simulation.equilibrium(), simulation.state());
  const auto at_rest = fem::harmonic_response(linear, common_drive(device, simulation.state(), {0}),
                                              std::vector<double>{1e-3});
  for (const char* name : {"tilt_x", "tilt_y"}) {
    const Quantity& quantity = *response_quantity(one, name);
    const double slope =
        (response_row(one, device, simulation.state(), quantity).transpose() * at_rest[0].displacement)
            .value()
            .real();
    EXPECT_NEAR(slope, (above.at(name) - below.at(name)) / 20, 2e-4 * std::abs(slope)) << name;
  }
}

} // namespace
} // namespace dielast::cases::regions_test
