// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/film_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases::drives_test {
namespace {

/// Two electrodes on cells of a honeycomb, cut free and driven by 3 kV each.
const std::string two_electrodes = R"(
[film]
thickness = "1 mm"
prestretch = [4.0, 2.5]
[film.material]
shear_modulus = "45 kPa"
permittivity = "4e-11 F/m"
[honeycomb]
angle = "150 deg"
columns = [2, 1, 2]
wall_length = "8 mm"
wall_width = "0.8 mm"
wall_height = "2 mm"
[mesh]
wall_elements = 3
[[electrode]]
name = "a"
place = "cell[0,0]"
[[electrode]]
name = "b"
place = "cell[2,0]"
[drive.a]
voltage = "3 kV"
[drive.b]
voltage = "3 kV"
[[step]]
kind = "release"
[[step]]
kind = "voltage"
[[quantity]]
name = "u"
kind = "displacement"
of = "top"
along = "y"
)";

class Drives : public test::ScratchTest {
 protected:
  struct Row {
    post::StepRecord record;
    std::vector<double> values;
  };

  /// Runs a case; rows are those of its history.
  Outcome run(const std::string& text, const std::vector<std::string>& overrides = {}) {
    write("case.toml", text);
    one = read_case(directory / "case.toml", overrides);
    rows.clear(), analyses.clear(), warnings.clear();
    Simulation simulation(one, 1);
    warnings = simulation.warnings();
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      rows.push_back({frame.record, frame.values});
      return true;
    };
    observer.on_analysis = [&](const Analysis& analysis, const fem::State&) { analyses.push_back(analysis); };
    return simulation.run(observer);
  }
  double value(const Row& row, const std::string& name) const {
    const auto found = std::ranges::find(one.quantities, name, &Quantity::name);
    return row.values.at(static_cast<std::size_t>(found - one.quantities.begin()));
  }
  double last(const std::string& name) const { return value(rows.back(), name); }
  /// Voltages of the rows.
  std::vector<double> voltages() const {
    std::vector<double> all;
    for (const Row& row : rows) all.push_back(row.record.voltages.at(0));
    return all;
  }

  Case one;
  std::vector<Row> rows;
  std::vector<Analysis> analyses;
  std::vector<std::string> warnings;
};

// "A bias with a step on it": the ramp leads to the bias, the transient begins with the jump.
TEST_F(Drives, ARampLeadsToTheSideOfAJumpBeforeTheTransient) {
  const std::string steps = "\n[[step]]\nkind = \"voltage\"\nincrements = 2\n"
                            "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\nincrements = 2\n";
  for (const char* wave : {"wave = \"step\", from = 2000, to = 3000",
                           "wave = \"square\", from = 2000, to = 3000, frequency = 0.1",
                           "wave = \"trapezoid\", from = 2000, to = 3000, hold = 100",
                           "wave = \"trapezoid\", from = 2000, to = 3000, hold = 50, period = 100"}) {
    ASSERT_EQ(run(branched_patch + "[drive]\nvoltage = { " + wave + " }" + steps).ending, Ending::complete);
    EXPECT_EQ(voltages(), (std::vector<double>{0, 1000, 2000, 3000, 3000, 3000})) << wave;
    EXPECT_TRUE(rows[3].record.jumped);
    EXPECT_EQ(rows[3].record.time, 0);
    // at once both springs answer, later the branch gives way
    EXPECT_GT(value(rows[3], "stretch_x"), value(rows[2], "stretch_x"));
    EXPECT_GT(last("stretch_x"), value(rows[3], "stretch_x"));
  }
  // where a wave does not jump, the ramp leads to its value at 0
  write("table.csv", "time_s,voltage_V\n0,2000\n1,3000\n");
  for (const char* wave : {"wave = \"ramp\", from = 2000, to = 3000, duration = 1",
                           "wave = \"sine\", mean = 2000, amplitude = 0, frequency = 0.1",
                           "wave = \"unipolar sine\", from = 2000, amplitude = 1000, frequency = 0.1",
                           "wave = \"file\", file = \"table.csv\""}) {
    ASSERT_EQ(run(branched_patch + "[drive]\nvoltage = { " + wave + " }" + steps).ending, Ending::complete);
    EXPECT_EQ(rows.at(2).record.voltages.at(0), 2000) << wave;
    EXPECT_EQ(rows.size(), 5u) << wave;
  }
}

