// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"
#include "tests/cases/gallery_files.hpp"

#include <cstdlib>
#include <map>

namespace dielast::test::golden_test {
namespace {

/// Every case of the gallery has a file of what all its quantities are at the end, at full digits:
///   "set":        what makes the case short;
///   "bound":      allowed difference over the scale of a value, by default 1e-12, which holds for the linear
///                 algebra of every processor (OPENBLAS_CORETYPE) and for both compilers; 1e-11 where
///                 stresses of MPa cancel, 1e-9 where they do so after a jump, where thin shells bend (the
///                 last digit decides on one iteration more), for stiffnesses of wrinkled film, and where
///                 time passes: its steps are chosen by their errors, and the last digit may decide on one;
///   "quantities": values and units, as in summary.json.
/// What changes numbers on purpose makes the files again and says so in its commit:
///   DIELAST_REMAKE_GOLDEN=1 build/bin/golden_test
const std::filesystem::path golden = source_folder / "tests/verification/golden";

constexpr double everywhere = 1e-12;

/// The largest value in the same unit, but of stresses at least that of a soft film: without loads they are
/// round-off.
std::map<std::string, double> scales(const nlohmann::json& quantities) {
  std::map<std::string, double> scales{{"Pa", 1e3}};
  for (const auto& quantity : quantities)
    if (const auto& value = quantity["value"]; value.is_number()) {
      double& scale = scales[quantity["unit"]];
      scale = std::max(scale, std::abs(value.get<double>()));
    }
  return scales;
}

class GoldenCase : public CommandTest, public testing::WithParamInterface<std::string> {
 protected:
  /// Values and units at the end of the case with these settings.
  nlohmann::json quantities(const nlohmann::json& settings) const {
    std::vector<std::string> words{"run", gallery / GetParam(), "-o", "out"};
    for (const char* cut : {"output.error_estimate=false", "output.fields=false"})
      words.insert(words.end(), {"--set", cut});
    for (const auto& setting : settings) words.insert(words.end(), {"--set", setting.get<std::string>()});
    const Ended ended = dielast(words);
    // Checks are of the whole case: the short one may fail them.
    EXPECT_TRUE(ended.exit_code == 0 || ended.exit_code == 5) << ended.out << ended.err;
    nlohmann::json quantities;
    const nlohmann::json summary = json_of("out/summary.json");
    EXPECT_EQ(summary["status"], "complete");
    for (const auto& [name, quantity] : summary["quantities"].items())
      quantities[name] = {{"value", quantity["value"]}, {"unit", quantity["unit"]}};
    return quantities;
  }
};

TEST_P(GoldenCase, EndsWithTheNumbersThatItHad) {
  const std::filesystem::path file = golden / (word_of(GetParam()) + ".json");
  nlohmann::json before = {{"set", nlohmann::json::array()}};
  if (exists(file)) before = nlohmann::json::parse(text_of(file));
  const nlohmann::json now = quantities(before["set"]);
  if (std::getenv("DIELAST_REMAKE_GOLDEN")) {
    before["quantities"] = now;
    std::ofstream(file) << before.dump(1) << "\n";
    GTEST_SKIP() << "made again: " << file;
  }
  ASSERT_TRUE(exists(file)) << "make it: DIELAST_REMAKE_GOLDEN=1 build/bin/golden_test";
  const double bound = before.value("bound", everywhere);
  const auto scale = scales(before["quantities"]);
  for (const auto& [name, expected] : before["quantities"].items()) {
    ASSERT_TRUE(now.contains(name)) << name;
    EXPECT_EQ(now[name]["unit"], expected["unit"]) << name;
    ASSERT_EQ(now[name]["value"].is_null(), expected["value"].is_null()) << name;
    if (expected["value"].is_null()) continue;
    EXPECT_NEAR(now[name]["value"], expected["value"], bound * scale.at(expected["unit"])) << name;
  }
  EXPECT_EQ(now.size(), before["quantities"].size()) << "a quantity without its number: make the file again";
}

INSTANTIATE_TEST_SUITE_P(Gallery, GoldenCase, testing::ValuesIn(gallery_files(false)),
                         [](const auto& file) { return word_of(file.param); });

TEST(Golden, FilesAreOfCasesThatExist) {
  std::vector<std::string> words;
  for (const std::string& file : gallery_files(false)) words.push_back(word_of(file));
  for (const auto& entry : std::filesystem::directory_iterator(golden))
    EXPECT_EQ(std::count(words.begin(), words.end(), entry.path().stem()), 1) << entry.path();
}

} // namespace
} // namespace dielast::test::golden_test
