// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <algorithm>
#include <regex>

namespace dielast::test::outputs_test {
namespace {

class Outputs : public CommandTest {
 protected:
  static void expect_quantity(const nlohmann::json& summary, const std::string& name,
                              const std::string& unit) {
    ASSERT_TRUE(summary["quantities"].contains(name)) << name;
    const nlohmann::json& quantity = summary["quantities"][name];
    EXPECT_TRUE(quantity["value"].is_number()) << name;
    EXPECT_EQ(quantity["unit"], unit) << name;
    EXPECT_TRUE(quantity["error_estimate"].is_number()) << name;
    EXPECT_GE(quantity["error_estimate"], 0) << name;
  }
};

// A run that ends within a step keeps the state that it has reached, although it is not the step's last.
TEST_F(Outputs, SeriesOfTheLastStates) {
  const auto states = [&](const std::string& voltage, const std::string& which) {
    const std::string folder = voltage.substr(0, voltage.find(' ')) + which;
    dielast({"run", "small.toml", "-o", folder, "--set", "drive.voltage=" + voltage, "--set",
             "output.states=" + which, "--set", "output.error_estimate=false"});
    std::vector<std::string> times;
    const std::string list = content(folder + "/small.pvd");
    const std::regex entry("timestep=\"([^\"]*)\"[^>]*part=\"0\"");
    for (std::sregex_iterator at(list.begin(), list.end(), entry), end; at != end; ++at)
      times.push_back((*at)[1]);
    return times;
  };
  const auto all = states("4 kV", "all"), last = states("4 kV", "last");
  ASSERT_EQ(all.size(), 5u);
  EXPECT_EQ(last, (std::vector<std::string>{all[0], all[1], all[4]}));
  const auto all_ended = states("30 kV", "all"), last_ended = states("30 kV", "last");
  ASSERT_GT(all_ended.size(), 3u);
  EXPECT_EQ(last_ended, (std::vector<std::string>{all_ended[0], all_ended[1], all_ended.back()}));
}

TEST_F(Outputs, AQuantityWithoutAValueSaysWhy) {
  write("light.toml", small_disc + "[[quantity]]\nname = \"w\"\nkind = \"natural frequency\"\n");
  ASSERT_EQ(dielast({"run", "light.toml", "-o", "out", "--set", "film.material.density=0 kg/m^3"}).exit_code,
            0);
  const nlohmann::json w = json_of("out/summary.json")["quantities"]["w"];
  EXPECT_TRUE(w["value"].is_null());
  EXPECT_NE(w["error_remark"].get<std::string>().find("no value"), std::string::npos) << w;
}

// The page begins with what the user has asked for, and shows neither zeros nor curves of nothing.
TEST_F(Outputs, ThePageShowsTheUsersQuantitiesFirst) {
  write("own.toml", small_honeycomb + "[[quantity]]\nname = \"my_distance\"\nkind = \"distance\"\n"
                                      "between = [\"left_apex\", \"right_apex\"]\n");
  ASSERT_EQ(dielast({"run", "own.toml", "-o", "out"}).exit_code, 0);
  const std::string page = content("out/report.html");
  std::vector<std::string> cards;
  const std::regex card("<div class=\"label\">([^<]*)</div>");
  for (std::sregex_iterator at(page.begin(), page.end(), card), end; at != end; ++at)
    cards.push_back((*at)[1]);
  ASSERT_EQ(cards.size(), 6u);
  EXPECT_EQ(cards[0], "my_distance");
  EXPECT_EQ(std::ranges::count(cards, "mechanical_work"), 0);
  EXPECT_NE(
      page.find("Without a curve, as they do not change or have no value along the way: mechanical_work, "
                "dissipated_energy"),
      std::string::npos);
  EXPECT_NE(page.find("Case, with every default"), std::string::npos);
}

// A page of a run has slides of its states and its figures as files; a page of last states has neither.
TEST_F(Outputs, SlidesAndFiguresAreOfRunsThatKeepAllStates) {
  for (const std::string states : {"all", "last"}) {
    ASSERT_EQ(dielast({"run", "small.toml", "-o", states, "--set", "output.states=" + states, "--set",
                       "output.error_estimate=false"})
                  .exit_code,
              0);
    const bool all = states == "all";
    EXPECT_EQ(content(states + "/report.html").find("<figure class=\"slides\"") != std::string::npos, all);
    EXPECT_EQ(exists(directory / states / "figure_shape.svg"), all);
    EXPECT_EQ(exists(directory / states / "figure_strains.svg"), all);
  }
  EXPECT_TRUE(content("all/figure_shape.svg").starts_with("<?xml"));
}

// A table of the place's nodes along its length: since the drawing or since a step, and none where that step
// has not come to its end.
TEST_F(Outputs, ProfilesTellHowTheNodesOfAPlaceHaveMoved) {
  write("own.toml", small_honeycomb + "[[profile]]\nname = \"rise\"\nof = \"walls\"\nalong = \"y\"\n"
                                      "[[profile]]\nname = \"opening\"\nof = \"walls\"\nalong = \"y\"\n"
                                      "since = \"release\"\n"
                                      "[[profile]]\nname = \"nothing\"\nof = \"walls\"\nalong = \"y\"\n"
                                      "since = \"voltage\"\n"
                                      "[[quantity]]\nname = \"most\"\nkind = \"swelling\"\nof = "
                                      "\"walls\"\nalong = \"y\"\n[output]\nerror_estimate = false\n");
  const auto displacements = [&](const std::string& file) {
    const auto rows = table_of(directory / file);
    EXPECT_EQ(rows.at(0).at(0), "x [m]") << file;
    std::vector<double> values;
    for (std::size_t r = 1; r < rows.size(); ++r) {
      values.push_back(std::stod(rows[r].at(3)));
      EXPECT_LE(std::stod(rows[std::max<std::size_t>(r - 1, 1)][0]), std::stod(rows[r][0])) << file;
    }
    return values;
  };
  ASSERT_EQ(dielast({"run", "own.toml", "-o", "out"}).exit_code, 0);
  ASSERT_EQ(dielast({"run", "own.toml", "-o", "uncharged", "--set", "drive.voltage=1 mV"}).exit_code, 0);
  const std::vector<double> rise = displacements("out/profile_rise.csv"),
                            opening = displacements("out/profile_opening.csv"),
                            released = displacements("uncharged/profile_rise.csv");
  const double most = json_of("out/summary.json")["quantities"]["most"]["value"];
  EXPECT_NEAR(std::ranges::max(rise), most, 1e-12 * most);
  ASSERT_EQ(opening.size(), rise.size());
  for (std::size_t i = 0; i < rise.size(); ++i) EXPECT_NEAR(opening[i], rise[i] - released[i], 1e-6 * most);
  EXPECT_EQ(std::ranges::max(displacements("out/profile_nothing.csv")), 0);
  EXPECT_NE(content("out/report.html").find("<h2>Profiles</h2>"), std::string::npos);

  ASSERT_EQ(dielast({"run", "own.toml", "-o", "early", "--set", "drive.voltage=30 kV"}).exit_code, 4);
  EXPECT_TRUE(exists(directory / "early/profile_opening.csv"));
  EXPECT_FALSE(exists(directory / "early/profile_nothing.csv"));
}

// A quantity that is known at rest alone is no curve over time, and what happens before time passes is not
// squeezed into its first moment.
TEST_F(Outputs, CurvesOverTimeBeginWhereTimeDoes) {
  write("timed.toml", R"(model = "axisymmetric"
[film]
thickness = "1 mm"
prestretch = 2
[film.material]
law = "neo-hookean"
shear_modulus = "40 kPa"
relative_permittivity = 4.7
[annulus]
inner_radius = "12.7 mm"
outer_radius = "68.58 mm"
[mesh]
rings = 6
[plate]
mass = "100 g"
damping = "1.6 N.s/m"
[drive]
voltage = { wave = "step", to = "5 kV" }
[output]
error_estimate = false
fields = false
[[step]]
kind = "weight"
[[step]]
kind = "transient"
duration = "0.2 s"
)");
  const Ended ended = dielast({"run", "timed.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
  EXPECT_FALSE(exists(directory / "out/figure_stiffness.svg"));
  ASSERT_TRUE(exists(directory / "out/figure_drop.svg"));
  const std::string page = content("out/report.html");
  const std::regex drop(
      R"re(&quot;y&quot;:\[([-0-9.e]+),[^\]]*\]\}\],&quot;size&quot;:[^/]*&quot;label&quot;:&quot;drop \[mm\]&quot;)re");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(page, found, drop));
  EXPECT_GT(std::stod(found[1]), 5); // hung on its weight, in mm
}

TEST_F(Outputs, ACompressingPrestretchIsWarnedOf) {
  for (const char* prestretch : {"0.9", "1.1"}) {
    const Ended ended =
        dielast({"check", "small.toml", "--set", std::string("film.prestretch=") + prestretch});
    EXPECT_EQ((ended.out + ended.err).find("below 1: it compresses the film") != std::string::npos,
              std::string(prestretch) == "0.9")
        << ended.out << ended.err;
  }
}

TEST_F(Outputs, AFilmWithoutVoltageOrTooThickIsWarnedOf) {
  write("disc.toml", "[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nlaw = \"neo-hookean\"\n"
                     "shear_modulus = \"40 kPa\"\nrelative_permittivity = 4.7\n[disc]\nradius = \"20 mm\"\n"
                     "electrode_radius = \"10 mm\"\n");
  const auto told = [&](const std::string& warning, std::vector<std::string> more) {
    more.insert(more.begin(), {"check", "disc.toml"});
    const Ended ended = dielast(more);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    return (ended.out + ended.err).find(warning) != std::string::npos;
  };
  const std::string thick = "the film is 2.000 mm thick and 4.000 mm wide";
  EXPECT_TRUE(told(thick, {"--set", "film.thickness=8 mm", "--set", "disc.radius=2 mm", "--set",
                           "disc.electrode_radius=1 mm"}));
  EXPECT_FALSE(told("thick and", {}));
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "disc.toml", "-o", "out", "--set", "mesh.rings=4"});
    return dielast(more).out;
  };
  const std::string idle = "leaves every electrode at 0 V";
  EXPECT_NE(run({}).find(idle), std::string::npos);
  EXPECT_EQ(run({"--set", "drive.voltage=0"}).find(idle), std::string::npos);
}