// Neo-Hookean springs at both sides of the jump: closed form, mu (l^2 - l^-4) = eps (Phi/H)^2 l^4.
TEST_F(Drives, AJumpActsAtOnceAtItsTimeAndIsLabelled) {
  ASSERT_EQ(run(branched_patch + "[drive]\nvoltage = { wave = \"step\", to = 3000, at = 0.3 }\n"
                                 "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\nincrements = 10\n")
                .ending,
            Ending::complete);
  std::vector<Row> at_jump;
  for (const Row& row : rows)
    if (std::abs(row.record.time - 0.3) < 1e-12) at_jump.push_back(row);
  ASSERT_EQ(at_jump.size(), 2u);
  EXPECT_EQ(at_jump[0].record.voltages[0], 0);
  EXPECT_FALSE(at_jump[0].record.jumped);
  EXPECT_EQ(at_jump[1].record.voltages[0], 3000);
  EXPECT_TRUE(at_jump[1].record.jumped);
  EXPECT_NEAR(value(at_jump[0], "stretch_x"), 1, 1e-12);
  const double l = value(at_jump[1], "stretch_x"), field = 4e-11 * 9e12;
  EXPECT_NEAR(80e3 * (l * l - std::pow(l, -4)), field * std::pow(l, 4), 1e-6 * field);
}

TEST_F(Drives, AWaveThatOnlyTurnsGivesNoSecondRow) {
  write("table.csv", "time_s,voltage_V\n0,0\n0.3,1000\n0.5,3000\n0.7,0\n1,500\n");
  ASSERT_EQ(run(branched_patch + "[drive]\nvoltage = \"table.csv\"\n"
                                 "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\nincrements = 10\n")
                .ending,
            Ending::complete);
  EXPECT_EQ(rows.size(), 11u);
  for (std::size_t r = 1; r < rows.size(); ++r) {
    EXPECT_GT(rows[r].record.time, rows[r - 1].record.time + 1e-6);
    EXPECT_FALSE(rows[r].record.jumped);
  }
}

TEST_F(Drives, OfEitherSignActAlike) {
  const std::string steps = "\n[[step]]\nkind = \"voltage\"\nincrements = 2\n";
  std::vector<double> found;
  for (const char* drive : {"\"5 kV\"", "\"-5 kV\"", "{ wave = \"constant\", to = \"-5 kV\" }"}) {
    ASSERT_EQ(run(branched_patch + "[drive]\nvoltage = " + drive + steps).ending, Ending::complete);
    found.push_back(last("stretch_x"));
    EXPECT_EQ(std::abs(rows.back().record.largest_voltage()), 5000);
    EXPECT_NEAR(last("max_field"), 5e6 * last("stretch_x") * last("stretch_x"), 1);
  }
  EXPECT_GT(found[0], 1.001);
  EXPECT_NEAR(found[1], found[0], 1e-12);
  EXPECT_NEAR(found[2], found[0], 1e-12);
}

