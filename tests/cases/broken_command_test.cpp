// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <algorithm>

namespace dielast::test::broken_command_test {
namespace {

const std::filesystem::path folder = source_folder / "tests/cases/broken";

std::vector<std::string> broken_files() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

/// Values of the comment lines "# key: value" at the head of a file.
std::vector<std::string> header(const std::string& text, const std::string& key) {
  std::vector<std::string> values;
  const std::string start = "# " + key + ": ";
  for (const std::string& line : lines_of(text)) {
    if (!line.starts_with("# ")) break;
    if (line.starts_with(start)) values.push_back(line.substr(start.size()));
  }
  return values;
}

class BrokenCommand : public CommandTest, public testing::WithParamInterface<std::string> {};

TEST_P(BrokenCommand, SaysWhatIsWrongBeforeAnythingRuns) {
  const std::string text = text_of(folder / GetParam());
  const std::vector<std::string> read = header(text, "read"); // the command, other than "run"
  std::vector<std::string> words{read.empty() ? "run" : read.front(), GetParam(), "-o",
                                 directory / "results"};
  for (const std::string& assignment : header(text, "set")) {
    words.emplace_back("--set");
    words.push_back(assignment);
  }
  const Ended ended = dielast_in(folder, words);
  std::string expected;
  for (const std::string& line : header(text, "expect")) expected += line + "\n";
  EXPECT_EQ(ended.err, expected);
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(std::to_string(ended.exit_code), header(text, "exit").at(0));
  EXPECT_FALSE(exists("results"));
}

INSTANTIATE_TEST_SUITE_P(Files, BrokenCommand, testing::ValuesIn(broken_files()),
                         [](const auto& file) { return file.param.substr(0, file.param.find('.')); });

} // namespace
} // namespace dielast::test::broken_command_test