TEST_F(Outputs, OfAHoneycomb) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out"}).exit_code, 0);
  for (const char* file :
       {"small.pvd", "history.csv", "summary.json", "resolved.toml", "report.html", "run.log"})
    EXPECT_GT(std::filesystem::file_size(directory / "out" / file), 0u) << file;

  const nlohmann::json summary = json_of("out/summary.json");
  EXPECT_EQ(summary["status"], "complete");
  for (const auto& [name, unit] : std::map<std::string, std::string>{{"eps_x", "1"},
                                                                     {"eps_y", "1"},
                                                                     {"released_length_x", "m"},
                                                                     {"released_length_y", "m"},
                                                                     {"max_field", "V/m"},
                                                                     {"breakdown_ratio", "1"},
                                                                     {"min_principal_stress", "Pa"},
                                                                     {"capacitance", "F"}})
    expect_quantity(summary, name, unit);

  const auto rows = table_of(directory / "out/history.csv");
  ASSERT_EQ(rows.size(), 6u); // header, drawn, release, three increments
  EXPECT_EQ(rows[0][0], "step");
  for (std::size_t c = 1; c < rows[0].size(); ++c)
    EXPECT_TRUE(std::regex_match(rows[0][c], std::regex(R"(\w+\[[^\]]+\])"))) << rows[0][c];
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  EXPECT_EQ(rows.back()[0], "voltage");
  EXPECT_EQ(std::stod(rows.back()[1]), 1);
  EXPECT_EQ(std::stod(rows.back()[3]), 6000);
}