// Slopes of the static response, which central differences of single drives have confirmed.
TEST_F(Drives, AHarmonicStepSaysWhoseSourcesSwingAndByDefaultAllDo) {
  const auto per_volt = [&](const std::string& driven) {
    EXPECT_EQ(run(two_electrodes + "[[step]]\nkind = \"harmonic\"\npoints = 2\n" + driven).ending,
              Ending::complete);
    EXPECT_EQ(analyses.at(0).columns[1], "u_per_volt[m/V]");
    return analyses.at(0).rows.at(0).at(1);
  };
  const double a = per_volt("driven = [\"a\"]\n");
  EXPECT_EQ(analyses[0].driven, std::vector<std::string>{"a"});
  EXPECT_EQ(analyses[0].columns[3], "voltage_a_per_volt[V/V]");
  const double b = per_volt("driven = [\"b\"]\n"), both = per_volt("");
  EXPECT_EQ(analyses[0].driven, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(analyses[0].columns.size(), 12u);
  EXPECT_EQ(analyses[0].columns.back(), "u_per_squared_volt[m/V^2]"); // both sources are at one voltage
  EXPECT_NEAR(a, 7.2743e-8, 1e-12);                                   // its centre of mass stands
  EXPECT_NEAR(b, 7.2783e-8, 1e-12);
  EXPECT_NEAR(both, a + b, 1e-6 * both);
  EXPECT_NEAR(both, 1.45525e-7, 1e-11);
}

TEST_F(Drives, AnIsolatedElectrodeHasNoSourceToSwing) {
  const Outcome outcome =
      run(two_electrodes, {"drive.a={charge='1 nC'}", "drive.b={charge='1 nC'}",
                           "step=[{kind='release'}, {kind='charge'}, {kind='harmonic', points=2}]"});
  EXPECT_EQ(outcome.ending, Ending::gave_up);
  EXPECT_NE(outcome.message.find("\"a\" is isolated"), std::string::npos) << outcome.message;
}

TEST_F(Drives, ModesHoldVoltagesOrChargesWhateverTheStepBeforeHeld) {
  const auto hertz = [&](const std::string& drive, const std::string& step) {
    run(drive + R"(
annulus = { inner_radius = "12.7 mm", outer_radius = "68.58 mm" }
plate = { mass = "100 g" }
film = { thickness = "1 mm", prestretch = 2, material = { shear_modulus = "40 kPa", permittivity = "4e-11 F/m" } }
step = [{ kind = "weight" }, { kind = ")" +
        step + R"(" }, { kind = "modes" }, { kind = "modes", name = "cut", control = "charge" }])");
    return std::pair(analyses.at(0).rows.at(0).at(1), analyses.at(1).rows.at(0).at(1));
  };
  const auto [connected, isolated] = hertz("drive.voltage = '4 kV'", "voltage");
  const auto charged = hertz(fmt::format("drive.charge = {}", 4e3 * last("capacitance")), "charge");
  EXPECT_GT(isolated, 1.001 * connected);
  EXPECT_NEAR(charged.first, connected, 1e-6 * connected);
  EXPECT_NEAR(charged.second, isolated, 1e-6 * isolated);
}

// What harmonic steps refuse, modes, stiffness and natural frequency do not answer either.
TEST_F(Drives, NoTangentIsToldWhereDashpotsFlow) {
  const std::string diaphragm = R"(
[film]
thickness = "1 mm"
prestretch = 2.0
[film.material]
shear_modulus = "40 kPa"
relative_permittivity = 4.7
[[film.material.branch]]
shear_modulus = "20 kPa"
relaxation_time = "10 s"
[annulus]
inner_radius = "12.7 mm"
outer_radius = "68.58 mm"
[mesh]
rings = 8
[plate]
mass = "100 g"
[drive]
voltage = "3 kV"
[[step]]
kind = "weight"
)";
  ASSERT_EQ(run(diaphragm + "[[step]]\nkind = \"modes\"\n").ending, Ending::complete);
  EXPECT_GT(last("stiffness"), 0);
  EXPECT_GT(last("natural_frequency"), 0);
  const std::string at_once = "response = \"instantaneous\"\n[[step]]\nkind = ";
  for (const char* analysis : {"\"modes\"\n", "\"harmonic\"\npoints = 2\n"}) {
    const Outcome outcome = run(diaphragm + at_once + analysis);
    EXPECT_EQ(outcome.ending, Ending::gave_up) << analysis;
    EXPECT_NE(outcome.message.find("dashpots flow"), std::string::npos) << outcome.message;
    EXPECT_TRUE(std::isnan(last("stiffness")));
    EXPECT_TRUE(std::isnan(last("natural_frequency")));
  }
}

