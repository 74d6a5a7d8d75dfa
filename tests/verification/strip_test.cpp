// SPDX-License-Identifier: GPL-3.0-or-later
// Strips and stacks against the independent numbers of their sources.
#include "cases/readers/reader.hpp"
#include "tests/cases/values_at_end.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::cases {
namespace {

Case gallery_case(const char* file, const std::vector<std::string>& overrides) {
  return read_case(std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery" / file, overrides);
}

std::map<std::string, double> hung_stack(double kilograms) {
  return test::values_at_end(
      gallery_case("hung_stack/case.toml", {fmt::format("weight.mass={} kg", kilograms), "drive.voltage=0",
                                            "gravity.film=false", "mesh.across=32"}));
}

// Plane stress, clamped ends, neo-Hookean film of 0.40 MPa; the coupling is that of no voltage.
TEST(HungStack, IsThatOfTheIndependentModel) {
  struct Reference {
    double mass, extension, stiffness, coupling;
  };
  for (const auto& [mass, extension, stiffness, coupling] :
       {Reference{52.8e-3, 0.65039e-3, 754.76, 0.6597}, Reference{34.9e-3, 0.42198e-3, 783.10, 0.6519}}) {
    const auto found = hung_stack(mass);
    EXPECT_NEAR(found.at("extension"), extension, 1e-3 * extension) << mass;
    EXPECT_NEAR(found.at("stiffness"), stiffness, 1e-3 * stiffness) << mass;
    EXPECT_NEAR(found.at("coupling"), coupling, 1e-3 * coupling) << mass;
  }
}

TEST(HungStack, IsStifferThanItsYoungsModulusTells) {
  const auto found = hung_stack(1e-6);
  const double uniaxial = 3 * 0.40e6 * 13e-3 * 0.6e-3 / 12e-3;
  EXPECT_NEAR(found.at("stiffness") / uniaxial, 1.0777, 0.001 * 1.0777);
  EXPECT_NEAR(found.at("coupling"), 0.637, 0.002 * 0.637);
}

// A strip that is long against its width is in uniaxial tension: stiffness and coupling of its closed forms.
TEST(HungStack, FarFromItsClampsIsInUniaxialTension) {
  const auto found = test::values_at_end(gallery_case(
      "hung_stack/case.toml", {"weight.mass=1e-3 g", "drive.voltage=0", "gravity.film=false",
                               "strip.length=500 mm", "strip.width=5 mm", "strip.electrode_length=500 mm",
                               "strip.electrode_width=5 mm", "mesh.across=2", "strip.cover_thickness=0 m"}));
  EXPECT_NEAR(found.at("coupling"), 0.5, 0.005);
  EXPECT_NEAR(found.at("stiffness"), 3 * 0.40e6 * 5e-3 * 0.5e-3 / 500e-3, 0.005 * 6);
}

// Chapter 3's table, of a film that is free across itself (a patch). Clamps hold the strip's width at its
// ends, where the field does more: the strip gives more strain, and less than one of held width.
TEST(Strip, GivesTheTableOfItsSource) {
  const double references[2][4] = {{0.320e-2, 0.350e-2, 0.362e-2, 0.355e-2},
                                   {0.739e-2, 0.814e-2, 0.853e-2, 0.854e-2}};
  for (int v = 0; v < 2; ++v)
    for (int m = 0; m < 4; ++m) {
      const double mass = 0.05 * (m + 1), volts = 2000 + 1000 * v;
      const auto free = test::values_at_end(gallery_case(
          "strip/uniaxial.toml", {fmt::format("drive.voltage={} V", volts),
                                  fmt::format("patch.stress_x={} Pa", mass * 9.80665 / (60e-3 * 0.5e-3))}));
      EXPECT_NEAR(free.at("strain"), references[v][m], 0.005 * references[v][m]) << mass << " kg " << volts;
      const auto clamped =
          test::values_at_end(gallery_case("strip/case.toml", {fmt::format("drive.voltage={} V", volts),
                                                               fmt::format("weight.mass={} kg", mass)}));
      EXPECT_GT(clamped.at("strain"), 1.05 * free.at("strain"));
      EXPECT_LT(clamped.at("strain"), 2 * free.at("strain"));
    }
}

} // namespace
} // namespace dielast::cases
