// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <fmt/format.h>

#include <map>
#include <regex>

namespace dielast::test {
namespace {

const std::string grid =
    R"({ "honeycomb.angle" = ["120 deg", "150 deg"], "drive.voltage" = ["2 kV", "4 kV", "6 kV"] })";

class StudyCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_study(grid);
  }
  void write_study(const std::string& vary, const std::string& more_plots = "") const {
    write("study.toml", "title = \"Small study\"\ncase = \"small.toml\"\n[study]\nvary = " + vary +
                            "\ncollect = [\"eps_x\", \"eps_y\"]\n"
                            "plot = [{ x = \"eps_x\", y = [\"eps_y\"] }" +
                            more_plots + "]\n");
  }
  std::string mark(int point) const { return "out/point-000" + std::to_string(point) + "/point.json"; }
  std::vector<std::string> into(const std::string& folder, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"study", "study.toml", "-o", folder};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

TEST_F(StudyCommand, RunsEveryPointOfTheGrid) {
  write_study(grid, R"(, { x = "drive.voltage", y = ["eps_x"], group = "honeycomb.angle" })");
  const Ended ended = dielast(into("out"));
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const auto rows = table_of(directory / "out/study.csv");
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"point", "honeycomb.angle[deg]", "drive.voltage[kV]",
                                               "eps_x[1]", "eps_y[1]", "exit_code", "events", "message"}));
  EXPECT_EQ(rows[1][1], "120");
  EXPECT_EQ(rows[6][2], "6");
  for (std::size_t p = 1; p < rows.size(); ++p) {
    EXPECT_EQ(rows[p][0], std::to_string(p));
    EXPECT_EQ(rows[p][5], "0");
  }
  EXPECT_NE(content("out/report.html").find("</html>"), std::string::npos);
  const auto joins = [&](const char* figure) {
    return content(figure).find("rgb( 37,  99, 168)'  d='M") !=
           std::string::npos; // a line of the first curve
  };
  EXPECT_TRUE(joins("out/figure_eps_x.svg"));
  EXPECT_FALSE(joins("out/figure_eps_y.svg")) << "from one angle's last point to the other's first";
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "one", "-j", "1"}).exit_code, 0);
  EXPECT_EQ(json_of("out/point-0006/summary.json"), json_of("one/summary.json"));
  EXPECT_EQ(ended.out.find('\r'), std::string::npos); // plain lines in a pipe
}

TEST_F(StudyCommand, NumbersWithoutUnitsAreInSI) {
  write_study(R"({ "drive.voltage" = [2000, "4 kV"] })");
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  const auto rows = table_of(directory / "out/study.csv");
  EXPECT_EQ(rows[0][1], "drive.voltage[V]");
  EXPECT_EQ(rows[2][1], "4000");
}

TEST_F(StudyCommand, NumbersOfTheTableHaveOneUnitInTheHeader) {
  write("study.toml", R"toml(title = "Numbers"
case = "small.toml"
[study]
collect = ["eps_y"]
set = { "output.error_estimate" = false }
[study.vary]
"honeycomb.angle" = ["120 deg", "2.5 rad"]
"film.prestretch" = [[4, 2.5], 3]
"honeycomb.wall_length" = ["8 mm"]
"film.material" = ["VHB 4910 (honeycomb)"]
)toml");
  const Ended ended = dielast(into("out"));
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const auto rows = table_of(directory / "out/study.csv");
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(std::vector<std::string>(rows[0].begin() + 1, rows[0].begin() + 6),
            (std::vector<std::string>{"honeycomb.angle[rad]", "film.prestretch.1[1]", "film.prestretch.2[1]",
                                      "honeycomb.wall_length[mm]", "film.material"}));
  EXPECT_EQ(rows[1][1], "2.0943951023932");
  EXPECT_EQ(rows[4][1], "2.5");
  EXPECT_EQ(rows[1][3], "2.5");
  EXPECT_EQ(rows[2][2], "3");
  EXPECT_EQ(rows[2][3], "3");
  EXPECT_EQ(rows[1][5], "VHB 4910 (honeycomb)");
}

