// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::test::responses_test {
namespace {

/// Planar actuators have radii and distances instead of strokes.
class Responses : public CommandTest {
 protected:
  static inline const std::string disc = R"([film]
thickness = "1 mm"
prestretch = 2
[film.material]
law = "neo-hookean"
shear_modulus = "40 kPa"
relative_permittivity = 4.7
[disc]
radius = "50 mm"
electrode_radius = "20 mm"
[mesh]
rings = 8
[drive]
voltage = "4 kV"
[output]
error_estimate = false
fields = false
[[step]]
kind = "voltage"
increments = 4
[[quantity]]
name = "r"
kind = "radius"
of = "electrode_edge"
)";

  double at_end(const std::string& voltage, const std::string& quantity,
                std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"run", "disc.toml", "-o", "static", "--set", "drive.voltage=" + voltage});
    EXPECT_EQ(dielast(more).exit_code, 0);
    return json_of("static/summary.json")["quantities"][quantity]["value"];
  }
};

// At next to no frequency a response is the slope of the quantity over the voltage, sign included.
TEST_F(Responses, OfARadiusAndADistanceAreTheirSlopes) {
  write("disc.toml", disc);
  for (const char* model : {"axisymmetric", "planar"}) {
    const std::string of_model = std::string("model=") + model;
    const double slope =
        (at_end("4.01 kV", "r", {"--set", of_model}) - at_end("3.99 kV", "r", {"--set", of_model})) / 20;
    write("small.toml",
          disc + "[[step]]\nkind = \"harmonic\"\nfrom = \"1e-4 Hz\"\nto = \"1e-3 Hz\"\npoints = 2\n"
                 "response_of = \"r\"\n");
    const Ended ended = dielast({"run", "small.toml", "-o", model, "--set", of_model});
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    const auto table = table_of(directory / model / "harmonic.csv");
    EXPECT_EQ(table.at(0).at(1), "r_per_volt[m/V]");
    EXPECT_NEAR(std::stod(table.at(1).at(1)), slope, 1e-4 * slope) << model;
    EXPECT_NEAR(std::stod(table.at(1).at(2)), 0, 1e-3) << model;
  }
}

