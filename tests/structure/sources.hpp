// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace dielast::test {

inline const std::filesystem::path source_folder = DIELAST_SOURCE_DIR;

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline bool is_source(const std::filesystem::path& file) {
  return file.extension() == ".cpp" || file.extension() == ".hpp";
}

/// Every file below a folder of the project for which `wanted` holds, relative to the project, sorted.
template<class Wanted>
std::vector<std::filesystem::path> files_below(const std::string& folder, const Wanted& wanted) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_folder / folder))
    if (entry.is_regular_file() && wanted(entry.path()))
      files.push_back(entry.path().lexically_relative(source_folder));
  std::ranges::sort(files);
  return files;
}

} // namespace dielast::test
