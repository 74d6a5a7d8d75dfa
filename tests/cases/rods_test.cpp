// SPDX-License-Identifier: GPL-3.0-or-later
// Rods of film: against closed forms, a patch in uniaxial tension, and the antagonistic rolls' reduced model.
#include "cases/runs/simulation.hpp"
#include "tests/cases/case_test.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace dielast::cases::rods_test {
namespace {

class Rods : public test::CaseTest {};

const std::string elastomer = R"toml(
[film.material]
law = "yeoh"
c1 = "17 kPa"
c2 = "3.86 kPa"
c3 = "-68.9 Pa"
relative_permittivity = 2.8
)toml";

/// Two layers of 0.1 x 141 mm, of which 125.83 x 15 mm under the electrode; 21 mm long, prestretched by 1.05.
std::string roll(const std::string& rest) {
  return R"toml(
model = "planar"
[film]
thickness = "0.1 mm"
prestretch = 1.05
)toml" + elastomer +
         R"toml(
[line]
to = ["22.05 mm", 0, 0]
[rod]
width = "141 mm"
layers = 2
electrode_width = "125.83 mm"
electrode_length = "15 mm"
[[support]]
place = "start"
fix = ["x", "y"]
[[support]]
place = "end"
fix = ["y"]
)toml" + rest;
}

constexpr double section = 2 * 0.1e-3 * 141e-3, electrode = 2 * 125.83e-3 * 15e-3; // m^2
constexpr double permittivity = 2.8 * 8.8541878128e-12;

double force_of(double stretch, double voltage) {
  const double excess = stretch * stretch + 2 / stretch - 3;
  const double slope = 17e3 + 2 * 3.86e3 * excess + 3 * -68.9 * excess * excess;
  return section * 2 * slope * (stretch - 1 / (stretch * stretch)) -
         0.5 * permittivity * electrode / 0.1e-3 * voltage * voltage / 21e-3;
}

TEST_F(Rods, PullByTheirLawLessTheField) {
  const auto held = values(roll(R"toml(
[drive]
voltage = "1200 V"
[[support]]
place = "end"
fix = ["x"]
[[step]]
kind = "voltage"
[[quantity]]
name = "force"
kind = "force"
of = "end"
along = "x"
[[quantity]]
name = "mean_stress"
kind = "value"
of = "cauchy_stress.xx"
place = "film"
[[quantity]]
name = "stress_at_end"
kind = "value"
of = "cauchy_stress.xx"
place = "end"
[[quantity]]
name = "largest_stress"
kind = "extreme"
of = "max_principal_stress"
extreme = "maximum"
)toml"));
  EXPECT_NEAR(held.at("force"), force_of(1.05, 1200), 1e-10 * force_of(1.05, 1200));
  const double mean = 1.05 * held.at("force") / section; // of film under the electrode and beside it
  EXPECT_NEAR(held.at("mean_stress"), mean, 1e-10 * mean);
  EXPECT_NEAR(held.at("stress_at_end"), mean, 1e-10 * mean);
  const double uncharged = 1.05 * force_of(1.05, 0) / section;
  EXPECT_NEAR(held.at("largest_stress"), uncharged, 1e-10 * uncharged);
  EXPECT_NEAR(held.at("max_field"), 1200 / 0.1e-3 * std::sqrt(1.05), 1e-3);
  const double capacitance = permittivity * electrode / 0.1e-3 * 1.05;
  EXPECT_NEAR(held.at("capacitance"), capacitance, 1e-10 * capacitance);
}

TEST_F(Rods, LengthenUntilTheyBalanceALoad) {
  const auto loaded = values(roll(R"toml(
[drive]
voltage = "2 kV"
[[load]]
place = "end"
force = ["0.3 N", 0, 0]
[[step]]
kind = "force"
[[step]]
kind = "voltage"
[[quantity]]
name = "length"
kind = "distance"
between = ["start", "end"]
)toml"));
  EXPECT_NEAR(force_of(loaded.at("length") / 21e-3, 2000), 0.3, 1e-9);
}

/// A patch that is free on its sides and carries no field is in uniaxial tension, as a rod is.
TEST_F(Rods, TheirBranchesRelaxAsThoseOfAPatchInUniaxialTension) {
  const std::string material = R"toml(
[film]
thickness = "0.1 mm"
[film.material]
law = "gent"
shear_modulus = "20 kPa"
stretch_limit = 80
relative_permittivity = 4
[[film.material.branch]]
shear_modulus = "30 kPa"
relaxation_time = "2 s"
[[film.material.branch]]
law = "gent"
shear_modulus = "10 kPa"
stretch_limit = 50
relaxation_time = "20 s"
)toml";
  const std::string steps = R"toml(
[[step]]
name = "pull"
kind = "move"
response = "instantaneous"
[[step]]
kind = "hold"
duration = "5 s"
)toml";
  const auto patch =
      values(material + "[patch]\nlength = \"10 mm\"\nwidth = \"20 mm\"\nstretch_x = 1.8\n" + steps);
  const auto rod = values("model = \"planar\"\n" + material + R"toml(
[line]
to = ["10 mm", 0, 0]
[rod]
width = "20 mm"
[[support]]
place = "start"
fix = ["x", "y"]
[[support]]
place = "end"
fix = ["y"]
[support.displacement]
x = "8 mm"
[[quantity]]
name = "force"
kind = "force"
of = "end"
along = "x"
)toml" + steps);
  EXPECT_NEAR(rod.at("force"), patch.at("stress_x") * 0.1e-3 * 20e-3, 1e-8 * rod.at("force"));
  EXPECT_NEAR(rod.at("dissipated_energy"), patch.at("dissipated_energy"), 1e-6 * rod.at("dissipated_energy"));
}

