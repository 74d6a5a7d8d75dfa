// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/scratch_folder.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace dielast::fuzz {

inline const std::filesystem::path source_folder = DIELAST_SOURCE_DIR;

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder of this process's own, removed when it ends well.
inline const std::filesystem::path& scratch() {
  static const test::ScratchFolder folder;
  return folder.path();
}

/// A property that must hold for every input does not.
[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}

inline void write(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream << bytes;
  stream.close();
  if (!stream) fail("cannot write " + file.string());
}

} // namespace dielast::fuzz
