// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/identify_reader.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/study_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace dielast::cases::broken_test {
namespace {

const std::filesystem::path folder = std::filesystem::path(DIELAST_SOURCE_DIR) / "tests/cases/broken";

std::vector<std::string> broken_files() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

/// Values of the comment lines "# key: value" at the head of a file.
std::vector<std::string> header(const std::string& file, const std::string& key) {
  std::ifstream stream(file);
  std::vector<std::string> values;
  const std::string start = "# " + key + ": ";
  for (std::string line; std::getline(stream, line) && line.starts_with("# ");)
    if (line.starts_with(start)) values.push_back(line.substr(start.size()));
  return values;
}

/// Every file says what is wrong with it: "# expect: message" once per error, "# exit: code", and where
/// needed
/// "# set: key=value" and "# read: study" or "# read: fit".
class BrokenCase : public testing::TestWithParam<std::string> {};

TEST_P(BrokenCase, IsReportedExactly) {
  std::filesystem::current_path(folder); // messages name the file as the user does
  const std::string& file = GetParam();
  const auto expected = header(file, "expect");
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(header(file, "exit"), std::vector<std::string>{"2"});
  std::vector<std::string> found;
  try {
    if (header(file, "read") == std::vector<std::string>{"study"})
      read_study(file);
    else if (header(file, "read") == std::vector<std::string>{"fit"})
      read_rational_fits(file);
    else
      read_case(file, header(file, "set"));
  } catch (const CaseError& error) {
    for (const Diagnostic& diagnostic : error.diagnostics()) found.push_back(diagnostic.text());
    std::ostringstream lines;
    for (std::size_t i = 0; i < found.size(); ++i) lines << (i ? "\n" : "") << found[i];
    EXPECT_EQ(lines.str(), error.what());
  }
  EXPECT_EQ(found, expected);
}

INSTANTIATE_TEST_SUITE_P(Files, BrokenCase, testing::ValuesIn(broken_files()), [](const auto& file) {
  std::string name = file.param.substr(0, file.param.find('.'));
  return name;
});

} // namespace
} // namespace dielast::cases::broken_test
