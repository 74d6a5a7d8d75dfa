// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <cmath>
#include <optional>
#include <regex>

namespace dielast::test::events_test {
namespace {

class Events : public CommandTest {
 protected:
  /// Events of the honeycomb with these overrides.
  nlohmann::json events(std::vector<std::string> overrides) {
    std::vector<std::string> words{"run", "small.toml", "-o", "out", "-q"};
    overrides.insert(overrides.end(), {"output.error_estimate=false", "output.fields=false"});
    for (const std::string& assignment : overrides) words.insert(words.end(), {"--set", assignment});
    exit_code = dielast(words).exit_code;
    return json_of("out/summary.json")["events"];
  }
  static std::optional<nlohmann::json> of_kind(const nlohmann::json& events, const std::string& kind) {
    for (const auto& event : events)
      if (event["kind"] == kind) return event;
    return std::nullopt;
  }
  /// Of a case that is only released.
  std::optional<nlohmann::json> contact_on_release(const std::string& angle) {
    const auto all = events({"honeycomb.angle=" + angle, "mesh.wall_elements=4", "step=[{kind='release'}]"});
    EXPECT_EQ(exit_code, 0) << angle;
    return of_kind(all, "wall contact");
  }

  int exit_code = -1;
};

// The whole actuator opens its cells below 77 deg; these few cells do so a little above.
TEST_F(Events, WallsTouchOnReleaseOfNearlyClosedCells) {
  for (const char* angle : {"65 deg", "70 deg", "75 deg"}) {
    const auto contact = contact_on_release(angle);
    ASSERT_TRUE(contact) << angle;
    EXPECT_EQ((*contact)["step"], "release");
    EXPECT_TRUE(std::regex_match((*contact)["place"].get<std::string>(),
                                 std::regex(R"((cell\[\d+,\d+\]|wall\[\d+\]).*)")))
        << (*contact)["place"];
    EXPECT_NE((*contact)["message"].get<std::string>().find("the walls are 800.0 µm wide"), std::string::npos)
        << (*contact)["message"];
  }
  for (const char* angle : {"85 deg", "90 deg", "120 deg", "150 deg"})
    EXPECT_FALSE(contact_on_release(angle)) << angle;
}

// Nothing stretches a Gent film beyond its limit, whatever the step may do at instabilities.
TEST_F(Events, FilmAtTheLimitOfItsLawIsNoLimitPoint) {
  for (const char* law :
       {"law = \"gent\"\nstretch_limit = 5", "law = \"arruda-boyce\"\nlocking_stretch = 1.6"})
    for (const char* then : {"stop", "jump"}) {
      write("locks.toml",
            std::string("[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\n"
                        "permittivity = \"4e-11 F/m\"\n") +
                law + "\n[patch]\nstretch_x = 4\n[[step]]\nkind = \"move\"\non_instability = \"" + then +
                "\"\n[output]\nerror_estimate = false\nfields = false\n");
      EXPECT_EQ(dielast({"run", "locks.toml", "-o", "out", "-q"}).exit_code, 4);
      const auto all = json_of("out/summary.json")["events"];
      ASSERT_TRUE(of_kind(all, "stretch limit")) << law << all.dump(1);
      EXPECT_FALSE(of_kind(all, "limit point")) << law << all.dump(1);
      EXPECT_NE((*of_kind(all, "stretch limit"))["message"].get<std::string>().find("the limit of its law"),
                std::string::npos);
    }
}

// Newton's method that is not let go on finds nothing, but no stiffness vanishes there.
TEST_F(Events, TooFewIterationsAreNoCriticalPoint) {
  for (const char* most : {"1", "2", "3"}) {
    const auto all = events({std::string("solver.max_iterations=") + most, "solver.smallest_increment=1"});
    EXPECT_EQ(exit_code, 4) << most;
    EXPECT_FALSE(of_kind(all, "limit point")) << most << all.dump(1);
    EXPECT_FALSE(of_kind(all, "bifurcation")) << most << all.dump(1);
    EXPECT_TRUE(of_kind(all, "no equilibrium")) << most << all.dump(1);
  }
}

// Free across: what stress there is across is rounding of the 100 MPa.
TEST_F(Events, RoundingIsNoLossOfTension) {
  write("stiff.toml",
        "[film]\nthickness = \"20 um\"\n[film.material]\nshear_modulus = \"100 MPa\"\npermittivity = "
        "\"1e-10 F/m\"\n[patch]\nstress_x = \"40 MPa\"\n[drive]\nvoltage = \"1 kV\"\n"
        "[output]\nerror_estimate = false\nfields = false\n");
  EXPECT_EQ(dielast({"run", "stiff.toml", "-o", "out", "-q"}).exit_code, 0);
  const nlohmann::json summary = json_of("out/summary.json");
  EXPECT_TRUE(summary["events"].empty()) << summary["events"].dump();
  EXPECT_TRUE(summary["margins"]["loss of tension"]["factor"].is_null()) << summary["margins"].dump();
}

TEST_F(Events, LossOfTensionAndBreakdownAreToldOnceWithTheirPlace) {
  // both before the limit point: breakdown of a thin film, loss of tension of one that was stretched little
  for (const auto& [prestretch, kind] : {std::pair{"4.5", "breakdown"}, {"2", "loss of tension"}}) {
    const auto all = events(
        {std::string("film.prestretch=") + prestretch, "drive.voltage=20 kV", "step.voltage.increments=20"});
    EXPECT_EQ(exit_code, 4);
    const auto event = of_kind(all, kind);
    ASSERT_TRUE(event) << kind << all.dump(1);
    EXPECT_EQ((*event)["step"], "voltage");
    EXPECT_GT((*event)["voltages"][0].get<double>(), 0);
    EXPECT_FALSE((*event)["place"].get<std::string>().empty());
    EXPECT_EQ(count(all.dump(), std::string("\"kind\":\"") + kind + '"'), 1u);
  }
}

// The film of a diaphragm is thinnest beside its plate.
TEST_F(Events, ThoseOfFilmWithoutCellsSayWhereItIsDrawn) {
  write("ring.toml",
        "[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nshear_modulus = \"40 kPa\"\n"
        "relative_permittivity = 4.7\nbreakdown_field = \"10 MV/m\"\n[annulus]\ninner_radius = \"10 mm\"\n"
        "outer_radius = \"70 mm\"\n[plate]\nmass = \"100 g\"\n[drive]\nvoltage = \"3 kV\"\n[output]\n"
        "error_estimate = false\nfields = false\n");
  EXPECT_EQ(dielast({"run", "ring.toml", "-o", "out", "-q"}).exit_code, 0);
  const auto event = of_kind(json_of("out/summary.json")["events"], "breakdown");
  ASSERT_TRUE(event);
  EXPECT_TRUE(std::regex_match((*event)["place"].get<std::string>(),
                               std::regex(R"(the element drawn about x = 10\.\d* mm)")))
      << (*event)["place"];
}

// Of a sine of 1 Hz about 5 kV, once between two rows.
TEST_F(Events, ThoseBetweenTwoRowsAreToldWithTheirOwnTime) {
  write(
      "wave.toml",
      "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"50 kPa\"\npermittivity = \"4e-11 "
      "F/m\"\nbreakdown_field = \"7.8 MV/m\"\n[patch]\nmode = \"equal-biaxial\"\n[drive]\nvoltage = { wave = "
      "\"sine\", mean = \"5 kV\", amplitude = \"3 kV\", frequency = \"1 Hz\" }\n[output]\nerror_estimate = "
      "false\nfields = false\n[[step]]\nkind = \"transient\"\nduration = \"1 s\"\nrecord = \"0.5 s\"\n");
  const Ended ended = dielast({"run", "wave.toml", "-o", "out"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("1.01 times the breakdown field (from about 175.1 ms on)"), std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("peak 8.144 MV/m at 250.0 ms"), std::string::npos) << ended.out;
  const nlohmann::json event = json_of("out/summary.json")["events"].at(0);
  EXPECT_NEAR(event["time"], 0.17505, 1e-5);
  EXPECT_NEAR(event["load_factor"], 0.17505, 1e-5);
  EXPECT_NEAR(event["voltages"].at(0), 7673.46, 0.02); // closed form, see BetweenRows
  EXPECT_EQ(event["record"], 2);                       // behind the drawn state and the jump
}

// Of revolution, or in space, film leaves its surface where its tension ends; a patch that is free of stress
// has none to lose.
TEST_F(Events, APathThatEndsForWantOfTensionSaysSo) {
  const std::string film = "[film]\nthickness = \"1 mm\"\nprestretch = 1.2\n[film.material]\nshear_modulus = "
                           "\"50 kPa\"\npermittivity = \"4e-11 F/m\"\n";
  const std::string rest = "[drive]\nvoltage = \"40 kV\"\n[output]\nerror_estimate = false\nfields = false\n"
                           "[[step]]\nkind = \"voltage\"\nincrements = 20\n";
  write("held.toml", "model = \"axisymmetric\"\n" + film +
                         "[disc]\nradius = \"50 mm\"\nelectrode_radius = \"48 mm\"\n[mesh]\nrings = 10\n" +
                         rest);
  EXPECT_EQ(dielast({"run", "held.toml", "-o", "out", "-q"}).exit_code, 4);
  const auto lost = of_kind(json_of("out/summary.json")["events"], "loss of tension");
  ASSERT_TRUE(lost);
  EXPECT_NE((*lost)["message"].get<std::string>().find("no tension left"), std::string::npos) << *lost;
  EXPECT_NEAR((*lost)["voltages"].at(0), 24133, 10); // that of a planar disc is 24.133 kV
  write("free.toml", film + "[patch]\nmode = \"equal-biaxial\"\n" + rest);
  EXPECT_EQ(dielast({"run", "free.toml", "-o", "out", "-q"}).exit_code, 4);
  const auto all = json_of("out/summary.json")["events"];
  EXPECT_TRUE(of_kind(all, "limit point")) << all;
  EXPECT_FALSE(of_kind(all, "loss of tension")) << all;
}

// What wrinkles has a thousandth of a percent of its energy left, which a push would find.
TEST_F(Events, FilmThatWrinklesBearsNoPush) {
  for (const auto& [stress, is_told] : {std::pair{"-1 kPa", true}, {"1 kPa", false}}) {
    write("pushed.toml",
          std::string("[film]\nthickness = \"1 mm\"\nwrinkling = \"tension field\"\n"
                      "[film.material]\nshear_modulus = \"50 kPa\"\npermittivity = \"4e-11 F/m\"\n"
                      "[patch]\nstress_x = \"") +
              stress + "\"\n[output]\nerror_estimate = false\nfields = false\n[[step]]\nkind = \"force\"\n");
    EXPECT_EQ(dielast({"run", "pushed.toml", "-o", "out", "-q"}).exit_code, 0);
    EXPECT_EQ(of_kind(json_of("out/summary.json")["events"], "pushed film").has_value(), is_told) << stress;
  }
}

// Branches that have had all the time they need carry nothing: film with them passes its breakdown field
// where film without does.
TEST_F(Events, ThoseOfRelaxedBranchesAreFoundInStatesOfTheirOwn) {
  const auto voltage = [this](const char* branch) {
    write("relaxed.toml",
          std::string("[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"50 kPa\"\n"
                      "permittivity = \"4e-11 F/m\"\nbreakdown_field = \"7.8 MV/m\"\n") +
              branch +
              "[patch]\nmode = \"equal-biaxial\"\n[drive]\nvoltage = \"8 kV\"\n[output]\nerror_estimate = "
              "false\nfields = false\n[[step]]\nkind = \"voltage\"\nincrements = 2\n");
    EXPECT_EQ(dielast({"run", "relaxed.toml", "-o", "out", "-q"}).exit_code, 0);
    return json_of("out/summary.json")["events"].at(0)["voltages"].at(0).get<double>();
  };
  EXPECT_NEAR(voltage(""), 7673.46, 0.02);
  EXPECT_NEAR(voltage("[[film.material.branch]]\nshear_modulus = \"30 kPa\"\nrelaxation_time = \"1 s\"\n"),
              7673.46, 0.02);
}

// Film charged to 500 V and let go by its source is compressed by the root of 5 MV/m over 6 MV/m, which moves
// its edges by 2 mm at a stretch of 0.8.
TEST_F(Events, ThoseOfIsolatedFilmAreToldAtItsOwnVoltage) {
  const double stretch = std::sqrt(5.0 / 6), share = (1 - stretch) / 0.2;
  const auto move = [](const std::string& by, const std::string& step) {
    return "[[support]]\nplace = \"right\"\ndisplacement = { x = " + by +
           " }\n[[support]]\nplace = \"top\"\ndisplacement = { y = " + by +
           " }\n[[step]]\nkind = \"voltage\"\n" +
           "to = \"500 V\"\n[[step]]\nname = \"move\"\ncontrol = \"charge\"\nincrements = 3\n" + step;
  };
  for (const std::string& moved : {move("\"-2 mm\"", "kind = \"move\"\n"),
                                   move("{ wave = \"ramp\", to = \"-2 mm\", duration = \"1 s\" }",
                                        "kind = \"transient\"\nduration = \"1 s\"\n")}) {
    write(
        "isolated.toml",
        "[film]\nthickness = \"0.1 mm\"\n[film.material]\nshear_modulus = \"100 kPa\"\nrelative_permittivity "
        "= 4\nbreakdown_field = \"6 MV/m\"\n[patch]\nmode = \"equal-biaxial\"\nlength = \"10 mm\"\n"
        "[output]\nerror_estimate = false\nfields = false\n" +
            moved);
    const Ended ended = dielast({"run", "isolated.toml", "-o", "out", "-q"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const auto event = of_kind(json_of("out/summary.json")["events"], "breakdown");
    ASSERT_TRUE(event);
    EXPECT_NEAR((*event)["load_factor"], share, 1e-6);
    EXPECT_NEAR((*event)["voltages"].at(0), 500 * std::pow(stretch, -4), 1e-2);
  }
}

// In a single increment, and still at the voltages of their margins, which are solved for.
TEST_F(Events, ThoseBetweenTwoStatesAreWhereTheirMarginsAre) {
  write("disc.toml",
        "[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nshear_modulus = \"40 kPa\"\n"
        "relative_permittivity = 4.7\nbreakdown_field = \"35 MV/m\"\n[disc]\nradius = \"40 mm\"\n"
        "electrode_radius = \"20 mm\"\n[mesh]\nrings = 8\n[drive]\nvoltage = \"9 kV\"\n[[step]]\n"
        "kind = \"voltage\"\nincrements = 1\n[output]\nerror_estimate = false\nfields = false\n");
  EXPECT_EQ(dielast({"run", "disc.toml", "-o", "out", "-q"}).exit_code, 0);
  const nlohmann::json summary = json_of("out/summary.json");
  const auto event = of_kind(summary["events"], "breakdown");
  ASSERT_TRUE(event) << summary["events"].dump(1);
  EXPECT_LT((*event)["load_factor"], 0.95);
  EXPECT_NEAR((*event)["load_factor"].get<double>(), summary["margins"]["breakdown"]["factor"].get<double>(),
              2e-6);
}

TEST_F(Events, NoneAtTheUsualVoltage) { EXPECT_EQ(events({}), nlohmann::json::array()); }

// The voltage goes back to 0: what the field was on the way, and how well it is known, is that of its peak.
TEST_F(Events, ThoseOnTheWayDependOnTheMeshAsThoseAtTheEnd) {
  write("back.toml", R"(model = "axisymmetric"
[film]
thickness = "1 mm"
prestretch = 2.0
[film.material]
shear_modulus = "40 kPa"
relative_permittivity = 4.7
breakdown_field = "21.1 MV/m"
[annulus]
inner_radius = "12.7 mm"
outer_radius = "68.58 mm"
[mesh]
order = 1
rings = 6
[plate]
mass = "100 g"
[drive]
voltage = "5 kV"
[output]
fields = false
[[step]]
kind = "weight"
[[step]]
kind = "voltage"
[[step]]
name = "back"
kind = "voltage"
to = "0 V"
[[quantity]]
name = "field"
kind = "extreme"
of = "electric_field"
extreme = "maximum"
[[quantity]]
name = "peak"
kind = "peak"
of = "field"
extreme = "maximum"
)");
  ASSERT_EQ(dielast({"run", "back.toml", "-o", "out", "-q"}).exit_code, 0);
  const nlohmann::json summary = json_of("out/summary.json");
  EXPECT_EQ(summary["events"], nlohmann::json::array());
  const auto remark = of_kind(summary["event_remarks"], "breakdown");
  ASSERT_TRUE(remark);
  EXPECT_NE((*remark)["remark"].get<std::string>().find("not on this mesh, but"), std::string::npos);
  const nlohmann::json& peak = summary["quantities"]["peak"];
  constexpr double converged = 21.247e6; // rings = 16 and 128 of order 2, extrapolated
  EXPECT_GT(peak["error_estimate"], converged - peak["value"].get<double>());
}

TEST_F(Events, NoStressAcrossARodIsNoTensionThatDependsOnTheMesh) {
  ASSERT_EQ(dielast({"run", source_folder / "cases/gallery/antagonistic_rolls/case.toml", "-o", "out",
                     "--set", "output.fields=false"})
                .exit_code,
            0);
  EXPECT_EQ(json_of("out/summary.json")["event_remarks"], nlohmann::json::array());
}

// Neo-Hookean film without loads: eps V^2 / H^2 = mu (l^-2 - l^-8), largest at l = 4^(1/6). Meshes of even
// film tell all alike; its margin is solved for to a millionth all the same.
TEST_F(Events, ErrorsOfMarginsAreNoSmallerThanWhatTheseAreSolvedTo) {
  write("case.toml", R"([film]
thickness = "1 mm"
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
[patch]
mode = "equal-biaxial"
[drive]
voltage = "20 kV"
[[step]]
kind = "voltage"
[[quantity]]
name = "way"
kind = "margin"
of = "pull-in"
[output]
margins_up_to = 2
)");
  ASSERT_EQ(dielast({"run", "case.toml", "-o", "out", "-q"}).exit_code, 0);
  const nlohmann::json summary = json_of("out/summary.json");
  const auto &way = summary["quantities"]["way"], &margin = summary["margins"]["pull-in"];
  const double right =
      1e-3 * std::sqrt(40e3 / 4e-11 * (std::pow(4, -1.0 / 3) - std::pow(4, -4.0 / 3))) / 20e3;
  EXPECT_NEAR(way["value"].get<double>(), right, way["error_estimate"].get<double>());
  EXPECT_GE(way["error_estimate"].get<double>(), 0.999e-6 * right);
  EXPECT_EQ(margin["error_estimate"], way["error_estimate"]);
}

} // namespace
} // namespace dielast::test::events_test
