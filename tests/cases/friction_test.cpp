// SPDX-License-Identifier: GPL-3.0-or-later
// What Coulomb's friction holds, and what slides.
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases::friction_test {
namespace {

class Friction : public Paths {};

/// A block on a table that gravity pulls along it, too, in five increments.
std::string pulled_block(const std::string& friction) {
  return "[film]\nthickness = \"1 mm\"\nwidth = \"10 mm\"\n[film.material]\nshear_modulus = \"0.4 MPa\"\n"
         "permittivity = \"2.5e-11 F/m\"\ndensity = \"1080 kg/m^3\"\n[slab]\nlength = \"20 mm\"\nheight = "
         "\"6 mm\"\n"
         "[gravity]\ndirection = [0.2, -1, 0]\nfilm = true\n[contact]\nthickness = \"0.02 mm\"\n"
         "[table]\nat = \"bottom\"\nfriction = " +
         friction +
         "\n[output]\nerror_estimate = false\n[[step]]\nkind = \"weight\"\nincrements = 5\n"
         "[[quantity]]\nname = \"way\"\nkind = \"displacement\"\nof = \"top\"\nalong = \"x\"\n";
}

/// 0.3 times the normal force of the increment before is exactly what pulls at 3/5 of the load: the block
/// does not slide all the same (it did, by 27.6 mm), nor where friction is by little enough. Much friction
/// holds it as what is held does (it slid by 4.3 um while nothing pressed it yet), however many increments.
TEST_F(Friction, blocks_stand_where_friction_suffices_by_little) {
  std::string held = pulled_block("0");
  const std::size_t contact = held.find("[contact]"), output = held.find("[output]");
  held.replace(contact, output - contact, "[[support]]\nplace = \"bottom\"\nfix = [\"x\", \"y\"]\n");
  const double sheared = values(held).at("way");
  double least = sheared;
  for (const char* friction : {"0.9", "0.3", "0.25", "0.21"}) {
    std::string at_once = pulled_block(friction);
    at_once.replace(at_once.find("increments = 5"), 14, "increments = 1");
    const double way = values(pulled_block(friction)).at("way");
    EXPECT_GT(way, least) << friction;
    EXPECT_LT(way, 3.2 * sheared) << friction;
    EXPECT_NEAR(values(at_once).at("way"), way, 1e-5 * way) << friction;
    least = way;
  }
  std::string thin = pulled_block("0.9");
  thin.replace(thin.find("0.02 mm"), 7, "2 um");
  EXPECT_NEAR(values(thin).at("way"), sheared, 0.03 * sheared);
}

// Pushed on it slides, pushed back it sticks.
TEST_F(Friction, leaves_a_stiffness_without_value) {
  const std::string text =
      pulled_block("0.3") + "[[quantity]]\nname = \"k\"\nkind = \"stiffness\"\nof = \"top\"\nalong = \"x\"\n";
  EXPECT_TRUE(std::isnan(values(text).at("k")));
  const Case one = read(text);
  EXPECT_TRUE(std::ranges::any_of(one.warnings, [](const auto& warning) {
    return warning.text().find("with friction it depends on the way to go on") != std::string::npos;
  }));
}

TEST_F(Friction, tell_that_what_is_pressed_slides) {
  const Case one = read(pulled_block("0.15"));
  const Outcome outcome = Simulation(one, 1).run({});
  EXPECT_EQ(outcome.kind, "no equilibrium");
  EXPECT_NE(outcome.message.find("All that is pressed slides"), std::string::npos) << outcome.message;
}

/// Eigenvalues leap wherever a node starts or stops to slide: where Newton's method has too few iterations
/// (with 25 it goes on beyond 600 V) what they seem to tend to is no limit point (one was told near 61 V).
TEST_F(Friction, stagnation_is_no_limit_point) {
  const Case one =
      read("[film]\nthickness = \"50 um\"\nwidth = \"13 mm\"\n[film.material]\nshear_modulus = \"0.4 MPa\"\n"
           "relative_permittivity = 2.8\ndensity = \"1080 kg/m^3\"\n[slab]\nlength = \"24 mm\"\n"
           "height = \"0.6 mm\"\nelectrode = [\"4 mm\", \"14 mm\"]\ncover_thickness = \"50 um\"\n"
           "[mesh]\nacross = 1\n[table]\nat = \"bottom\"\nfriction = 0.3\n[contact]\nthickness = \"1 um\"\n"
           "[gravity]\ndirection = [0, -1, 0]\nfilm = true\n[drive]\nvoltage = \"700 V\"\n"
           "[solver]\nmax_iterations = 8\n[output]\nerror_estimate = false\n[[step]]\nkind = \"weight\"\n"
           "[[step]]\nkind = \"voltage\"\nincrements = 2\n");
  const Outcome outcome = Simulation(one, 1).run({});
  EXPECT_EQ(outcome.kind, "no equilibrium") << outcome.message;
}

/// A slab on a table as drawn, pressed by 1 N and pushed along in one step.
std::string pushed_slab(double push, int increments) {
  return fmt::format(
      "model = \"planar\"\n[film]\nthickness = \"1 mm\"\nwidth = \"10 mm\"\n[film.material]\n"
      "shear_modulus = \"400 kPa\"\npermittivity = \"4e-11 F/m\"\n[slab]\nlength = \"10 mm\"\n"
      "height = \"3 mm\"\n[mesh]\nacross = 2\n[table]\nat = \"bottom\"\nfriction = 0.3\n"
      "[contact]\nthickness = \"5 um\"\n[[load]]\nplace = \"film\"\nforce = [{}, -1, 0]\n"
      "[output]\nerror_estimate = false\n[[quantity]]\nname = \"way\"\nkind = \"displacement\"\n"
      "of = \"bottom\"\nalong = \"x\"\n[[step]]\nkind = \"force\"\nincrements = {}\n",
      push, increments);
}

/// What is pressed and pushed at once from the beginning: the table held twice the weight in one increment,
/// and let go of 0.6 mm and less in more of them where friction suffices.
TEST_F(Friction, is_bounded_from_the_first_touch_on) {
  for (const int increments : {1, 10})
    EXPECT_EQ(Simulation(read(pushed_slab(0.4, increments)), 1).run({}).ending, Ending::gave_up)
        << increments;
  const double way = values(pushed_slab(0.15, 1)).at("way");
  EXPECT_LT(way, 3e-6);
  EXPECT_NEAR(values(pushed_slab(0.15, 10)).at("way"), way, 1e-5 * way);
}

/// A slab that is pressed, lifted and pressed again is as after the first time, in however many increments
/// (what came to touch slid freely for an increment: 41 % of the force). The heat is that of the force on the
/// way, by the trapezoidal rule: of second order in the increments.
TEST_F(Friction, is_the_same_when_a_slab_touches_again) {
  const auto pressed = [&](int increments) {
    std::string text =
        "[film]\nthickness = \"1 mm\"\nwidth = \"10 mm\"\n[film.material]\nshear_modulus = \"100 kPa\"\n"
        "permittivity = \"4e-11 F/m\"\n[slab]\nlength = \"10 mm\"\nheight = \"2 mm\"\n[mesh]\nacross = "
        "2\n[table]\n"
        "at = \"bottom\"\nfriction = 0.3\n[contact]\nthickness = \"5 um\"\n[output]\nerror_estimate = false\n"
        "[[support]]\nplace = \"top\"\nfix = [\"x\"]\n"
        "[[quantity]]\nname = \"force\"\nkind = \"contact force\"\n"
        "[[quantity]]\nname = \"first\"\nkind = \"contact force\"\nat = \"press\"\n"
        "[[quantity]]\nname = \"heat\"\nkind = \"energy\"\nof = \"dissipated\"\nat = \"press\"\n";
    for (const auto& [step, to] : {std::pair{"press", "-0.1"}, {"lift", "0.5"}, {"again", "-0.1"}})
      text +=
          fmt::format("[[support]]\nplace = \"top\"\ndisplacement = {{ y = \"{1} mm\" }}\nfrom = \"{0}\"\n"
                      "until = \"{0}\"\n[[step]]\nkind = \"move\"\nname = \"{0}\"\nincrements = {2}\n",
                      step, to, increments);
    return values(text);
  };
  const auto at_once = pressed(1), quickly = pressed(4), slowly = pressed(16);
  for (const auto* found : {&at_once, &quickly, &slowly}) {
    EXPECT_NEAR(found->at("force"), found->at("first"), 1e-4 * found->at("first"));
    EXPECT_NEAR(found->at("first"), slowly.at("first"), 1e-3 * slowly.at("first"));
  }
  EXPECT_NEAR(quickly.at("heat"), slowly.at("heat"), 0.03 * slowly.at("heat"));
}

/// A disc that comes down on a larger one, 2 um before they touch: as it spreads it is held, in one increment
/// as in many (in one it slid freely: 2.43 N).
TEST_F(Friction, between_surfaces_holds_in_the_increment_in_which_they_meet) {
  const auto disc = [](const char* name, double at, double radius) {
    return fmt::format("[part.{}]\nat = [0, 0, \"{} mm\"]\n[part.{}.film]\nthickness = \"50 um\"\n"
                       "section = \"solid\"\nstacked_along = \"z\"\n[part.{}.film.material]\n"
                       "shear_modulus = \"100 kPa\"\npermittivity = \"4e-11 F/m\"\n"
                       "[part.{}.slab]\nlength = \"{} mm\"\nheight = \"2 mm\"\n[part.{}.mesh]\nacross = 2\n",
                       name, at, name, name, name, radius, name);
  };
  const auto held = [&](int increments, double friction) {
    return values("model = \"axisymmetric\"\n" + disc("lower", 0, 16) + disc("upper", 2.012, 8) +
                  fmt::format("[contact]\nbetween = [\"lower.top\", \"upper.bottom\"]\n"
                              "thickness = \"10 um\"\nfriction = {}\n"
                              "[[support]]\nplace = \"lower.bottom\"\nfix = [\"x\", \"z\"]\n"
                              "[[support]]\nplace = \"upper.top\"\ndisplacement = {{ z = \"-0.1 mm\" }}\n"
                              "[[step]]\nkind = \"move\"\nincrements = {}\n[[quantity]]\nname = \"force\"\n"
                              "kind = \"force\"\nof = \"upper.top\"\nalong = \"z\"\n"
                              "[output]\nerror_estimate = false\n",
                              friction, increments))
        .at("force");
  };
  const double at_once = held(1, 0.3);
  EXPECT_NEAR(held(8, 0.3), at_once, 1e-3 * std::abs(at_once));
  EXPECT_GT(std::abs(at_once), 1.2 * std::abs(held(1, 0)));
}

/// A block that is pressed and moved along at once from where it only touches, in however many increments (in
/// one, two, four and eight Newton's steps went to and fro between sticking and sliding, however short).
TEST_F(Friction, begins_in_any_number_of_increments) {
  const auto moved = [&](int increments) {
    return values(fmt::format(
                      "[film]\nthickness = \"50 um\"\nwidth = \"13 mm\"\n[film.material]\n"
                      "shear_modulus = \"400 kPa\"\npermittivity = \"4e-11 F/m\"\n[slab]\n"
                      "length = \"2 mm\"\nheight = \"2 mm\"\n[mesh]\nacross = 2\n[table]\n"
                      "at = \"bottom\"\nfriction = 0.05\n[contact]\nthickness = \"2 um\"\n"
                      "[[support]]\nplace = \"top\"\ndisplacement = {{ x = \"0.1 mm\", y = \"-0.15 mm\" }}\n"
                      "[[step]]\nkind = \"move\"\nincrements = {}\n[output]\nerror_estimate = false\n"
                      "[[quantity]]\nname = \"heat\"\nkind = \"energy\"\nof = \"dissipated\"\n",
                      increments))
        .at("heat");
  };
  const double slowly = moved(10);
  for (const int increments : {1, 2, 4, 8})
    EXPECT_NEAR(moved(increments), slowly, 5e-3 * slowly) << increments;
}

} // namespace
} // namespace dielast::cases::friction_test
