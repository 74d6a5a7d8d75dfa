// SPDX-License-Identifier: GPL-3.0-or-later
// Solids whose potential is an unknown: field = "potential".
#include "cases/devices/device.hpp"
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace dielast::cases::solid_potentials_test {
namespace {

class SolidPotentials : public Paths {
 protected:
  static std::string slab(const char* name, const char* at, const char* up = "y") {
    return fmt::format("[part.{0}]\nat = [0, {3}]\n[part.{0}.film]\nthickness = \"1 mm\"\nfield = "
                       "\"potential\"\n[part.{0}.film.material]\nshear_modulus = \"40 kPa\"\n"
                       "relative_permittivity = 3\n[part.{0}.slab]\nlength = \"4 mm\"\nheight = \"1 mm\"\n"
                       "[part.{0}.mesh]\nacross = 2\n[[support]]\nplace = \"{0}.bottom\"\nfix = [\"x\", "
                       "\"{2}\"]\n",
                       name, at, up,
                       up[0] == 'y' ? fmt::format("\"{}\", 0", at) : fmt::format("0, \"{}\"", at));
  }
  const std::string charged = "[[electrode]]\nname = \"e\"\nplace = \"a.top\"\nground = \"a.bottom\"\n"
                              "[drive.e]\nvoltage = \"2 kV\"\n[[step]]\nkind = \"voltage\"\n"
                              "[output]\nerror_estimate = false\n[[quantity]]\nname = \"rise\"\nkind = "
                              "\"displacement\"\nof = \"a.top\"\nalong = \"y\"\n";
};

// What nothing charges has no field; its potential, which nothing tells, kept the tangent singular.
TEST_F(SolidPotentials, a_solid_without_electrode_may_stand_beside_one_that_has) {
  const double alone = values(slab("a", "0 mm") + charged).at("rise");
  EXPECT_LT(alone, 0);
  EXPECT_NEAR(values(slab("a", "0 mm") + slab("b", "2 mm") + charged).at("rise"), alone, 1e-9 * -alone);
}

// Where it is hollow a curved surface lies within its own elements' straight ones.
TEST_F(SolidPotentials, a_solid_may_touch_the_inside_of_a_hollow_sphere) {
  const std::string sphere =
      "[part.s.film]\nthickness = \"1 mm\"\nfield = \"potential\"\n[part.s.film.material]\nshear_modulus = "
      "\"40 kPa\"\nrelative_permittivity = 3\n[part.s.hollow_sphere]\ninner_radius = \"10 mm\"\n"
      "outer_radius = \"12 mm\"\n[[electrode]]\nname = \"e\"\nplace = \"s.outer\"\nground = \"s.inner\"\n"
      "[[support]]\nplace = \"s.outer\"\nfix = [\"z\"]\n";
  const auto device = [&](const char* at) {
    return "model = \"axisymmetric\"\n" + sphere + slab("a", at, "z") +
           "[contact]\nthickness = \"0.05 mm\"\nbetween = [\"s.inner\", \"a.top\"]\n";
  };
  EXPECT_NO_THROW(build_device(read(device("-2 mm"))));
  EXPECT_THROW(build_device(read(device("9.5 mm"))), CaseError);
}

TEST_F(SolidPotentials, points_of_solids_of_revolution_are_told_at_y_0) {
  const auto refusal = [&](const char* point) -> std::string {
    const Case one = read("model = \"axisymmetric\"\n" + slab("a", "0 mm", "z") + charged +
                          fmt::format("[[quantity]]\nname = \"p\"\nkind = \"displacement\"\nalong = \"z\"\n"
                                      "point = {}\n",
                                      point));
    try {
      Simulation(one, 1);
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("[2e-3, 0, 0.5e-3]"), "");
  EXPECT_NE(refusal("[0, 2e-3, 0.5e-3]").find("told in the half plane y = 0"), std::string::npos);
}

} // namespace
} // namespace dielast::cases::solid_potentials_test