/// Let go before its load pulls it taut a prestretched rod has no stiffness across itself, but for rounding,
/// which told prestretches of 1.2, 1.25, 1.3 and 2 to be unstable.
TEST_F(Rods, HangFromAnyPrestretch) {
  for (const double prestretch : {1.1, 1.2, 1.25, 1.3, 1.5, 2.0}) {
    const double hung = values(fmt::format(R"toml(
model = "3d"
[film]
thickness = "0.2 mm"
prestretch = {}
[film.material]
shear_modulus = "60 kPa"
relative_permittivity = 4.7
[line]
to = [0, 0, "-50 mm"]
[rod]
width = "20 mm"
[[support]]
place = "start"
fix = ["x", "y", "z"]
[[body]]
name = "m"
places = ["end"]
mass = "20 g"
fix = ["turn_x", "turn_y", "turn_z"]
[gravity]
direction = [0, 0, -1]
[[step]]
kind = "weight"
[[quantity]]
name = "length"
kind = "distance"
between = ["start", "end"]
)toml",
                                           prestretch))
                            .at("length");
    const double stretch = hung / (50e-3 / prestretch), section = 0.2e-3 * 20e-3;
    EXPECT_NEAR(section * 60e3 * (stretch - 1 / (stretch * stretch)), 20e-3 * 9.81, 1e-8) << prestretch;
  }
}

/// A ribbon that the charged roll would push goes slack: the other roll alone turns the tip, whatever the
/// voltage. Down to such a state the energy falls along a valley that is all but flat.
TEST_F(Rods, ARollWhoseRibbonGoesSlackLetsItsTipGo) {
  const auto tip_angle = [this](const char* voltage, const char* key, const char* word) {
    return values(fmt::format(R"toml(
[film]
thickness = "100 um"
prestretch = 1.02
{}[antagonistic_rolls]
width = "141 mm"
layers = 2
electrode_width = "125.8866 mm"
electrode_length = "15 mm"
length = "21 mm"
arm = "0.4 mm"
[hinge]
length = "1 mm"
width = "5 mm"
thickness = "50 um"
material = {{ youngs_modulus = "3.3 GPa", poisson_ratio = 0.3 }}
[ribbon]
length = "2 mm"
width = "5 mm"
thickness = "25 um"
material = {{ youngs_modulus = "2.675 GPa", poisson_ratio = 0.3 }}
[drive.upper]
voltage = "{}"
[drive.lower]
voltage = "0 V"
[[step]]
kind = "release"
[[step]]
kind = "voltage"
{} = "{}"
[output]
error_estimate = false
)toml",
                              elastomer, voltage, key, word))
        .at("tip_angle");
  };
  const double slack = tip_angle("2 kV", "on_instability", "jump");
  EXPECT_NEAR(slack, 0.1340040, 1e-7);
  EXPECT_NEAR(slack, tip_angle("1.8 kV", "on_bifurcation", "switch"), 1e-6);
}

// Its own supports hold it in space as in its plane.
TEST_F(Rods, AntagonisticRollsTurnTheirTipInSpaceAsInThePlane) {
  const auto tip_angle = [](const char* model) {
    const Case one =
        read_case(std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/antagonistic_rolls/case.toml",
                  {"check=", "output.error_estimate=false", "output.fields=false", model});
    Simulation simulation(one, 1);
    const Outcome outcome = simulation.run({});
    EXPECT_EQ(outcome.ending, Ending::complete) << outcome.message;
    const auto angle = std::ranges::find(one.quantities, "tip_angle", &Quantity::name);
    return simulation.results()[static_cast<std::size_t>(angle - one.quantities.begin())];
  };
  const double in_its_plane = tip_angle("model=planar");
  EXPECT_NEAR(in_its_plane, 0.073, 0.001);
  EXPECT_NEAR(tip_angle("model=3d"), in_its_plane, 1e-9);
}

TEST_F(Rods, AnElectrodeLongerThanTheRodIsRefused) {
  write("case.toml", roll("[drive]\nvoltage = \"1 kV\"\n"));
  Case one = read_case(directory / "case.toml", {"rod.electrode_length=22 mm"});
  EXPECT_THROW(build_device(one), CaseError);
}

} // namespace
} // namespace dielast::cases::rods_test