TEST_F(StudyCommand, TakesSettingsOfTheStudyAndRefusesThoseWithoutEffect) {
  write_study(R"({ "drive.voltage" = ["2 kV", "4 kV"] })");
  const auto with = [&](const std::vector<std::string>& more) { return dielast(into("out", more)); };
  const Ended varied = with({"--set", "drive.voltage=1 kV"});
  EXPECT_EQ(varied.exit_code, 2);
  EXPECT_NE(
      varied.err.find("error: drive.voltage: has no effect: the study gives \"drive.voltage\" a value at "
                      "each of its points"),
      std::string::npos)
      << varied.err;
  const Ended missing = with({"--points", "2-3"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_EQ(missing.err, "error: --points 3: the study has 2 points only\n");
  EXPECT_EQ(with({"--set", "study.colect=[\"eps_x\"]"}).exit_code, 2);
  const Ended ended = with({"--set", "study.collect=[\"eps_x\", \"eps_y\", \"max_field\"]"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(table_of(directory / "out/study.csv")[0],
            (std::vector<std::string>{"point", "drive.voltage[kV]", "eps_x[1]", "eps_y[1]", "max_field[V/m]",
                                      "exit_code", "events", "message"}));
}

TEST_F(StudyCommand, WarnsOfAVariedKeyWithoutEffect) {
  write_study(R"({ "honeycomb.wall_print" = ["merged", "one face"] })");
  const Ended idle = dielast(into("out"));
  EXPECT_NE(idle.err.find("study.vary: \"honeycomb.wall_print\" has no effect here: it acts only with"),
            std::string::npos)
      << idle.err;
  write_study(R"({ "honeycomb.wall_print" = ["merged", "one face"], "model" = ["planar", "3d"] })");
  const Ended acting = dielast(into("out", {"--dry-run"}));
  EXPECT_EQ(acting.err.find("has no effect"), std::string::npos) << acting.err;
}

// The best point under a bound must be what the table says: here the bound leaves out the point that is best
// without it.
TEST_F(StudyCommand, TheBestPointHoldsItsBounds) {
  write("study.toml", R"(title = "Best"
case = "small.toml"
[study]
vary = { l1 = [3, 4], "drive.voltage" = ["2 kV", "4 kV", "6 kV", "30 kV"] }
derive = { "film.prestretch" = ["l1", "10 / l1"] }
set = { "output.error_estimate" = false, "output.fields" = false }
collect = ["eps_y", "max_field"]
[[study.best]]
largest = "eps_y"
[[study.best]]
largest = "eps_y"
where = [{ quantity = "max_field", below = "50 MV/m" }]
[[study.best]]
smallest = "eps_y"
where = [{ quantity = "max_field", above = "500 MV/m" }]
)");
  const Ended ended = dielast(into("out"));
  EXPECT_EQ(ended.exit_code, 4);
  double best = 0, bounded = 0;
  std::string best_number, bounded_number;
  for (const auto& row : table_of(directory / "out/study.csv")) {
    if (row[0] == "point" || row[7] != "0") continue;
    const double value = std::stod(row[5]);
    if (value > best) best = value, best_number = row[0];
    if (std::stod(row[6]) < 50e6 && value > bounded) bounded = value, bounded_number = row[0];
  }
  ASSERT_NE(best_number, bounded_number);
  EXPECT_TRUE(
      std::regex_search(ended.out, std::regex("largest eps_y: .*\\(point " + best_number +
                                              "\\); 2 of 8 points have no result and are left out\n")))
      << ended.out;
  EXPECT_TRUE(std::regex_search(
      ended.out,
      std::regex("largest eps_y with max_field below 50.00 MV/m: .*\\(point " + bounded_number + "\\)")))
      << ended.out;
  EXPECT_NE(ended.out.find("smallest eps_y with max_field above 500.0 MV/m: no point of the grid holds this"),
            std::string::npos)
      << ended.out;
  EXPECT_NE(content("out/report.html").find("largest eps_y with max_field"), std::string::npos);
  EXPECT_FALSE(exists("out/point-0001/small.pvd")); // as `set` says
  EXPECT_EQ(json_of("out/point-0001/summary.json")["no_error_estimate_because"],
            "left out: output.error_estimate = false");
}

TEST_F(StudyCommand, ADryRunListsThePointsAndWritesNothing) {
  write("study.toml", R"(title = "Discs"
case = "disc.toml"
[study]
vary = { "disc.radius" = ["35 mm", "90 mm"], "disc.electrode_radius" = ["50 mm", "30 mm"] }
set = { "drive.voltage" = "1 kV" }
)");
  const Ended plan = dielast(into("out", {"--dry-run", "-j", "2"}));
  EXPECT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_FALSE(exists("out"));
  const auto lines = lines_of(plan.out);
  ASSERT_EQ(lines.size(), 6u) << plan.out;
  EXPECT_TRUE(
      lines[0].starts_with("     1  disc.radius = 35 mm, disc.electrode_radius = 50 mm  impossible: "))
      << lines[0];
  EXPECT_EQ(lines[1], "     2  disc.radius = 35 mm, disc.electrode_radius = 30 mm");
  EXPECT_EQ(lines[4], "4 points in out: 3 to run, 1 impossible");
  EXPECT_TRUE(std::regex_match(
      lines[5], std::regex("point 2 takes about [0-9.e+]+ s and [0-9.]+ MB: all about [0-9.e+]+ s, "
                           "2 at a time, and [0-9.]+ MB")))
      << lines[5];
  ASSERT_EQ(dielast(into("out")).exit_code, 4);
  const Ended after = dielast(into("out", {"--dry-run"}));
  EXPECT_NE(after.out.find("disc.electrode_radius = 30 mm  done\n"), std::string::npos) << after.out;
  EXPECT_NE(after.out.find("4 points in out: 0 to run, 1 impossible\n"), std::string::npos) << after.out;
}

// What a point writes is little unless the case or the study wants more.
TEST_F(StudyCommand, PointsKeepTheLastStateOfEachStep) {
  write_study(R"({ "drive.voltage" = ["2 kV"] })");
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  ASSERT_EQ(dielast(into("all", {"--set", "output.states=all"})).exit_code, 0);
  const auto states = [&](const std::string& folder) {
    return count(content(folder + "/point-0001/small.pvd"), "part=\"0\"");
  };
  EXPECT_EQ(states("out"), 3u); // drawn, released, at the voltage
  EXPECT_EQ(states("all"), 5u);
  EXPECT_EQ(content("out/study.csv"), content("all/study.csv"));
  EXPECT_EQ(lines_of(content("out/point-0001/history.csv")), lines_of(content("all/point-0001/history.csv")));
}

TEST_F(StudyCommand, PagesOfStudyAndPointsLeadToEachOther) {
  write_study(R"({ "drive.voltage" = ["2 kV"] })");
  ASSERT_EQ(dielast(into("out", {"--set", "output.error_estimate=false"})).exit_code, 0);
  EXPECT_NE(content("out/report.html").find("<a href=\"point-0001/report.html\">1</a>"), std::string::npos);
  EXPECT_NE(content("out/point-0001/report.html").find("<a href=\"../report.html\">Small study</a>"),
            std::string::npos);
  EXPECT_EQ(json_of("out/point-0001/summary.json")["no_error_estimate_because"],
            "left out: output.error_estimate = false");
}

TEST_F(StudyCommand, KilledAndResumedItEndsInTheSameBits) {
  ASSERT_EQ(dielast(into("straight")).exit_code, 0);
  const pid_t process = start(into("out", {"-j", "1"}));
  ASSERT_TRUE(until([&] { return exists(mark(2)); }));
  kill(process, SIGKILL);
  ASSERT_EQ(wait_for(process).exit_code, -SIGKILL);
  std::this_thread::sleep_for(std::chrono::milliseconds(50)); // its child dies with it
  ASSERT_FALSE(exists(mark(6)));
  std::map<int, std::filesystem::file_time_type> written;
  for (const int point : {1, 2}) written[point] = std::filesystem::last_write_time(directory / mark(point));
  ASSERT_EQ(dielast(into("out", {"--resume", "-j", "2"})).exit_code, 0);
  for (const auto& [point, time] : written)
    EXPECT_EQ(std::filesystem::last_write_time(directory / mark(point)), time) << point;
  EXPECT_EQ(content("out/study.csv"), content("straight/study.csv"));
  EXPECT_EQ(content("out/report.html"), content("straight/report.html"));
}

TEST_F(StudyCommand, WithoutResumeEverythingIsRepeated) {
  write_study("{ \"drive.voltage\" = [\"2 kV\"] }");
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  const auto time = std::filesystem::last_write_time(directory / mark(1));
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  EXPECT_NE(std::filesystem::last_write_time(directory / mark(1)), time);
}

TEST_F(StudyCommand, PointsOfAnotherGridAreNotReused) {
  write_study("{ \"drive.voltage\" = [\"2 kV\", \"4 kV\"] }");
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  write_study("{ \"drive.voltage\" = [\"4 kV\", \"2 kV\"] }");
  ASSERT_EQ(dielast(into("out", {"--resume"})).exit_code, 0);
  ASSERT_EQ(dielast(into("fresh")).exit_code, 0);
  EXPECT_EQ(content("out/study.csv"), content("fresh/study.csv"));
}

// The case file is part of what a finished point is a result of.
TEST_F(StudyCommand, ResumingAnEditedCaseSaysWhatHasChangedAndStops) {
  write_study("{ \"drive.voltage\" = [\"2 kV\"] }");
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  const std::string table = content("out/study.csv");
  std::string edited = small_honeycomb;
  edited.replace(edited.find("[4.0, 2.5]"), 10, "[3.0, 3.0]");
  write("small.toml", edited);
  const Ended resumed = dielast(into("out", {"--resume"}));
  EXPECT_EQ(resumed.exit_code, 1);
  EXPECT_EQ(resumed.err,
            "error: out: the case has changed since: film.prestretch is [3, 3], it was [4, 2.5]; run it "
            "again without --resume\n");
  EXPECT_EQ(content("out/study.csv"), table);
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  ASSERT_EQ(dielast(into("fresh")).exit_code, 0);
  EXPECT_EQ(content("out/study.csv"), content("fresh/study.csv"));
}

TEST_F(StudyCommand, FailedPointsAreRecordedAndDoNotStopTheRest) {
  write_study(R"({ "drive.voltage" = ["2 kV", "30 kV", "4 kV"] })");
  const Ended ended = dielast(into("out", {"-j", "1"}));
  EXPECT_EQ(ended.exit_code, 4);
  const auto rows = table_of(directory / "out/study.csv");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[1][4], "0");
  EXPECT_EQ(rows[2][4], "4");
  EXPECT_EQ(rows[3][4], "0");
  EXPECT_NE(content("out/study.csv").find("limit point near"), std::string::npos);
  EXPECT_NE(ended.out.find("2 of 3 points"), std::string::npos) << ended.out;
}

// eps_y of the honeycomb is far from straight between 2 and 6 kV: what the target says must be what a run at
// that voltage finds.
TEST_F(StudyCommand, TargetsAreRunUntilTheyAreMet) {
  const auto write_target = [&](const std::string& tolerance) {
    write("study.toml", "title = \"Voltage for a strain\"\ncase = \"small.toml\"\n[study]\n"
                        "vary = { \"drive.voltage\" = [\"2 kV\", \"6 kV\"] }\n"
                        "[[study.target]]\nquantity = \"eps_y\"\nvalue = 0.1\n" +
                            tolerance);
  };
  write_target("tolerance = 1e-5\n");
  const Ended ended = dielast(into("out"));
  ASSERT_EQ(ended.exit_code, 0) << ended.out << ended.err;
  std::smatch found;
  ASSERT_TRUE(std::regex_search(
      ended.out, found, std::regex(R"re(eps_y = \S+ at drive.voltage = (\S+) kV \(run there: (\S+)\))re")))
      << ended.out;
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "one", "--set", "drive.voltage=" + found[1].str() + " kV"})
                .exit_code,
            0);
  EXPECT_NEAR(json_of("one/summary.json")["quantities"]["eps_y"]["value"].get<double>(), 0.1, 2e-5);
  EXPECT_NE(content("out/report.html").find("run there"), std::string::npos);
  EXPECT_EQ(table_of(directory / "out/study.csv").size(), 3u); // of the grid alone

  // once more with what has been run already
  const auto first_run = directory / "out/target-01-01/summary.json";
  const auto written = std::filesystem::last_write_time(first_run);
  const Ended again = dielast(into("out", {"--resume"}));
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(first_run), written);
  EXPECT_NE(again.out.find(found[0].str()), std::string::npos) << again.out;
}

