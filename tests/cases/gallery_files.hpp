// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/cases/scratch.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace dielast::test {

inline const std::filesystem::path gallery = source_folder / "cases/gallery";

/// Case files of the gallery, or its studies: paths within it. Fits have a test of their own.
inline std::vector<std::string> gallery_files(bool studies) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(gallery))
    if (entry.path().extension() == ".toml") {
      const std::string text = text_of(entry.path());
      const bool fits = text.find("\n[fit]") != std::string::npos ||
                        text.find("\n[identify]") != std::string::npos ||
                        text.find("\n[[rational]]") != std::string::npos;
      if (!fits && (text.find("\n[study]") != std::string::npos) == studies)
        files.push_back(std::filesystem::relative(entry.path(), gallery));
    }
  std::sort(files.begin(), files.end());
  return files;
}

/// "diaphragm/case.toml" as a word: "diaphragm_case".
inline std::string word_of(const std::string& file) {
  std::string name = file.substr(0, file.rfind('.'));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
  return name;
}

} // namespace dielast::test
