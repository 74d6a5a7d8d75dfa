// SPDX-License-Identifier: GPL-3.0-or-later
// The gallery's manipulator against an independent program's nonlinear membrane elements: mu = 40 kPa, the
// plate pushed up by 10 mm, one sector charged.
#include "cases/readers/reader.hpp"
#include "tests/cases/values_at_end.hpp"

#include <fmt/format.h>

#include <numbers>

namespace dielast::cases::manipulator_test {
namespace {

constexpr double degree = std::numbers::pi / 180;

std::map<std::string, double> solved(const std::vector<std::string>& overrides) {
  return test::values_at_end(read_case(
      std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/manipulator/case.toml", overrides));
}

void expect_tilt(const std::string& voltage, double degrees) {
  const double tilt = solved({fmt::format("drive.a.voltage={}", voltage)}).at("tilt_x") / degree;
  EXPECT_NEAR(tilt, degrees, 0.002 * degrees) << voltage;
}

TEST(Manipulator, TiltsAsTheReference) {
  expect_tilt("1 kV", 0.024510);
  expect_tilt("2.5 kV", 0.15643);
  expect_tilt("5 kV", 0.67625);
}

TEST(Manipulator, PushesOnItsPivotAsTheReference) {
  EXPECT_NEAR(solved({}).at("pivot_force"), 1.42803, 0.002 * 1.42803);
}

TEST(Manipulator, TiltsLessWhereStripsBetweenTheSectorsAreBare) {
  EXPECT_NEAR(solved({"sectors.gap=5 mm"}).at("tilt_x") / degree, 0.601, 0.01 * 0.601);
}

// Each sector turns the plate about its own axis, b about y as a about x.
TEST(Manipulator, SectorsAreAlikeAndSuperposeAtOneKilovolt) {
  const std::string coarser = "mesh.rings=12";
  const auto a = solved({coarser, "drive.a.voltage=1 kV"});
  const auto b = solved({coarser, "drive.a.voltage=0 V", "drive.b.voltage=1 kV"});
  const auto both = solved({coarser, "drive.a.voltage=1 kV", "drive.b.voltage=1 kV"});
  const auto opposite = solved({coarser, "drive.a.voltage=1 kV", "drive.c.voltage=1 kV"});
  const double tilt = a.at("tilt_x");
  EXPECT_GT(tilt, 0);
  EXPECT_NEAR(b.at("tilt_y"), tilt, 1e-4 * tilt);
  EXPECT_NEAR(both.at("tilt_x"), tilt + b.at("tilt_x"), 2e-3 * tilt);
  EXPECT_NEAR(both.at("tilt_y"), b.at("tilt_y") + a.at("tilt_y"), 2e-3 * tilt);
  EXPECT_NEAR(opposite.at("tilt_x"), 0, 1e-9);
}

} // namespace
} // namespace dielast::cases::manipulator_test