// A swinging plate is out of balance or has a velocity, at any moment: no small vibration goes about it.
TEST_F(Drives, WhatMovesHasNeitherStiffnessNorModes) {
  const std::string swings = R"(
model = "axisymmetric"
annulus = { inner_radius = "12.7 mm", outer_radius = "68.58 mm" }
mesh = { rings = 8 }
plate = { mass = "100 g", damping = "2 N.s/m" }
drive.voltage = { wave = "ramp", to = "3 kV", duration = 0.02 }
solver.time_tolerance = 1e-4
film = { thickness = "1 mm", prestretch = 2, material = { shear_modulus = "40 kPa", permittivity = "4e-11 F/m" } }
step = [{ kind = "weight" }, { kind = "transient", duration = 1, increments = 20 }, { kind = "modes" }]
)";
  for (const char* duration : {"0.05", "0.1", "0.23"})
    for (const char* analysis : {"modes'", "harmonic', points = 2"}) {
      const Outcome outcome = run(
          swings, {fmt::format("step=[{{kind='weight'}}, {{kind='transient', duration={}, increments=20}}, "
                               "{{kind='{}}}]",
                               duration, analysis)});
      EXPECT_EQ(outcome.ending, Ending::gave_up) << duration;
      EXPECT_NE(outcome.message.find("the device moves"), std::string::npos) << outcome.message;
      EXPECT_TRUE(std::isnan(last("stiffness")));
      EXPECT_TRUE(std::isnan(last("natural_frequency")));
    }
  EXPECT_EQ(run(swings).ending, Ending::complete);
  EXPECT_GT(last("stiffness"), 0);
  EXPECT_GT(last("natural_frequency"), 0);
}

// 2 ms after the voltage the middle of the electrode has hardly any, after 10 s all of it.
TEST_F(Drives, WhileCurrentFlowsAlongAnElectrodeThereAreNoModes) {
  const std::string resists = R"(
disc = { radius = "30 mm", electrode_radius = "15 mm" }
mesh = { rings = 4 }
drive.voltage = { wave = "step", to = "2 kV", at = 0 }
[film]
thickness = "1 mm"
prestretch = 2
material = { shear_modulus = "40 kPa", permittivity = "4e-11 F/m", density = "1000 kg/m^3" }
[[electrode]]
name = "film"
place = "electrode"
sheet_resistance = "1 GOhm"
terminal = "electrode_edge"
[[step]]
kind = "transient"
inertia = false
increments = 10
duration = )";
  const std::string modes = "\n[[step]]\nkind = \"modes\"\n";
  const Outcome outcome = run(resists + "2e-3" + modes);
  EXPECT_EQ(outcome.ending, Ending::gave_up);
  EXPECT_NE(outcome.message.find("current flows along an electrode"), std::string::npos) << outcome.message;
  EXPECT_EQ(run(resists + "10" + modes).ending, Ending::complete);
}

// 1 + c (l1 + l2 - 2) reaches 0 at the stretch 2: no state beyond is accepted, whatever leads there.
TEST_F(Drives, APermittivityBelowZeroIsRefusedByName) {
  const std::string electrostrictive = R"(
[film]
thickness = "1 mm"
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
electrostriction = -0.5
[patch]
stretch_x = 3
stretch_y = 3
[drive]
voltage = "1 kV"
[[step]]
kind = "voltage"
increments = 1
[[step]]
kind = "move"
increments = 37
)";
  const Outcome outcome = run(electrostrictive);
  EXPECT_EQ(outcome.ending, Ending::gave_up);
  EXPECT_EQ(outcome.kind, "loss of permittivity");
  EXPECT_NE(outcome.message.find("electrostriction = -0.5"), std::string::npos) << outcome.message;
  EXPECT_LT(last("stretch_x"), 2);
  EXPECT_GT(last("stretch_x"), 1.9);
  EXPECT_GT(last("capacitance"), 0);
  const Outcome huge = run(
      electrostrictive, {"film.material.electrostriction=1e6", "patch.stretch_x=0.9", "patch.stretch_y=0.9"});
  EXPECT_EQ(huge.kind, "loss of permittivity") << huge.message;
  for (const Row& row : rows) EXPECT_GT(value(row, "capacitance"), 0);
}

class OwnMesh : public Drives {
 protected:
  /// A unit square of two triangles whose sides are named.
  void SetUp() override {
    Drives::SetUp();
    write("square.msh",
          "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"frame\"\n2 2 \"film\"\n2 3 "
          "\"half\"\n$EndPhysicalNames\n$Nodes\n5\n1 0 0 0\n2 60 0 0\n3 60 60 0\n4 0 60 0\n5 20 30 "
          "0\n$EndNodes\n$Elements\n10\n1 1 2 1 1 1 2\n2 1 2 1 2 2 3\n3 1 2 1 3 3 4\n4 1 2 1 4 4 1\n"
          "5 2 2 2 5 1 2 5\n6 2 2 2 5 2 3 5\n7 2 2 2 6 3 4 5\n8 2 2 2 6 4 1 5\n"
          "9 2 2 3 6 3 4 5\n10 2 2 3 6 4 1 5\n$EndElements\n");
  }
  const std::string text =
      "[film]\nmaterial = \"VHB 4910 (honeycomb)\"\nthickness = \"1 mm\"\nprestretch = 2\n"
      "[drive]\nvoltage = \"1 kV\"\n[[step]]\nkind = \"voltage\"\nincrements = 1\n"
      "[mesh]\nfile = \"square.msh\"\n";
  const std::string held = "[[support]]\nplace = \"frame\"\nfix = [\"x\", \"y\"]\n";
  bool told(const std::string& part) const {
    return std::ranges::any_of(warnings,
                               [&](const std::string& w) { return w.find(part) != std::string::npos; });
  }
};

