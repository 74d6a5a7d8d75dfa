// SPDX-License-Identifier: GPL-3.0-or-later
// Identification of devices: the table of the hung stack, and a diaphragm from a transient.
#include "cases/fits/device_model.hpp"
#include "cases/fits/identify.hpp"
#include "cases/readers/identify_reader.hpp"
#include "tests/cases/scratch.hpp"
#include "tests/cases/values_at_end.hpp"

#include "cases/readers/reader.hpp"

namespace dielast::cases::identify_test {
namespace {

std::vector<std::string> assignments(const Identification& asked, const IdentifyOutcome& found) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < asked.unknowns.size(); ++i)
    all.push_back(asked.unknowns[i].assignment(found.unknowns[i].value));
  return all;
}

// From the table's values turned into responses the table comes back: K, B, C, Rs, Rp; C1 by the peak.
TEST(Identification, ReturnsTheTableOfTheHungStack) {
  Identification asked = read_identification(std::filesystem::path(DIELAST_SOURCE_DIR) /
                                             "cases/gallery/hung_stack/identify.toml");
  const IdentifyOutcome found = solve_identification(asked, 2, {});
  ASSERT_EQ(found.ending, FitEnding::converged);
  EXPECT_NEAR(found.unknowns[4].value, 202, 0.005 * 202);   // Rs, kOhm
  EXPECT_NEAR(found.unknowns[5].value, 6.10, 0.005 * 6.10); // Rp, GOhm
  const auto values = test::values_at_end(read_case(asked.base, assignments(asked, found)));
  EXPECT_NEAR(values.at("stiffness"), 1110, 0.005 * 1110);
  EXPECT_NEAR(values.at("capacitance"), 0.561e-9, 0.005 * 0.561e-9);
  const double permittivity = found.unknowns[2].value * 8.8541878128e-12;
  const double drive = values.at("coupling") * 10 * permittivity * 10e-3 / 50e-6; // coupling C/l_e
  EXPECT_NEAR(drive, 25.3e-9, 0.005 * 25.3e-9);
  for (const double error : found.errors) EXPECT_LT(error, 0.005);
}

class Transient : public test::ScratchTest {};

// A diaphragm with a branch whose source steps up behind a resistance: modulus, damping and resistance.
TEST_F(Transient, TellsModulusDampingAndResistance) {
  write("case.toml", R"toml(
model = "axisymmetric"
[film]
thickness = "1 mm"
prestretch = 2.0
[film.material]
shear_modulus = "40 kPa"
relative_permittivity = 4.7
[[film.material.branch]]
shear_modulus = "10 kPa"
relaxation_time = "0.3 s"
[annulus]
inner_radius = "12.7 mm"
outer_radius = "68.58 mm"
[plate]
mass = "100 g"
damping = "1.6 N.s/m"
[circuit]
resistance = "20 MOhm"
[drive]
voltage = { wave = "step", to = "5 kV", at = "0.02 s" }
[mesh]
rings = 8
[[step]]
kind = "weight"
[[step]]
kind = "transient"
duration = "0.4 s"
increments = 40
)toml");
  std::string table = "time[s],stroke[mm]\n";
  for (int i = 1; i <= 40; ++i) table += std::to_string(0.01 * i) + ",1\n";
  write("t.csv", table);
  write("identify.toml", R"toml(
case = "case.toml"
[identify]
unknowns = ["film.material.shear_modulus", "plate.damping", "circuit.resistance"]
[[identify.test]]
file = "t.csv"
quantity = "stroke"
)toml");
  Identification asked = read_identification(directory / "identify.toml");
  const std::vector<double> truth{45, 1.2, 30}; // kPa, N s/m, MOhm
  const std::vector<double> model = DeviceModel(asked).run(0, truth);
  for (std::size_t i = 0; i < model.size(); ++i) asked.tests[0].measured[i] = model[i];
  const IdentifyOutcome found = solve_identification(asked, 2, {});
  EXPECT_EQ(found.ending, FitEnding::converged);
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_NEAR(found.unknowns[i].value, truth[i], 0.01 * truth[i]) << asked.unknowns[i].key;
}

} // namespace
} // namespace dielast::cases::identify_test
