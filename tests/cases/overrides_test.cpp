// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

namespace dielast::test::overrides_test {
namespace {

class OverrideCommand : public CommandTest {
 protected:
  /// summary.json of a run with these overrides.
  nlohmann::json summary(const std::vector<std::string>& overrides, const std::string& file = "small.toml") {
    std::vector<std::string> words{"run", file, "-o", "out", "-q", "--set", "output.error_estimate=false"};
    for (const std::string& assignment : overrides) words.insert(words.end(), {"--set", assignment});
    const Ended ended = dielast(words);
    EXPECT_EQ(ended.exit_code, 0) << ended.err << testing::PrintToString(overrides);
    return json_of("out/summary.json");
  }
  static double value(const nlohmann::json& summary, const char* quantity) {
    return summary["quantities"][quantity]["value"];
  }
};

TEST_F(OverrideCommand, EveryDocumentedKeyIsHeard) {
  const nlohmann::json plain = summary({});
  for (const char* assignment :
       {"honeycomb.angle=\"140 deg\"", "honeycomb.wall_height=\"4 mm\"", "honeycomb.wall_width=\"1 mm\"",
        "film.prestretch=[3.2, 3.2]", "drive.voltage=\"5 kV\"", "mesh.wall_elements=3", "mesh.order=1"}) {
    const nlohmann::json changed = summary({assignment});
    const double difference = value(changed, "eps_y") / value(plain, "eps_y") - 1;
    EXPECT_GT(std::abs(difference), 1e-6) << assignment;
    EXPECT_LT(std::abs(difference), 0.7) << assignment;
  }
  EXPECT_LT(value(summary({"honeycomb.wall_height=4 mm"}), "eps_y"), value(plain, "eps_y"));
  EXPECT_LT(value(summary({"drive.voltage=5000"}), "eps_y"), value(plain, "eps_y"));
}

TEST_F(OverrideCommand, UnitsWithAndWithoutQuotesAreTheSame) {
  const nlohmann::json plain = summary({});
  EXPECT_EQ(summary({"drive.voltage=\"6 kV\""}), plain);
  EXPECT_EQ(summary({"drive.voltage=6 kV"}), plain);
  EXPECT_EQ(summary({"drive.voltage=6000"}), plain);
  EXPECT_EQ(summary({"drive.voltage=1 V", "drive.voltage=6e3 V"}), plain); // the last one wins
}

TEST_F(OverrideCommand, ChecksAreOfTheDeviceAsWritten) {
  const std::string check =
      "[[check]]\nquantity = \"eps_y\"\nvalue = 0.2\ntolerance = 0.2\nsource = \"roughly\"\n";
  write("checked.toml", small_honeycomb + check);
  EXPECT_EQ(summary({}, "checked.toml")["checks"].size(), 1u);
  for (const char* kept :
       {"mesh.wall_elements=3", "mesh.order=1", "mesh.grading=2", "solver.tolerance=1e-10"})
    EXPECT_EQ(summary({kept}, "checked.toml")["checks"].size(), 1u) << kept;
  for (const char* other : {"honeycomb.angle=140 deg", "honeycomb.wall_height=4 mm",
                            "honeycomb.wall_width=1 mm", "film.prestretch=3", "drive.voltage=5 kV"})
    EXPECT_EQ(summary({other}, "checked.toml")["checks"].size(), 0u) << other;
  EXPECT_EQ(summary({"mesh.order=1", "drive.voltage=5 kV"}, "checked.toml")["checks"].size(), 0u);
}

TEST_F(OverrideCommand, WithoutAValueTheKeyIsRemoved) {
  const nlohmann::json plain = summary({});
  EXPECT_EQ(summary({"mesh.order=1", "mesh.order="})["quantities"], plain["quantities"]);
  EXPECT_NE(summary({"mesh.order=1"})["quantities"], plain["quantities"]);
  const Ended ended = dielast({"run", "small.toml", "--set", "drive.chage="});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("drive.chage: there is no such key to remove"), std::string::npos) << ended.err;
  EXPECT_EQ(dielast({"check", "small.toml", "--set", "drive="}).exit_code, 0);
}

TEST_F(OverrideCommand, WrongOnesAreReportedByTheirOwnWords) {
  const Ended ended =
      dielast({"run", "small.toml", "--set", "honeycomb.angle=60 deg", "--set", "mesh.ordr=1"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("--set honeycomb.angle=60 deg"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("cells close up at 60 deg"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("did you mean \"order\"?"), std::string::npos) << ended.err;
  EXPECT_FALSE(exists("small-results"));
  for (const char* path :
       {"mesh..order=1", ".mesh.order=1", "mesh.=1", "mesh.\"order=1", "step[1x].increments=2"})
    EXPECT_EQ(dielast({"check", "small.toml", "--set", path}).exit_code, 2) << path;
  EXPECT_EQ(dielast({"check", "small.toml", "--set", " mesh . order = 1"}).exit_code, 0);
}

} // namespace
} // namespace dielast::test::overrides_test
