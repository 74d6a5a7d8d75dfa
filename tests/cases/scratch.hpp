// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace dielast::test {

inline const std::filesystem::path source_folder = DIELAST_SOURCE_DIR;

/// A honeycomb of five cells that runs in a fraction of a second.
inline const std::string small_honeycomb = R"toml(title = "Small honeycomb"
[film]
material = "VHB 4910 (honeycomb)"
thickness = "1 mm"
prestretch = [4.0, 2.5]
[honeycomb]
angle = "150 deg"
columns = [2, 1, 2]
wall_length = "8 mm"
wall_width = "0.8 mm"
wall_height = "2 mm"
[drive]
voltage = "6 kV"
[mesh]
wall_elements = 2
[[step]]
kind = "release"
[[step]]
kind = "voltage"
increments = 3
)toml";

inline const std::string small_disc = R"toml(title = "Small disc"
[film]
material = "VHB 4910 (honeycomb)"
thickness = "1 mm"
prestretch = 3
[disc]
radius = "90 mm"
electrode_radius = "30 mm"
[drive]
voltage = "5 kV"
[mesh]
rings = 6
[[step]]
kind = "voltage"
increments = 2
)toml";

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A test with a directory of its own, and small cases in it.
class ScratchTest : public testing::Test {
 protected:
  void SetUp() override {
    write("small.toml", small_honeycomb);
    write("disc.toml", small_disc);
  }

  void write(const std::string& file, const std::string& text) const {
    std::ofstream(directory / file, std::ios::binary) << text;
  }
  std::string content(const std::string& file) const { return text_of(directory / file); }
  bool exists(const std::string& file) const { return std::filesystem::exists(directory / file); }

  const ScratchFolder scratch;
  const std::filesystem::path directory = scratch.path();
};

} // namespace dielast::test
