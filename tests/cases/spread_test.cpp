// SPDX-License-Identifier: GPL-3.0-or-later
// What is spread over places, and means over them: against closed forms, in space and of revolution.
#include "cases/devices/device.hpp"
#include "cases/readers/reader.hpp"
#include "tests/cases/case_test.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::cases::spread_test {
namespace {

class Spread : public test::CaseTest {};

constexpr double film_tension = 40e3 * 1e-3 * (4 - 1.0 / 16) / 4, film_radius = 30e-3; // N/m, m

/// A disc that is prestretched twice, without weight.
std::string stretched_disc(const std::string& model, const std::string& rest) {
  return fmt::format(R"toml(
model = "{}"
[film]
thickness = "1 mm"
prestretch = 2
[film.material]
shear_modulus = "40 kPa"
relative_permittivity = 4
density = "0 kg/m^3"
[disc]
radius = "30 mm"
electrode_radius = "20 mm"
[output]
error_estimate = false
fields = false
[[quantity]]
name = "middle"
kind = "displacement"
of = "centre"
along = "z"
[[quantity]]
name = "mean"
kind = "displacement"
of = "film"
along = "z"
[[quantity]]
name = "under"
kind = "displacement"
of = "electrode"
along = "z"
[[quantity]]
name = "stiffness"
kind = "stiffness"
of = "electrode"
along = "z"
)toml",
                     model) +
         rest;
}

// F / (4 pi T) in the middle, which the mean of the paraboloid halves.
TEST_F(Spread, AForceOverAMembraneBulgesItToAParaboloid) {
  const double force = 2e-3, height = force / (4 * M_PI * film_tension);
  for (const char* model : {"axisymmetric", "3d"})
    for (const char* load :
         {"[[load]]\nplace = \"film\"\nforce = [0, 0, \"2 mN\"]\n[[step]]\nkind = \"force\"\n",
          "[[point_mass]]\nplace = \"film\"\nmass = \"0.203943243 g\"\n[gravity]\n"
          "direction = [0, 0, 1]\n[[step]]\nkind = \"weight\"\n"}) {
      const auto end = values(stretched_disc(model, load));
      EXPECT_NEAR(end.at("middle"), height, 1e-3 * height) << model << load;
      EXPECT_NEAR(end.at("mean"), height / 2, 1e-3 * height) << model << load;
      EXPECT_NEAR(end.at("under"), height * (1 - 2.0 / 9), 1e-3 * height) << model << load;
    }
}

// A force over r < b deflects the mean over it by F (ln(a/b) + 1/4) / (2 pi T); a spring stands beside it.
TEST_F(Spread, ASpringToAnAreaAddsItsStiffness) {
  const double stiffness = 2 * M_PI * film_tension / (std::log(1.5) + 0.25);
  const std::string still = "[chamber]\npressure = \"2 Pa\"\n[[step]]\nkind = \"pressure\"\n";
  for (const char* model : {"axisymmetric", "3d"}) {
    const auto bulged = values(stretched_disc(model, still));
    EXPECT_NEAR(bulged.at("stiffness"), stiffness, 2e-3 * stiffness) << model;
    const double height = 2 * film_radius * film_radius / (4 * film_tension);
    EXPECT_NEAR(bulged.at("mean"), height / 2, 1e-3 * height) << model;
    const auto sprung = values(stretched_disc(
        model, "[[spring]]\nbetween = [\"electrode\", \"rim\"]\nalong = \"z\"\nstiffness = \"100 N/m\"\n"
               "free_length = \"0 mm\"\n" +
                   still));
    EXPECT_NEAR(sprung.at("stiffness"), bulged.at("stiffness") + 100, 1e-2) << model;
    // in equilibrium with the spring's force over the electrode, by reciprocity
    EXPECT_NEAR(sprung.at("under"), bulged.at("under") / (1 + 100 / stiffness), 1e-3 * height) << model;
  }
}