// Small sines come from the source, which an electrode that was isolated before has again: the source stands
// at the voltage that keeps the electrode's.
TEST_F(Responses, AfterAChargeStepTheSourceStandsAtTheElectrodesVoltage) {
  std::string charged = disc;
  charged.replace(charged.find("voltage = \"4 kV\""), 16,
                  "charge = \"50 nC\"\n[circuit]\nresistance = \"1 MOhm\"");
  charged.replace(charged.find("kind = \"voltage\""), 16, "kind = \"charge\"");
  write("charged.toml",
        charged + "[[step]]\nkind = \"harmonic\"\nfrom = \"1e-4 Hz\"\nto = \"1e-3 Hz\"\npoints = 2\n");
  const Ended ended = dielast({"run", "charged.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
  const double voltage = std::stod(table_of(directory / "out/history.csv").back().at(3));
  const auto table = table_of(directory / "out/harmonic.csv");
  ASSERT_EQ(table.at(0).back(), "electrode_radius_per_squared_volt[m/V^2]");
  const double per_volt = std::stod(table.at(1).at(1));
  EXPECT_NEAR(std::stod(table.at(1).back()) * 2 * voltage, per_volt, 1e-9 * per_volt);
}

// Without mass nothing has states: the model is a gain. With mass and resonances beyond its order it is no
// model, and the exit code says so.
TEST_F(Responses, ALinearModelThatIsNoneIsToldSo) {
  write("disc.toml", disc + "[linearise]\noutput = \"r\"\nfrom = \"0.1 Hz\"\nto = \"2 Hz\"\n");
  const Ended gain = dielast({"linearise", "disc.toml", "-o", "gain"});
  EXPECT_EQ(gain.exit_code, 0) << gain.err;
  EXPECT_NE(gain.out.find("order 0"), std::string::npos) << gain.out;
  const Ended nothing = dielast({"linearise", "disc.toml", "-o", "nothing", "--set", "drive.voltage=0"});
  EXPECT_EQ(nothing.exit_code, 4) << nothing.out;
  EXPECT_NE(nothing.err.find("nothing moves"), std::string::npos) << nothing.err;
  const Ended rings =
      dielast({"linearise", "disc.toml", "-o", "rings", "--set", "film.material.density=1000 kg/m^3", "--set",
               "linearise.to=2 kHz", "--set", "linearise.order=1"});
  EXPECT_EQ(rings.exit_code, 5) << rings.out;
  EXPECT_NE(rings.err.find("does not answer as the device does"), std::string::npos) << rings.err;
  EXPECT_NE(rings.err.find("ask for a larger linearise.order"), std::string::npos) << rings.err;
}

// The rim of a disc that its electrode covers to there.
TEST_F(Responses, AQuantityThatIsHeldIsNamedWhereTheDeviceAnswers) {
  std::string covered = disc;
  covered.replace(covered.find("electrode_radius = \"20 mm\"\n"), 26, "");
  write(
      "covered.toml",
      covered +
          "[[quantity]]\nname = \"held\"\nkind = \"radius\"\nof = \"rim\"\n[chamber]\npressure = \"10 Pa\"\n"
          "[[step]]\nkind = \"pressure\"\n[[step]]\nkind = \"harmonic\"\nresponse_of = \"held\"\n"
          "from = \"1 Hz\"\nto = \"2 Hz\"\npoints = 2\n");
  const Ended ended = dielast({"run", "covered.toml", "-o", "out"});
  EXPECT_NE((ended.out + ended.err).find("held does not move, though the device does"), std::string::npos)
      << ended.out << ended.err;
}

// The first mode lies above the highest frequency: that it follows statically is 11 % off there.
TEST_F(Responses, ALinearModelHasTheModesLittleAboveItsFrequencies) {
  write("disc.toml", disc + "[linearise]\noutput = \"r\"\nfrom = \"0.1 Hz\"\nto = \"60 Hz\"\n");
  const Ended made =
      dielast({"linearise", "disc.toml", "-o", "model", "--set", "film.material.density=1000 kg/m^3"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_LT(json_of("model/linear_model.json")["largest_relative_error"], 0.01);
}

// With one state of two that take part the model is 5 % off.
TEST_F(Responses, WhatMoreStatesWouldBeWorthIsTold) {
  write("disc.toml", disc + "[linearise]\norder = 1\noutput = \"r\"\nfrom = \"0.01 Hz\"\nto = \"20 Hz\"\n");
  const Ended made = dielast({"linearise", "disc.toml", "-o", "model", "--set",
                              "film.material.branch=[{shear_modulus='30 kPa', relaxation_time='0.02 s'}, "
                              "{shear_modulus='2 kPa', relaxation_time='5 s'}]"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.out.find("order 1, largest error 4."), std::string::npos) << made.out;
  EXPECT_NE(made.out.find("with linearise.order = 2 it is 0."), std::string::npos) << made.out;
}

// A case without a section [linearise] gets the default one, and what this one asks of the case.
TEST_F(Responses, AnyCaseHasALinearModel) {
  write("disc.toml", disc + "[circuit]\nresistance = \"1 Mohm\"\n");
  const Ended run = dielast({"check", "disc.toml"});
  EXPECT_NE(run.err.find("has no effect"), std::string::npos) << run.err;
  const Ended made = dielast({"linearise", "disc.toml", "-o", "model"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.err.find("has no effect"), std::string::npos) << made.err;
  write("sheet.toml",
        disc + "[[electrode]]\nname = \"film\"\nplace = \"electrode\"\nsheet_resistance = \"1 kohm\"\n"
               "terminal = \"centre\"\n");
  const Ended refused = dielast({"linearise", "sheet.toml", "-o", "sheet"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("know of no resistance along an electrode"), std::string::npos) << refused.err;
}

// The film answers at twice the voltage's frequency. With inertia the electrode opens further by 1.7 % at 10
// Hz, and by half at 50 Hz. The end of whole periods says nothing of what was on the way: the summary does.
TEST_F(Responses, AFastMotionWithoutInertiaIsToldAndItsPeakAsWell) {
  const std::string wave =
      disc.substr(0, disc.find("[drive]")) +
      "[drive]\nvoltage = { wave = \"sine\", amplitude = "
      "\"4 kV\", frequency = \"10 Hz\" }\n[output]\nerror_estimate = false\nfields = false\n"
      "[[step]]\nkind = \"transient\"\nduration = \"0.2 s\"\nincrements = 80\n"
      "[[quantity]]\nname = \"r\"\nkind = \"radius\"\nof = \"electrode_edge\"\n";
  write("wave.toml", wave);
  const auto is_told = [](const Ended& ended) {
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    return ended.out.find("inertia left out") != std::string::npos;
  };
  EXPECT_FALSE(is_told(dielast({"run", "wave.toml", "-o", "slow"})));
  const nlohmann::json summary = json_of("slow/summary.json")["quantities"];
  EXPECT_NEAR(summary["r"]["value"], 0.02, 1e-9);
  EXPECT_NEAR(summary["r"]["peak"]["time"].get<double>() / 0.025, 1, 1e-9);
  EXPECT_FALSE(summary["min_principal_stress"].contains("peak"));
  const std::vector<std::string> fast{"--set", "drive.voltage.frequency=50 Hz", "--set",
                                      "step.transient.duration=0.04 s"};
  std::vector<std::string> asked{"run", "wave.toml", "-o", "fast"};
  asked.insert(asked.end(), fast.begin(), fast.end());
  EXPECT_TRUE(is_told(dielast(asked)));
  asked[3] = "inert";
  asked.insert(asked.end(), {"--set", "step.transient.inertia=true"});
  EXPECT_FALSE(is_told(dielast(asked)));
}

// A jump of the voltage sets every mode in motion, and nothing damps them.
TEST_F(Responses, ErrorsOfTimeStepsThatAddUpAreTold) {
  write("jump.toml",
        disc.substr(0, disc.find("[mesh]")) +
            "[mesh]\nrings = 2\n[drive]\nvoltage = \"4 kV\"\n[output]\nerror_estimate = false\nfields = "
            "false\n[[step]]\nkind = \"transient\"\nduration = \"5 ms\"\ninertia = true\nincrements = 20\n");
  const auto warnings = [&](const std::string& tolerance) {
    EXPECT_EQ(dielast({"run", "jump.toml", "-o", "jump", "--set", "film.material.density=1000", "--set",
                       "solver.time_tolerance=" + tolerance})
                  .exit_code,
              0);
    return json_of("jump/summary.json")["warnings"].dump();
  };
  EXPECT_NE(warnings("1e-2").find("time steps: their errors"), std::string::npos);
  EXPECT_EQ(warnings("1e-5").find("time steps: their errors"), std::string::npos);
}

// A row of a wave, a time step: longer ones are none, and tell nothing of what these leave out.
TEST_F(Responses, ErrorsOfTimeStepsThatAWaveSetsAreTold) {
  std::string rows;
  for (int i = 0; i <= 200; ++i)
    rows += fmt::format("{},{}\n", 0.05 * i, 20 * std::pow(std::sin(0.05 * i * 0.6), 2));
  write("wave.csv", "time_s,stress_kPa\n" + rows);
  write("wave.toml", R"([film]
thickness = "1 mm"
[film.material]
shear_modulus = "18 kPa"
permittivity = "4e-11 F/m"
[[film.material.branch]]
shear_modulus = "42 kPa"
relaxation_time = "10 s"
[patch]
mode = "biaxial"
stress_x = { wave = "file", file = "wave.csv" }
[[step]]
kind = "transient"
duration = "10 s"
increments = 10
record = "5 s"
)");
  const auto stretch = [&](const char* tolerance) {
    EXPECT_EQ(dielast({"run", "wave.toml", "-o", "out", "-q", "--set",
                       std::string("solver.time_tolerance=") + tolerance})
                  .exit_code,
              0);
    return json_of("out/summary.json")["quantities"]["stretch_x"];
  };
  const nlohmann::json coarse = stretch("1e-5"), fine = stretch("1e-9");
  const double error = coarse["value"].get<double>() - fine["value"].get<double>();
  EXPECT_GT(std::abs(error), 5e-6);
  EXPECT_GT(coarse["error_estimate"].get<double>(), std::abs(error));
}

TEST_F(Responses, ALinearModelIsOfAStableState) {
  write("square.toml", R"([film]
thickness = "0.5 mm"
[film.material]
law = "mooney-rivlin"
c1 = "18 kPa"
c2 = "4 kPa"
relative_permittivity = 4.7
density = 0
[patch]
stress_x = "230 kPa"
stress_y = "230 kPa"
[drive]
voltage = "100 V"
[[step]]
kind = "force"
increments = 20
on_instability = "follow"
[[step]]
kind = "voltage"
on_instability = "follow"
[[quantity]]
name = "ux"
kind = "displacement"
of = "right"
along = "x"
[linearise]
output = "ux"
from = "0.1 Hz"
to = "10 Hz"
)");
  const Ended ended = dielast({"linearise", "square.toml", "-o", "out"});
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_NE(ended.err.find("this one has 1 unstable mode"), std::string::npos) << ended.err;
}

TEST_F(Responses, RefuseTheRadiusOfAnArea) {
  std::string area = disc;
  area.replace(area.find("of = \"electrode_edge\""), 21, "of = \"electrode\"");
  write("area.toml", area);
  const Ended ended = dielast({"run", "area.toml", "-o", "out"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("quantity[1].of: found \"electrode\": an area has no radius"), std::string::npos)
      << ended.err;
}

TEST_F(Responses, OfADistanceInAHoneycomb) {
  const std::string height =
      "[[quantity]]\nname = \"h\"\nkind = \"distance\"\nbetween = [\"left_apex\", \"right_apex\"]\n";
  for (const std::string along : {"", "along = \"x\"\n"}) {
    write("disc.toml",
          small_honeycomb + height + along + "[output]\nerror_estimate = false\nfields = false\n");
    const double slope = (at_end("6.01 kV", "h") - at_end("5.99 kV", "h")) / 20;
    write("small.toml",
          small_honeycomb +
              "[[step]]\nkind = \"harmonic\"\nfrom = \"1e-4 Hz\"\nto = \"1e-3 Hz\"\npoints = 2\n"
              "response_of = \"h\"\n" +
              height + along + "[output]\nerror_estimate = false\n");
    const Ended ended = dielast({"run", "small.toml", "-o", "out"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    const auto table = table_of(directory / "out/harmonic.csv");
    EXPECT_NEAR(std::stod(table.at(1).at(1)), std::abs(slope), 1e-4 * std::abs(slope));
    EXPECT_NEAR(std::abs(std::stod(table.at(1).at(2))), slope < 0 ? 180 : 0, 1e-2);
  }
}

// Between nodes, too.
TEST_F(Responses, OfAPointIsItsSlope) {
  const std::string point =
      disc + "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\npoint = [\"11.3 mm\", \"4 mm\", 0]\n"
             "along = \"x\"\n";
  write("disc.toml", point);
  const std::vector<std::string> planar{"--set", "model=planar"};
  const double slope = (at_end("4.01 kV", "u", planar) - at_end("3.99 kV", "u", planar)) / 20;
  write("small.toml", point + "[[step]]\nkind = \"harmonic\"\nfrom = \"1e-4 Hz\"\nto = \"1e-3 Hz\"\n"
                              "points = 2\nresponse_of = \"u\"\n");
  const Ended ended = dielast({"run", "small.toml", "-o", "out", "--set", "model=planar"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
  EXPECT_NEAR(std::stod(table_of(directory / "out/harmonic.csv").at(1).at(1)), slope, 1e-4 * slope);
}

// Its first mode, 288 Hz, is far above 60 Hz: of the model that is asked for it is all the same.
TEST_F(Responses, LinearModelsHaveTheStatesThatTheyAreAskedFor) {
  write("slab.toml", R"(model = "planar"
[film]
thickness = "0.5 mm"
width = "10 mm"
bulk_modulus = "200 kPa"
material = { shear_modulus = "40 kPa", permittivity = "4e-11 F/m", density = 1000 }
[slab]
length = "10 mm"
height = "2 mm"
[mesh]
across = 2
[[support]]
place = "left"
fix = ["x"]
[[support]]
place = "bottom"
fix = ["y"]
[drive]
voltage = "720 V"
[circuit]
resistance = "20 MOhm"
leakage_resistance = "100 MOhm"
[[quantity]]
name = "w"
kind = "distance"
between = ["left", "right"]
along = "x"
[[step]]
kind = "voltage"
[linearise]
order = 3
output = "w"
from = "0.01 Hz"
to = "60 Hz"
)");
  const Ended ended = dielast({"linearise", "slab.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
  EXPECT_NE(ended.out.find("order 3, "), std::string::npos) << ended.out;
  const nlohmann::json model = json_of("out/linear_model.json");
  EXPECT_NEAR(model["operating_source_voltage_V"], 720, 1e-9);
  EXPECT_NEAR(model["operating_voltage_V"], 600, 1e-9);
}

} // namespace
} // namespace dielast::test::responses_test