// A patch under equal-biaxial stress 0 and a voltage: mu (l - l^-5) = eps (V/H)^2 l^3, with a limit point at
// 24.302 kV and the stretch 1.26. What is asked of the stretch is asked of the strain.
TEST_F(StudyCommand, TargetsAreMetToAPartOfTheChangeAndUpToWhereRunsFail) {
  write("patch.toml", "[film]\nthickness = \"1 mm\"\n[film.material]\npermittivity = \"4e-11 F/m\"\n"
                      "shear_modulus = \"50 kPa\"\n[patch]\nmode = \"equal-biaxial\"\nlength = \"20 mm\"\n"
                      "[drive]\nvoltage = \"6 kV\"\n[[step]]\nkind = \"voltage\"\nincrements = 4\n"
                      "[output]\nerror_estimate = false\nfields = false\n");
  const auto asked = [&](const std::string& values, double stretch) {
    write("study.toml", fmt::format("case = \"patch.toml\"\n[study]\nvary = {{ \"drive.voltage\" = [{}] }}\n"
                                    "collect = [\"stretch_x\"]\n[[study.target]]\nquantity = "
                                    "\"stretch_x\"\nvalue = {}\n",
                                    values, stretch));
    return dielast(into("out")).out;
  };
  const auto found = [&](const std::string& out) {
    const std::regex words(R"re(stretch_x = \S+ at drive.voltage = (\S+) kV)re");
    std::smatch voltage;
    return std::regex_search(out, voltage, words) ? std::stod(voltage[1].str()) : 0;
  };
  const auto right = [](double l) {
    return std::sqrt(50e3 * (l - std::pow(l, -5)) / (4e-11 * std::pow(l, 3))) * 1e-3 / 1e3;
  };
  EXPECT_NEAR(found(asked("\"2 kV\", \"5 kV\", \"8 kV\"", 1.005)) / right(1.005), 1, 1e-4);
  EXPECT_NEAR(found(asked("\"2 kV\", \"15 kV\", \"27 kV\", \"40 kV\"", 1.2)) / right(1.2), 1, 1e-4);
  const std::string beyond = asked("\"2 kV\", \"15 kV\", \"27 kV\", \"40 kV\"", 1.9);
  EXPECT_NE(beyond.find("not solved: it is not reached by the values that run; runs fail from between 24.3"),
            std::string::npos)
      << beyond;
}

