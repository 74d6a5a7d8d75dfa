// SPDX-License-Identifier: GPL-3.0-or-later
// With which force film under pressure pulls on its edges.
#include "tests/cases/case_test.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace dielast::cases::film_force_test {
namespace {

class FilmForces : public test::CaseTest {};

std::string of_places(std::initializer_list<const char*> places) {
  std::string text;
  for (const char* place : places)
    text += fmt::format(
        "[[quantity]]\nname = \"pull_{0}\"\nkind = \"film force\"\nof = \"{0}\"\nalong = \"z\"\n", place);
  return text;
}

const std::string material = "[film.material]\nshear_modulus = \"40 kPa\"\nrelative_permittivity = 3\n";
const std::string pressure =
    "pressure = \"300 Pa\"\n[[step]]\nkind = \"pressure\"\n[output]\nerror_estimate = "
    "false\n";

// What the pressure does to the elements at an edge is no pull of the film there: it was 4 % of it with 8
// rings.
TEST_F(FilmForces, AreThoseOfTheSupportUnderPressure) {
  for (const std::string model : {"axisymmetric", "3d"})
    for (const int order : {1, 2}) {
      const auto found = values(fmt::format(
          "model = \"{}\"\n[film]\nthickness = \"1 mm\"\nprestretch = 1.2\n"
          "{}[disc]\nradius = \"30 mm\"\nelectrode_radius = \"15 mm\"\n"
          "[mesh]\nrings = 8\norder = {}\n{}[[quantity]]\nname = \"held\"\n"
          "kind = \"force\"\nof = \"rim\"\nalong = \"z\"\n[[quantity]]\nname = "
          "\"radius\"\nkind = \"radius\"\nof = \"electrode_edge\"\n[chamber]\n{}",
          model, material, order, of_places({"rim", "electrode", "electrode_edge", "film"}), pressure));
      const double held = found.at("held");
      EXPECT_LT(held, -0.5);
      EXPECT_NEAR(found.at("pull_rim"), -held, 1e-8 * -held) << model << order;
      EXPECT_NEAR(found.at("pull_electrode_edge"), 0, 1e-8 * -held) << model << order; // from both sides
      EXPECT_NEAR(found.at("pull_film"), 0, 1e-8 * -held) << model << order;
      if (model == "axisymmetric") {
        const double radius = found.at("radius");
        EXPECT_NEAR(found.at("pull_electrode"), -300 * std::numbers::pi * radius * radius, 1e-8 * -held)
            << order;
      }
    }
}

// An eighth: planes of symmetry hold what the pressure pushes across them, too (x and y held nothing).
TEST_F(FilmForces, OfSolidsUnderPressureAreThoseOfTheSupports) {
  std::string text =
      "model = \"3d\"\n[film]\nthickness = \"2 mm\"\n" + material +
      "[hollow_sphere]\ninner_radius = \"10 mm\"\nouter_radius = \"12 mm\"\n[mesh]\nacross = 2\n";
  const std::map<std::string, std::string> across{{"side_x", "x"}, {"side_y", "y"}, {"equator", "z"}};
  for (const auto& [place, axis] : across)
    for (const auto& [name, kind] : {std::pair{"held", "force"}, {"pull", "film force"}})
      text += fmt::format("[[quantity]]\nname = \"{3}_{0}\"\nkind = \"{1}\"\nof = \"{0}\"\nalong = \"{2}\"\n",
                          place, kind, axis, name);
  const auto found = values(text + "[chamber]\nat = \"inner\"\n" + pressure);
  const double radius = found.at("inner_radius"), force = 300 * std::numbers::pi * radius * radius / 4;
  for (const auto& [place, axis] : across) {
    EXPECT_NEAR(found.at("held_" + place), -force, 1e-3 * force) << place; // the mesh's own circle
    EXPECT_NEAR(found.at("pull_" + place), -found.at("held_" + place), 1e-8 * force) << place;
  }
}

} // namespace
} // namespace dielast::cases::film_force_test