TEST_F(OwnMesh, WithoutAUnitSaysHowLargeTheFilmIs) {
  ASSERT_EQ(run(text + held).ending, Ending::complete);
  EXPECT_TRUE(told("mesh.unit is missing")) << testing::PrintToString(warnings);
  EXPECT_TRUE(told("60.00 m x 60.00 m")) << testing::PrintToString(warnings);
  ASSERT_EQ(run(text + "unit = \"1 mm\"\n" + held).ending, Ending::complete);
  EXPECT_EQ(warnings, std::vector<std::string>{});
  ASSERT_EQ(run(text + "unit = \"1 m\"\nquadrature = 6\n" + held).ending, Ending::complete);
  EXPECT_TRUE(told("the film is 60.00 m x 60.00 m")) << testing::PrintToString(warnings);
  EXPECT_TRUE(told("the file's triangles have 3 nodes")) << testing::PrintToString(warnings);
}

TEST_F(OwnMesh, OfOnePartOfSeveralSaysHowLargeItIsAndThatItIsCut) {
  write("cut.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"frame\"\n2 2 \"film\"\n"
                   "$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 60 0 0\n3 60 60 0\n4 0 60 0\n5 60 60 0\n"
                   "6 0 0 0\n$EndNodes\n$Elements\n6\n1 1 2 1 1 1 2\n2 1 2 1 2 2 3\n3 1 2 1 3 5 4\n"
                   "4 1 2 1 4 4 6\n5 2 2 2 5 1 2 3\n6 2 2 2 6 5 4 6\n$EndElements\n");
  const std::string film = "material = \"VHB 4910 (honeycomb)\"\nthickness = \"1 mm\"\nprestretch = 2\n";
  run("[part.a.film]\n" + film + "[part.a.mesh]\nfile = \"cut.msh\"\n[part.b.film]\n" + film +
      "[part.b.rectangle]\nlength = \"1 mm\"\nwidth = \"1 mm\"\n[part.b.mesh]\norder = 1\n[drive.a]\n"
      "voltage = \"1 kV\"\n[[support]]\nplace = \"a.frame\"\nfix = [\"x\", \"y\"]\n[[support]]\n"
      "place = \"b\"\nfix = [\"x\", \"y\"]\n");
  EXPECT_TRUE(told("part.a.mesh.unit is missing")) << testing::PrintToString(warnings);
  EXPECT_TRUE(told("part.a.mesh: the film is cut: 2")) << testing::PrintToString(warnings);
  EXPECT_FALSE(told("part.b.mesh"));
}

TEST_F(OwnMesh, ThatNothingHoldsSaysThatItIsCutFree) {
  run(text + "unit = \"1 mm\"\n");
  EXPECT_TRUE(told("\"settle\"")) << testing::PrintToString(warnings);
  EXPECT_TRUE(told("there is no [[support]]")) << testing::PrintToString(warnings);
}

// Files of version 2.2 hold a triangle once for each of its physical groups.
TEST_F(OwnMesh, TrianglesOfTwoPhysicalGroupsCountOnce) {
  write("case.toml", text + "unit = \"1 mm\"\n" + held);
  const Device device = build_device(read_case(directory / "case.toml"));
  EXPECT_EQ(device.mesh.film()->size(), 4);
  EXPECT_EQ(device.mesh.cell_sets.at("film").cells.size(), 4u);
  EXPECT_EQ(device.mesh.cell_sets.at("half").cells.size(), 2u);
}

} // namespace
} // namespace dielast::cases::drives_test
