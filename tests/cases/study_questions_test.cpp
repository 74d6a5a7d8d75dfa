// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/study_command.hpp"

#include <fmt/format.h>

#include <regex>

namespace dielast::test::study_questions_test {
namespace {

using StudyQuestions = StudyCommand;

// The best point under a bound must be what the table says: here the bound leaves out the point that is best
// without it.
TEST_F(StudyQuestions, TheBestPointHoldsItsBounds) {
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
  const auto answers = json_of("out/study.json");
  EXPECT_EQ(answers["reached"], 6);
  EXPECT_EQ(answers["best"][0]["value"], best);
  EXPECT_EQ(std::to_string(answers["best"][1]["point"].get<int>()), bounded_number);
  EXPECT_EQ(answers["best"][1]["varied"]["drive.voltage"], "4 kV");
  EXPECT_TRUE(answers["best"][2]["point"].is_null());
  EXPECT_FALSE(exists("out/point-0001/small.pvd")); // as `set` says
  EXPECT_EQ(json_of("out/point-0001/summary.json")["no_error_estimate_because"],
            "left out: output.error_estimate = false");
}

// eps_y of the honeycomb is far from straight between 2 and 6 kV: what the target says must be what a run at
// that voltage finds.
TEST_F(StudyQuestions, TargetsAreRunUntilTheyAreMet) {
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
  const auto target = json_of("out/study.json")["targets"][0];
  EXPECT_NEAR(target["value"].get<double>(), 0.1, 1e-5);
  EXPECT_NEAR(target["at"].get<double>(), std::stod(found[1].str()), 1e-5 * target["at"].get<double>());
  EXPECT_EQ(target["at_unit"], "kV");

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
TEST_F(StudyQuestions, TargetsAreMetToAPartOfTheChangeAndUpToWhereRunsFail) {
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

TEST_F(StudyQuestions, TargetsThatCannotBeMetAreNotInterpolated) {
  write("study.toml", "title = \"Elements for a strain\"\ncase = \"small.toml\"\n[study]\n"
                      "vary = { \"mesh.wall_elements\" = [1, 3] }\n"
                      "[[study.target]]\nquantity = \"eps_y\"\nvalue = 0.2555\ntolerance = 1e-9\n");
  const Ended ended = dielast(into("out"));
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "one", "--set", "mesh.wall_elements=1"}).exit_code, 0);
  EXPECT_EQ(ended.exit_code, 4) << ended.out << json_of("one/summary.json")["quantities"]["eps_y"].dump();
  EXPECT_NE(ended.out.find("not solved: the run at"), std::string::npos) << ended.out;
}

TEST_F(StudyQuestions, QuestionsWithoutAnAnswerAreToldByTheExitCode) {
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

} // namespace
} // namespace dielast::test::study_questions_test