TEST_F(Outputs, SeriesHasAStepForEveryRow) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out"}).exit_code, 0);
  const std::string list = content("out/small.pvd");
  const std::size_t rows = table_of(directory / "out/history.csv").size() - 1;
  std::map<std::string, std::vector<double>> times;
  const std::regex entry(R"re(timestep="([^"]+)" part="\d" name="([^"]+)" file="([^"]+)")re");
  for (std::sregex_iterator found(list.begin(), list.end(), entry), end; found != end; ++found) {
    times[(*found)[2]].push_back(std::stod((*found)[1]));
    EXPECT_TRUE(exists("out/" + (*found)[3].str())) << (*found)[3];
  }
  ASSERT_EQ(times.size(), 2u);
  for (const auto& [part, of_part] : times) {
    EXPECT_EQ(of_part.size(), rows) << part;
    for (std::size_t i = 1; i < of_part.size(); ++i) EXPECT_LT(of_part[i - 1], of_part[i]) << part;
  }
}

// Ramps, a jump and a ramp between steps that take time: ParaView would show all states of one time at once.
TEST_F(Outputs, SeriesHasOneStateForEachTime) {
  write("timed.toml", R"([film]
thickness = "1 mm"
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
[patch]
[drive]
voltage = { wave = "step", from = "1 kV", to = "2 kV", at = "0.5 s" }
[[load]]
place = "right"
force = ["1 mN", 0, 0]
[[step]]
kind = "voltage"
increments = 4
[[step]]
kind = "transient"
duration = "1 s"
increments = 10
[[step]]
kind = "force"
increments = 2
[[step]]
kind = "hold"
duration = "2 s"
increments = 2
)");
  const Ended ended = dielast({"run", "timed.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
  const std::string list = content("out/timed.pvd");
  std::vector<double> times;
  const std::regex entry(R"re(timestep="([^"]+)")re");
  for (std::sregex_iterator found(list.begin(), list.end(), entry), end; found != end; ++found)
    times.push_back(std::stod((*found)[1]));
  const auto rows = table_of(directory / "out/history.csv");
  ASSERT_EQ(times.size(), rows.size() - 1);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i], times[i - 1]) << i;
  EXPECT_EQ(times.front(), -1); // drawn, one step before time starts
  EXPECT_EQ(times.at(4), 0);    // the ramp's end
  EXPECT_NEAR(times.back(), 3, 1e-6);
  // the rows of one time are those of the jump, which says so, and those of the ramp between
  ASSERT_EQ(rows[0].back(), "jumped[1]");
  int jumps = 0;
  for (std::size_t r = 2; r < rows.size(); ++r) {
    jumps += rows[r].back() == "1";
    EXPECT_TRUE(rows[r][2] != rows[r - 1][2] || rows[r].back() == "1" || rows[r][0] == "voltage" ||
                rows[r][0] == "force")
        << r;
  }
  EXPECT_EQ(jumps, 2); // the load as time starts, the voltage after half a second
}

TEST_F(Outputs, WarningsAreInLogSummaryAndReport) {
  const std::string said = "has no effect here: it acts only with a step with a duration";
  const Ended ended = dielast({"run", "small.toml", "-o", "out", "--set", "solver.time_tolerance=1e-8"});
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_NE(ended.out.find(said), std::string::npos) << ended.out;
  EXPECT_NE(content("out/run.log").find(said), std::string::npos);
  EXPECT_NE(content("out/report.html").find(said), std::string::npos);
  const nlohmann::json warnings = json_of("out/summary.json")["warnings"];
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].get<std::string>().find("solver.time_tolerance"), std::string::npos);
  const Ended checked = dielast({"check", "small.toml", "--set", "solver.time_tolerance=1e-8"});
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_NE(checked.err.find(said), std::string::npos) << checked.err;
}

TEST_F(Outputs, FieldsCanBeLeftOut) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out", "--set", "output.fields=false"}).exit_code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(directory / "out")) {
    EXPECT_NE(entry.path().extension(), ".vtu");
    EXPECT_NE(entry.path().extension(), ".pvd");
  }
  EXPECT_TRUE(exists("out/report.html"));
}

