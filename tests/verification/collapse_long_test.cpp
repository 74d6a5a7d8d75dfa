// SPDX-License-Identifier: GPL-3.0-or-later
// The honeycomb whose walls touch: what its strains owe to the mesh and to the barrier.
#include "cases/readers/reader.hpp"
#include "tests/cases/values_at_end.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::cases::collapse_long_test {
namespace {

std::map<std::string, double> collapsed(int beams, const char* thickness) {
  return test::values_at_end(read_case(
      std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/honeycomb/collapse.toml",
      {fmt::format("mesh.wall_elements={}", beams), fmt::format("contact.thickness={}", thickness)}));
}

void expect_alike(const std::map<std::string, double>& one, const std::map<std::string, double>& other) {
  for (const char* strain : {"eps_x", "eps_y"}) {
    ASSERT_GT(one.at(strain), 0.003);
    EXPECT_NEAR(one.at(strain), other.at(strain), 0.02 * one.at(strain)) << strain;
  }
}

TEST(CollapsedHoneycomb, HasTheStrainsOfMoreBeams) {
  expect_alike(collapsed(8, "4 um"), collapsed(12, "4 um"));
}

TEST(CollapsedHoneycomb, HasTheStrainsOfHalfTheBarrier) {
  expect_alike(collapsed(8, "2 um"), collapsed(8, "1 um"));
}

} // namespace
} // namespace dielast::cases::collapse_long_test