TEST_F(StudyCommand, TargetsThatCannotBeMetAreNotInterpolated) {
  write("study.toml", "title = \"Elements for a strain\"\ncase = \"small.toml\"\n[study]\n"
                      "vary = { \"mesh.wall_elements\" = [1, 3] }\n"
                      "[[study.target]]\nquantity = \"eps_y\"\nvalue = 0.2555\ntolerance = 1e-9\n");
  const Ended ended = dielast(into("out"));
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "one", "--set", "mesh.wall_elements=1"}).exit_code, 0);
  EXPECT_EQ(ended.exit_code, 4) << ended.out << json_of("one/summary.json")["quantities"]["eps_y"].dump();
  EXPECT_NE(ended.out.find("not solved: the run at"), std::string::npos) << ended.out;
}

TEST_F(StudyCommand, QuestionsWithoutAnAnswerAreToldByTheExitCode) {
  const auto asks = [&](const std::string& question) {
    write("study.toml", "title = \"Asks\"\ncase = \"small.toml\"\n[study]\n"
                        "vary = { \"mesh.wall_elements\" = [1, 3] }\n" +
                            question);
    return dielast(into("out"));
  };
  const Ended target = asks("[[study.target]]\nquantity = \"eps_y\"\nvalue = 9\n");
  EXPECT_EQ(target.exit_code, 5) << target.out << target.err;
  EXPECT_NE(target.out.find("not within the values varied: between no two points"), std::string::npos)
      << target.out;
  const Ended best =
      asks("[[study.best]]\nlargest = \"eps_y\"\nwhere = [{ quantity = \"eps_y\", above = 9 }]\n");
  EXPECT_EQ(best.exit_code, 5) << best.out << best.err;
}

