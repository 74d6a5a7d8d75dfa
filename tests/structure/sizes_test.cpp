// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/structure/sources.hpp"

#include <gtest/gtest.h>

#include <map>

namespace dielast::test::sizes_test {
namespace {

const std::vector<std::string> rooms{"materials", "meshing", "fem", "post", "cases"};

TEST(Sizes, NoSourceFileHasMoreThan400Lines) {
  std::vector<std::string> folders = rooms;
  folders.emplace_back("tests");
  for (const std::string& folder : folders)
    for (const auto& file : files_below(folder, is_source))
      EXPECT_LE(std::ranges::count(text_of(source_folder / file), '\n'), 400) << file;
}

// A folder is a subject that a newcomer can survey.
TEST(Sizes, NoFolderHasMoreThan25SourceFiles) {
  std::map<std::string, int> counts;
  for (const std::string& room : rooms)
    for (const auto& file : files_below(room, is_source)) ++counts[file.parent_path()];
  ASSERT_GE(counts.size(), rooms.size());
  for (const auto& [folder, count] : counts) EXPECT_LE(count, 25) << folder;
}

} // namespace
} // namespace dielast::test::sizes_test
