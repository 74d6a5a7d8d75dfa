// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/reader.hpp"
#include "cases/readers/resolved.hpp"
#include "cases/readers/study_reader.hpp"
#include "tests/cases/command.hpp"
#include "tests/cases/gallery_files.hpp"

namespace dielast::test::gallery_test {
namespace {

std::string test_name(const testing::TestParamInfo<std::string>& file) { return word_of(file.param); }

class GalleryCase : public CommandTest, public testing::WithParamInterface<std::string> {};

TEST_P(GalleryCase, PassesItsChecks) {
  const Ended ended = dielast({"run", gallery / GetParam(), "-o", "out"});
  EXPECT_EQ(ended.exit_code, 0) << ended.out << ended.err;
  const nlohmann::json summary = json_of("out/summary.json");
  EXPECT_FALSE(summary["checks"].empty());
  for (const auto& check : summary["checks"]) EXPECT_EQ(check["passed"], true) << check.dump(1);

  // The energy balance closes: to 1e-8 of the work, with branches to 1e-5. Where a drive goes to and fro the
  // net work is next to nothing; there it is taken against what 1200 periods of 4 kV put in and take out.
  const auto energy = [&](const char* part) {
    return std::abs(summary["quantities"][part]["value"].get<double>());
  };
  const bool flows = energy("dissipated_energy") > 0;
  const double work = std::max(energy("electrical_work"), energy("mechanical_work"));
  const bool to_and_fro = GetParam().ends_with("cycles.toml");
  const double scale = to_and_fro ? 1200 * energy("capacitance") * 4000.0 * 4000.0 / 2 : work;
  EXPECT_LT(energy("energy_error"), (flows ? 1e-5 : 1e-8) * scale);
}

TEST_P(GalleryCase, IsTheSameCaseWhenItsResolvedTextIsRead) {
  const std::string resolved = cases::resolved_text(cases::read_case(gallery / GetParam()));
  write("resolved.toml", resolved);
  EXPECT_EQ(cases::resolved_text(cases::read_case(directory / "resolved.toml")), resolved);
}

INSTANTIATE_TEST_SUITE_P(Gallery, GalleryCase, testing::ValuesIn(gallery_files(false)), test_name);

class GalleryStudy : public testing::TestWithParam<std::string> {};

TEST_P(GalleryStudy, IsValid) {
  const cases::Study study = cases::read_study(gallery / GetParam());
  EXPECT_FALSE(study.axes.empty());
  EXPECT_TRUE(std::filesystem::exists(study.base));
}

INSTANTIATE_TEST_SUITE_P(Gallery, GalleryStudy, testing::ValuesIn(gallery_files(true)), test_name);

} // namespace
} // namespace dielast::test::gallery_test