TEST_F(StudyCommand, ImpossibleValuesAreRefusedBeforeAnythingRuns) {
  write_study(R"({ "honeycomb.angle" = ["150 deg", "60 deg", "120 deg"] })");
  const Ended ended = dielast(into("out"));
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_TRUE(ended.err.starts_with("study.toml:4:")) << ended.err;
  EXPECT_NE(ended.err.find("cells close up at 60 deg"), std::string::npos) << ended.err;
  EXPECT_FALSE(exists("out"));
}

// Every value alone is possible with the case's others; two of them together are not.
TEST_F(StudyCommand, ImpossibleCombinationsAreRecordedAndDoNotStopTheRest) {
  write("study.toml", R"(title = "Discs"
case = "disc.toml"
[study]
vary = { "disc.radius" = ["35 mm", "90 mm"], "disc.electrode_radius" = ["50 mm", "30 mm"] }
)");
  const Ended ended = dielast(into("out"));
  EXPECT_EQ(ended.exit_code, 4) << ended.err;
  const auto rows = table_of(directory / "out/study.csv");
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(json_of(mark(1))["exit_code"], 2);
  EXPECT_NE(json_of(mark(1))["message"], "");
  for (const int point : {2, 3, 4}) EXPECT_EQ(json_of(mark(point))["exit_code"], 0) << point;
}

// A point that needs more processor time than the system allows is ended by it, as by a crash.
TEST_F(StudyCommand, CrashedPointsAreRecordedAndDoNotStopTheRest) {
  write_study(R"({ "mesh.wall_elements" = [2, 200, 3] })");
  const Ended ended = dielast(into("out"), [] {
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, 5); // enough for small meshes under sanitizers, too
  });
  EXPECT_EQ(ended.exit_code, 4);
  const auto rows = table_of(directory / "out/study.csv");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[1][4], "0");
  EXPECT_LT(std::stoi(rows[2][4]), 0);
  EXPECT_TRUE(rows[2][6].starts_with("crashed (signal ")) << rows[2][6];
  EXPECT_EQ(rows[3][4], "0");
}

} // namespace
} // namespace dielast::test
