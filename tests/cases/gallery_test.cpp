#include "cases/study_reader.hpp"
#include "tests/cases/command.hpp"

#include <algorithm>

namespace dielast::test {
namespace {

const std::filesystem::path gallery = source_folder / "cases/gallery";

/// Case files of the gallery, or its studies: paths within it.
std::vector<std::string> gallery_files(bool studies) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(gallery))
    if (entry.path().extension() == ".toml" &&
        (text_of(entry.path()).find("\n[study]") != std::string::npos) == studies)
      files.push_back(std::filesystem::relative(entry.path(), gallery));
  std::sort(files.begin(), files.end());
  return files;
}

std::string test_name(const testing::TestParamInfo<std::string>& file) {
  std::string name = file.param.substr(0, file.param.rfind('.'));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
  return name;
}

class GalleryCase : public CommandTest, public testing::WithParamInterface<std::string> {};

TEST_P(GalleryCase, PassesItsChecks) {
  const Ended ended = dielast({"run", gallery / GetParam(), "-o", "out"});
  EXPECT_EQ(ended.exit_code, 0) << ended.out << ended.err;
  const nlohmann::json summary = json_of("out/summary.json");
  EXPECT_FALSE(summary["checks"].empty());
  for (const auto& check : summary["checks"]) EXPECT_EQ(check["passed"], true) << check.dump(1);
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
} // namespace dielast::test