TEST_F(Outputs, OfADisc) {
  ASSERT_EQ(dielast({"run", "disc.toml"}).exit_code, 0);
  const nlohmann::json summary = json_of("disc-results/summary.json");
  for (const auto& [name, unit] : std::map<std::string, std::string>{
           {"electrode_radius", "m"}, {"max_field", "V/m"}, {"breakdown_ratio", "1"}, {"capacitance", "F"}})
    expect_quantity(summary, name, unit);
  EXPECT_NEAR(summary["quantities"]["electrode_radius"]["value"].get<double>(), 0.0338, 1e-4);
}

TEST_F(Outputs, ReportNeedsNothingElse) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out"}).exit_code, 0);
  const std::string report = content("out/report.html");
  EXPECT_NE(report.find("</html>"), std::string::npos);
  EXPECT_NE(report.find("src=\"data:image/svg+xml;base64,"), std::string::npos);
  const std::regex outside(
      R"re((?:src|href)="(?!data:|#)[^"]*"|<script |<link|@import|url\((?!#|'#|"#|data:))re");
  std::smatch found;
  EXPECT_FALSE(std::regex_search(report, found, outside)) << found.str();
}

TEST_F(Outputs, ResolvedCaseGivesTheSameResults) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out", "--set", "film.prestretch=3"}).exit_code, 0);
  std::filesystem::create_directory(directory / "again");
  write("again/small.toml", content("out/resolved.toml"));
  ASSERT_EQ(dielast({"run", "again/small.toml", "-o", "again/out"}).exit_code, 0);
  for (const char* file : {"summary.json", "history.csv", "resolved.toml"})
    EXPECT_EQ(content(std::string("again/out/") + file), content(std::string("out/") + file)) << file;
}

// A free film in a field carries no tension and is not slack: what ends its run is the limit point, drawn
// with its mode.
TEST_F(Outputs, TheReportDrawsTheCriticalMode) {
  for (const std::string wrinkling : {"compression", "tension field"}) {
    const Ended ended =
        dielast({"run", source_folder / "cases/gallery/material/pull_in.toml", "-o", "out", "--set",
                 "step.voltage.on_instability=stop", "--set", "film.wrinkling=" + wrinkling});
    EXPECT_EQ(ended.exit_code, 4);
    EXPECT_NE((ended.out + ended.err).find("limit point near 23.122 kV"), std::string::npos) << ended.err;
    EXPECT_EQ(count(content("out/report.html"), "<h2>Critical mode</h2>"), 1u);
  }
}

TEST_F(Outputs, ASecondRunReplacesTheFirst) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out", "--set", "step.voltage.increments=6"}).exit_code, 0);
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out"}).exit_code, 0);
  EXPECT_EQ(table_of(directory / "out/history.csv").size(), 6u);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory / "out"))
    files += entry.path().extension() == ".vtu";
  EXPECT_EQ(files, 10u); // film and walls of five states: nothing left of the first run
}

} // namespace
} // namespace dielast::test::outputs_test
