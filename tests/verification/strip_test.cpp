// SPDX-License-Identifier: GPL-3.0-or-later
// Strips and stacks against the independent numbers of their sources.
#include "cases/readers/reader.hpp"
#include "tests/cases/values_at_end.hpp"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

namespace dielast::cases::strip_test {
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

// Layers are bonded to their covers: it is the resultant over the section that is nothing across a long stack
// with free sides, and nothing wrinkles but in the corners of the clamps, though the covers compress the
// charged layers by 2.5 kPa.
TEST(HungStack, KeepsItsTensionBetweenItsCovers) {
  std::vector<std::string> overrides{
      "mesh.across=4",
      "strip.length=60 mm",
      "strip.width=10 mm",
      "strip.electrode_length=60 mm",
      "strip.electrode_width=10 mm",
      "strip.cover_thickness=200 um",
      "weight.mass=5 g",
      "quantity.hung_coupling={ name = 'hung_coupling', kind = 'value', of = 'min_principal_stress', point = "
      "['0 mm', '-30 mm', '0 mm'], at = 'voltage' }"};
  const auto taut = test::values_at_end(gallery_case("hung_stack/case.toml", overrides));
  EXPECT_NEAR(taut.at("hung_coupling"), 0, 20);
  EXPECT_GT(taut.at("stroke"), 70e-6);
  overrides.emplace_back("film.wrinkling='tension field'");
  const auto wrinkling = test::values_at_end(gallery_case("hung_stack/case.toml", overrides));
  for (const char* name : {"stroke", "capacitance"})
    EXPECT_NEAR(wrinkling.at(name), taut.at(name), 1e-3 * taut.at(name)) << name;
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

/// Rows of the harmonic step.
std::vector<std::vector<double>> response(const std::vector<std::string>& overrides) {
  const Case one = gallery_case("hung_stack/response.toml", overrides);
  Simulation simulation(one, 1);
  std::vector<std::vector<double>> rows;
  SimulationObserver observer;
  observer.on_analysis = [&](const Analysis& analysis, const fem::State&) { rows = analysis.rows; };
  EXPECT_EQ(simulation.run(observer).ending, Ending::complete);
  return rows;
}

// G = B/(M s^2 + C1 s + K) of the identified table: its value at rest and its peak.
TEST(HungStack, AnswersAsItsIdentifiedModel) {
  const std::vector<std::string> sweep{"step[3].from=1 Hz", "step[3].to=60 Hz", "step[3].points=300"};
  std::vector<std::string> light{"weight.mass=34.9 g",
                                 "film.material.shear_modulus=0.7164 MPa",
                                 "film.material.viscosity=222.1 Pa.s",
                                 "film.material.relative_permittivity=1.579",
                                 "strip.electrode_length=16.19 mm",
                                 "circuit.resistance=82.5 kOhm",
                                 "circuit.leakage_resistance=17.6 GOhm"};
  light.insert(light.end(), sweep.begin(), sweep.end());
  for (const auto& [overrides, rest, peak] :
       {std::tuple{sweep, 2.2793e-11, 3.2333e-10}, std::tuple{light, 1.2483e-11, 1.9743e-10}}) {
    const auto rows = response(overrides);
    double largest = 0;
    for (const auto& row : rows) largest = std::max(largest, row.back());
    const double ratio =
        rows[0][0] / (largest > 2.5e-10 ? 23.08 : 32.44); // G at 1 Hz is a little more than at rest
    EXPECT_NEAR(rows[0].back() * (1 - ratio * ratio), rest, 0.01 * rest);
    EXPECT_NEAR(largest, peak, 0.01 * peak);
  }
}

// A slow branch is felt above its corner: below it the stack answers with K1, above with K1 + K2.
TEST(HungStack, CreepsBelowTheCornerOfASlowBranch) {
  const std::vector<std::string> creeps{
      "film.material.branch=[{ shear_modulus = \"0.17061 MPa\", relaxation_time = \"1 s\" }]",
      "step[3].from=0.002 Hz", "step[3].to=2 Hz", "step[3].points=60", "circuit="};
  const auto rows = response(creeps);
  const double below = rows.front().back(), above = rows.back().back() * (1 - std::pow(2 / 25.5, 2));
  EXPECT_NEAR(below / above, 1.3, 0.01 * 1.3);
  double turn = 0;
  for (const auto& row : rows)
    if (row[2] < -5) turn = row[0];
  EXPECT_GT(turn, 0.1); // lags about 1/(2 pi tau) = 0.16 Hz
}

} // namespace
} // namespace dielast::cases::strip_test
