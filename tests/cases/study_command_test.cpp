// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/study_command.hpp"

#include <map>
#include <regex>

namespace dielast::test::study_command_test {
namespace {

TEST_F(StudyCommand, RunsEveryPointOfTheGrid) {
  write_study(study_grid, R"(, { x = "drive.voltage", y = ["eps_x"], group = "honeycomb.angle" })");
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

TEST_F(StudyCommand, WarnsOfRangesThatMissTheirEndAndOfValuesThatStandTwice) {
  write_study(R"({ "drive.voltage" = { from = "1 kV", to = "6 kV", step = "2 kV" } })");
  const Ended short_of_it = dielast(into("out", {"--dry-run"}));
  EXPECT_NE(short_of_it.err.find("its steps do not lead to \"6 kV\": the last value is 5 kV"),
            std::string::npos)
      << short_of_it.err;
  write_study(R"({ "drive.voltage" = ["1 kV", "2 kV", "1 kV"] })");
  const Ended twice = dielast(into("out", {"--dry-run"}));
  EXPECT_NE(twice.err.find("\"1 kV\" stands twice"), std::string::npos) << twice.err;
  write_study(R"({ "drive.voltage" = { from = "1 kV", to = "5 kV", step = "2 kV" } })");
  EXPECT_EQ(dielast(into("out", {"--dry-run"})).err, "");
}

TEST_F(StudyCommand, ChecksAreAskedOfPointsThatAreTheFilesDevice) {
  write("small.toml", small_honeycomb + "[[check]]\nquantity = \"eps_y\"\nvalue = 5\ntolerance = \"1 %\"\n"
                                        "source = \"nobody\"\n");
  write_study(R"({ "mesh.order" = [1, 2] })");
  const Ended asked = dielast(into("out"));
  EXPECT_EQ(asked.err.find("warning"), std::string::npos) << asked.err;
  EXPECT_NE(asked.err.find("mesh.order = 1:   check eps_y              FAILED: "), std::string::npos)
      << asked.err;
  EXPECT_NE(asked.out.find("failed: mesh.order = 2: checks failed, see its run.log\n"), std::string::npos)
      << asked.out;
  write_study(R"({ "drive.voltage" = ["1 kV", "2 kV"] })");
  const Ended not_asked = dielast(into("out"));
  EXPECT_EQ(not_asked.exit_code, 0);
  EXPECT_NE(not_asked.err.find("check: has no effect in a study of other devices than the file's"),
            std::string::npos)
      << not_asked.err;
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
TEST_F(StudyCommand, ADryRunOfSomePointsIsRefused) {
  for (const char* other : {"--dry-run", "--slurm=--time=1"}) {
    const Ended ended = dielast(into("out", {"--points", "1", other}));
    EXPECT_EQ(ended.exit_code, 1) << other;
    EXPECT_NE(ended.err.find("--points runs them here: leave out --"), std::string::npos) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(directory / "out")) << other;
  }
}

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

// A study that has grown keeps what is done, whatever the numbers of its points are now.
TEST_F(StudyCommand, PointsThatHaveRunKeepTheirResultsUnderNewNumbers) {
  write_study(R"({ "drive.voltage" = ["2 kV", "4 kV"] })");
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  const auto written = [&](int point) { return std::filesystem::last_write_time(directory / mark(point)); };
  const auto of_2_kV = written(1), of_4_kV = written(2);
  write_study(R"({ "drive.voltage" = ["3 kV", "4 kV", "1 kV", "2 kV"] })");
  ASSERT_EQ(dielast(into("out", {"--resume"})).exit_code, 0);
  EXPECT_EQ(written(2), of_4_kV);
  EXPECT_EQ(written(4), of_2_kV);
  ASSERT_EQ(dielast(into("fresh")).exit_code, 0);
  EXPECT_EQ(content("out/study.csv"), content("fresh/study.csv"));
  EXPECT_EQ(content("out/report.html"), content("fresh/report.html"));

  write_study(R"({ "drive.voltage" = ["4 kV", "3 kV", "2 kV", "1 kV"] })"); // all of them move, two in a ring
  ASSERT_EQ(dielast(into("out", {"--resume"})).exit_code, 0);
  EXPECT_EQ(written(1), of_4_kV);
  EXPECT_EQ(written(3), of_2_kV);
  for (const auto& entry : std::filesystem::directory_iterator(directory / "out"))
    EXPECT_FALSE(entry.path().filename().string().starts_with("moving")) << entry.path();
}

// Names of files that begin with a digit are no numbers with a unit.
TEST_F(StudyCommand, WavesWhoseFilesAreCalledByNumbers) {
  write("1kV.csv", "time_s,voltage_kV\n0,0\n1,1\n");
  write("2up.csv", "time_s,voltage_kV\n0,0\n1,2\n");
  write("study.toml",
        "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\npermittivity = \"4e-11 "
        "F/m\"\n[patch]\n[drive]\nvoltage = { wave = \"file\", file = \"1kV.csv\" }\n[[step]]\nkind = "
        "\"transient\"\nduration = \"1 s\"\n[study]\nvary = { \"drive.voltage.file\" = [\"1kV.csv\", "
        "\"2up.csv\"] }\ncollect = [\"stretch_x\"]\n");
  const Ended ended = dielast(into("out"));
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_TRUE(content("out/study.csv").starts_with("point,drive.voltage.file,stretch_x[1],"));
}

TEST_F(StudyCommand, PointsWhoseChecksFailHaveReachedTheirEnds) {
  write("study.toml",
        "case = \"small.toml\"\n[study]\nvary = { \"solver.max_iterations\" = [20, 25] }\n"
        "collect = [\"eps_x\"]\nset = { \"check\" = [{ quantity = \"eps_x\", value = 7, source = \"none\", "
        "tolerance = 0.1 }] }\n");
  const Ended ended = dielast(into("out"));
  EXPECT_EQ(ended.exit_code, 5) << ended.err;
  EXPECT_NE(ended.out.find("2 of 2 points reached their ends"), std::string::npos) << ended.out;
}

TEST_F(StudyCommand, ImpossiblePointsHaveNothingOfThoseBeforeThem) {
  write("study.toml",
        "model = \"axisymmetric\"\n[film]\nthickness = \"1 mm\"\nprestretch = 2.0\n[film.material]\n"
        "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[disc]\nradius = \"20 mm\"\n"
        "[mesh]\nrings = 6\n[drive]\nvoltage = \"1 kV\"\n[output]\nerror_estimate = false\n"
        "[study]\nvary = { \"disc.radius\" = [\"20 mm\", \"10 mm\"], \"disc.electrode_radius\" = "
        "[\"5 mm\", \"8 mm\"] }\ncollect = [\"capacitance\"]\n");
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  std::string other = content("study.toml");
  other.replace(other.find("\"8 mm\""), 6, "\"15 mm\"");
  write("study.toml", other);
  EXPECT_EQ(dielast(into("out", {"--resume"})).exit_code, 4);
  const std::string table = content("out/study.csv");
  EXPECT_NE(table.find("\n4,10,15,,2,"), std::string::npos) << table;
  EXPECT_FALSE(exists("out/point-0004/report.html"));
}

TEST_F(StudyCommand, PointsOfAnotherGridAreNotTakenForTheirs) {
  write_study("{ \"drive.voltage\" = [\"2 kV\", \"4 kV\"] }");
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  write_study("{ \"drive.voltage\" = [\"4 kV\", \"2 kV\"] }");
  ASSERT_EQ(dielast(into("out", {"--resume"})).exit_code, 0);
  ASSERT_EQ(dielast(into("fresh")).exit_code, 0);
  EXPECT_EQ(content("out/study.csv"), content("fresh/study.csv"));
}

TEST_F(StudyCommand, PointsThatAreInTheStudyNoMoreAreToldToBeRemoved) {
  write_study(R"({ "drive.voltage" = ["2 kV", "4 kV"] })");
  ASSERT_EQ(dielast(into("out")).exit_code, 0);
  write_study(R"({ "drive.voltage" = ["4 kV", "3 kV"] })");
  const Ended resumed = dielast(into("out", {"--resume"}));
  EXPECT_EQ(resumed.exit_code, 0);
  EXPECT_NE(resumed.out.find("out: results of a point that is in this study no more are removed\n"),
            std::string::npos)
      << resumed.out;
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
} // namespace dielast::test::study_command_test
