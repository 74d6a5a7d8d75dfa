// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <array>

namespace dielast::test::long_runs_test {
namespace {

class LongRuns : public CommandTest {
 protected:
  nlohmann::json summary(const std::string& folder) const { return json_of(folder + "/summary.json"); }
  static double percent(const nlohmann::json& summary, const char* quantity) {
    return 100 * summary["quantities"][quantity]["value"].get<double>();
  }
  const std::string gallery = source_folder / "cases/gallery/honeycomb";
};

// Threads are used from 16000 elements on.
TEST_F(LongRuns, OneAndTwoThreadsGiveTheSameBits) {
  for (const std::string threads : {"1", "2"})
    ASSERT_EQ(dielast({"run", gallery + "/case.toml", "-q", "-j", threads, "-o", "threads" + threads, "--set",
                       "mesh.wall_elements=24", "--set", "step.voltage.increments=2", "--set",
                       "drive.voltage=5 kV"})
                  .exit_code,
              0);
  ASSERT_GT(summary("threads1")["mesh"]["triangles"], 16000);
  for (const char* file : {"/history.csv", "/summary.json"})
    EXPECT_EQ(content(std::string("threads1") + file), content(std::string("threads2") + file)) << file;
}

struct Row {
  const char* prestretch;
  double converged_x, converged_y, paper_x, paper_y; ///< eps_x, eps_y in percent
};
/// Table 4: an independent planar model's converged values, and Abaqus's in the paper.
constexpr std::array table_4{
    Row{"[4, 2.5]", -3.52, 33.19, -3.32, 31.41},   Row{"[4, 2]", -3.53, 25.04, -3.28, 23.77},
    Row{"[3.2, 3.2]", -1.74, 32.56, -1.71, 30.97}, Row{"[3, 3]", -1.45, 27.91, -1.44, 26.59},
    Row{"[2.5, 4]", -0.60, 24.14, -0.62, 23.27},   Row{"[2, 4]", -0.25, 14.98, -0.27, 14.45}};

TEST_F(LongRuns, Table4) {
  const Ended ended = dielast({"study", gallery + "/table4.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
  ASSERT_EQ(lines_of(content("out/study.csv")).size(), table_4.size() + 1);
  for (std::size_t p = 0; p < table_4.size(); ++p) {
    const Row& row = table_4[p];
    const std::string folder = "out/point-000" + std::to_string(p + 1);
    EXPECT_NE(content(folder + "/resolved.toml").find(std::string("prestretch = ") + row.prestretch),
              std::string::npos);
    EXPECT_NEAR(percent(summary(folder), "eps_x"), row.converged_x, 0.05) << row.prestretch;
    EXPECT_NEAR(percent(summary(folder), "eps_y"), row.converged_y, 0.01 * row.converged_y) << row.prestretch;
  }
}

TEST_F(LongRuns, Table4OnThePapersMesh) {
  for (const Row& row : table_4) {
    ASSERT_EQ(dielast({"run", gallery + "/case.toml", "-q", "-o", "out", "--set", "mesh.wall_elements=5",
                       "--set", "mesh.order=1", "--set", std::string("film.prestretch=") + row.prestretch})
                  .exit_code,
              0);
    EXPECT_NEAR(percent(summary("out"), "eps_x"), row.paper_x, 0.1) << row.prestretch;
    EXPECT_NEAR(percent(summary("out"), "eps_y"), row.paper_y, 0.02 * row.paper_y) << row.prestretch;
  }
}

TEST_F(LongRuns, ContactOnReleaseOfTheWholeActuatorBelow77Degrees) {
  for (const auto& [angle, touches] : {std::pair{"70 deg", true},
                                       {"76 deg", true},
                                       {"77.5 deg", false},
                                       {"90 deg", false},
                                       {"150 deg", false}}) {
    ASSERT_EQ(dielast({"run", gallery + "/case.toml", "-q", "-o", "out", "--set",
                       std::string("honeycomb.angle=") + angle, "--set", "step=[{kind='release'}]", "--set",
                       "output.error_estimate=false", "--set", "output.fields=false"})
                  .exit_code,
              0)
        << angle;
    EXPECT_EQ(summary("out")["events"].dump().find("wall contact") != std::string::npos, touches) << angle;
  }
}

TEST_F(LongRuns, LimitPointOfTheActuator) {
  EXPECT_EQ(
      dielast({"run", gallery + "/case.toml", "-q", "-o", "out", "--set", "drive.voltage=10 kV"}).exit_code,
      4);
  const std::string message = summary("out")["message"];
  ASSERT_TRUE(message.starts_with("limit point near ")) << message;
  EXPECT_NEAR(std::stod(message.substr(17)), 8.5, 0.15) << message;
}

} // namespace
} // namespace dielast::test::long_runs_test