// Between ends at one height rounding would say which way it pushes.
TEST_F(Spread, ASpringThatPushesKnowsWhichWay) {
  const auto refused = [&](const std::string& free_length) {
    write("spring.toml",
          stretched_disc("3d", "[[spring]]\nbetween = [\"electrode\", \"rim\"]\nalong = \"z\"\n"
                               "stiffness = \"100 N/m\"\nfree_length = \"" +
                                   free_length + "\"\n[[step]]\nkind = \"voltage\"\n"));
    try {
      build_device(read_case(directory / "spring.toml"));
    } catch (const CaseError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused("1 mm").find(R"("electrode" and "rim" are drawn at the same z)"), std::string::npos);
  EXPECT_EQ(refused("0 mm"), ""); // it pulls either way
}

// As of a bar: nothing is compressed and the edge stays straight, on any mesh.
TEST_F(Spread, AForceOnAnEdgeStretchesAStripUniformly) {
  for (const int across : {2, 5}) {
    const auto end = values(fmt::format(R"toml(
[film]
thickness = "1 mm"
[film.material]
shear_modulus = "50 kPa"
permittivity = "4e-11 F/m"
[rectangle]
length = "40 mm"
width = "20 mm"
[mesh]
across = {}
[output]
error_estimate = false
[[support]]
place = "left"
fix = ["x"]
[[support]]
place = "bottom"
fix = ["y"]
[[load]]
place = "right"
force = ["0.9 N", 0, 0]
[[step]]
kind = "force"
[[quantity]]
name = "mean"
kind = "displacement"
of = "right"
along = "x"
[[quantity]]
name = "furthest"
kind = "swelling"
of = "right"
along = "x"
[[quantity]]
name = "lowest"
kind = "extreme"
of = "min_principal_stress"
extreme = "minimum"
)toml",
                                        across));
    const double stretch = end.at("mean") / 40e-3 + 1;
    EXPECT_NEAR(stretch - 1 / (stretch * stretch), 0.9, 1e-7);
    EXPECT_NEAR(end.at("furthest"), end.at("mean"), 1e-9);
    EXPECT_NEAR(end.at("lowest"), 0, 1e-2);
  }
}

// As if the film had it: omega = 2.4048/a sqrt(T/(rho H)).
TEST_F(Spread, AMassOverAMembraneVibratesAsThatOfTheFilm) {
  const double mass = 1e-3, area = M_PI * film_radius * film_radius;
  const double omega = 2.404825557695773 / film_radius * std::sqrt(film_tension / (mass / area));
  for (const char* model : {"axisymmetric", "3d"}) {
    const auto end = values(
        stretched_disc(model, "[[point_mass]]\nplace = \"film\"\nmass = \"1 g\"\n[[step]]\nkind = "
                              "\"modes\"\n[[quantity]]\nname = \"omega\"\nkind = \"natural frequency\"\n"));
    EXPECT_NEAR(end.at("omega"), omega, 1e-4 * omega) << model;
  }
}

// As of a spring: the edge of a film without mass moves in proportion to the distance from its held end.
TEST_F(Spread, AMassOnAnEdgeThatStretchesCountsByAThirdAtItsMovingEnd) {
  const auto end = values(R"toml(
[film]
thickness = "1 mm"
[film.material]
shear_modulus = "50 kPa"
permittivity = "4e-11 F/m"
density = "0 kg/m^3"
[patch]
mode = "pure-shear"
length = "100 mm"
width = "50 mm"
stress_x = "0 Pa"
[output]
error_estimate = false
[[point_mass]]
place = "top"
mass = "10 g"
[[step]]
kind = "force"
[[step]]
kind = "modes"
[[quantity]]
name = "omega"
kind = "natural frequency"
)toml");
  EXPECT_NEAR(end.at("omega"), std::sqrt(100 / (10e-3 / 3)), 1e-5);
}

} // namespace
} // namespace dielast::cases::spread_test
