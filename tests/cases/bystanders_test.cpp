// SPDX-License-Identifier: GPL-3.0-or-later
// What stands beside a device, and touches it nowhere, does not change what becomes of the device; nor does
// what has come to an end before.
#include "tests/cases/film_cases.hpp"

#include <cmath>

namespace dielast::cases::bystanders_test {
namespace {

class Bystanders : public FilmCases {
 protected:
  /// A shallow arch of two beams whose crown is pushed down past its limit point.
  static std::string arch(double width, double force, const std::string& beside, int increments = 1,
                          const char* before = "", const char* modulus = "10 MPa") {
    std::string text = "model = \"planar\"\n";
    for (const auto& [name, from, to] : {std::tuple("l", "[\"-20 mm\", 0, 0]", "[0, \"3 mm\", 0]"),
                                         {"r", "[0, \"3 mm\", 0]", "[\"20 mm\", 0, 0]"}})
      text +=
          fmt::format("[part.{0}.beam]\nwidth = \"{1} mm\"\nheight = \"10 mm\"\n[part.{0}.beam.material]\n"
                      "youngs_modulus = \"{4}\"\npoisson_ratio = 0.3\n[part.{0}.line]\nfrom = {2}\nto = "
                      "{3}\n",
                      name, width, from, to, modulus);
    return text + beside +
           fmt::format(
               "[[tie]]\nbetween = [\"l.end\", \"r.start\"]\n[[support]]\nplace = \"l.start\"\nfix = "
               "[\"x\", \"y\", \"turn_z\"]\n[[support]]\nplace = \"r.end\"\nfix = [\"x\", \"y\", "
               "\"turn_z\"]\n[[support]]\nplace = \"l.end\"\nfix = [\"x\", \"turn_z\"]\n[[load]]\nplace "
               "= \"l.end\"\nforce = [0, \"-{} mN\", 0]\n{}[[step]]\nkind = \"force\"\nincrements = {}\n"
               "[output]\nerror_estimate = false\n",
               force, before, increments);
  }
  static std::string sheet(const char* prestretch) {
    return fmt::format("[part.sheet]\nat = [0, \"50 mm\", 0]\n[part.sheet.film]\nthickness = \"0.1 mm\"\n"
                       "wrinkling = \"tension field\"\nprestretch = {}\n[part.sheet.film.material]\n"
                       "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[part.sheet.rectangle]\n"
                       "length = \"10 mm\"\n[part.sheet.mesh]\nacross = 4\n[[support]]\nplace = "
                       "\"sheet.frame\"\nfix = [\"x\", \"y\"]\n",
                       prestretch);
  }
  /// A rectangle moves in two steps: one more support that lets go behind the first of them, and holds what
  /// is held already, changes neither how far `place` has moved nor that energy.
  void expect_alike(const std::string& device, const std::string& another, const char* place,
                    const char* energy, double accuracy) {
    std::vector<double> moved, energies;
    for (const std::string& support : {std::string(), "[[support]]\n" + another + "until = \"a\"\n"}) {
      std::string text =
          "[film]\nthickness = \"1 mm\"\nprestretch = 1.2\n[film.material]\nshear_modulus = \"40 "
          "kPa\"\npermittivity = \"4e-11 F/m\"\n[rectangle]\nlength = \"40 mm\"\nwidth = \"20 "
          "mm\"\n[mesh]\nacross = 2\n" +
          device + support;
      for (const char* step : {"a", "b"})
        text += fmt::format("[[step]]\nname = \"{}\"\nkind = \"transient\"\nduration = \"50 ms\"\ninertia = "
                            "true\n",
                            step);
      const Ran ran = run(text + fmt::format("[[quantity]]\nname = \"moved\"\nkind = \"displacement\"\nof = "
                                             "\"{}\"\nalong = \"x\"\n[[quantity]]\nname = \"energy\"\nkind = "
                                             "\"energy\"\nof = \"{}\"\n[output]\nerror_estimate = false\n",
                                             place, energy));
      EXPECT_EQ(ran.events.count("caught"), 0u) << support;
      moved.push_back(ran.last("moved"));
      energies.push_back(ran.last("energy"));
    }
    EXPECT_NE(energies[0], 0);
    EXPECT_NEAR(moved[1], moved[0], accuracy * std::abs(moved[0]));
    EXPECT_NEAR(energies[1], energies[0], accuracy * std::abs(energies[0]));
  }
  static std::string block(const char* friction, const char* modulus = "40 kPa", const char* way = "") {
    return fmt::format(
        "[part.block]\nat = [\"60 mm\", 0, 0]\n[part.block.film]\nthickness = \"1 mm\"\nwidth = "
        "\"10 mm\"\nsection = \"solid\"\n[part.block.film.material]\nshear_modulus = \"{}\"\n"
        "permittivity = \"4e-11 F/m\"\n[part.block.slab]\nlength = \"4 mm\"\nheight = \"3 mm\"\n"
        "[part.block.mesh]\nacross = 2\n[contact]\nthickness = \"0.02 mm\"\n[table]\nat = "
        "\"block.bottom\"\nfriction = {}\n[[support]]\nplace = \"block.top\"\nfix = [\"x\", "
        "\"y\"]\n{}",
        modulus, friction, way);
  }
};

TEST_F(Bystanders, SlackFilmDoesNotHideALimitPoint) {
  for (const char* prestretch : {"1.2", "1", "0.9"}) {
    const Outcome outcome = outcome_of(arch(0.5, 200, sheet(prestretch)));
    EXPECT_EQ(outcome.kind, "limit point") << prestretch << outcome.message;
    EXPECT_NE(outcome.message.find("load factor 0.13435"), std::string::npos) << outcome.message;
  }
}

TEST_F(Bystanders, FrictionThatHoldsNothingDoesNotHideALimitPoint) {
  for (const char* friction : {"0", "0.3"}) {
    const Outcome outcome = outcome_of(arch(2, 1500, block(friction)));
    EXPECT_EQ(outcome.kind, "limit point") << friction << outcome.message;
    EXPECT_NE(outcome.message.find("load factor 0.31972"), std::string::npos) << outcome.message;
  }
}

TEST_F(Bystanders, FrictionThatHoldsDoesNotHideALimitPoint) {
  constexpr const char* way = "displacement = { y = \"-0.2 mm\" }\n";
  constexpr const char* press = "[[step]]\nname = \"press\"\nkind = \"move\"\n";
  for (const int increments : {1, 10}) {
    const Outcome outcome = outcome_of(arch(2, 1500, block("0.3", "40 kPa", way), increments, press));
    EXPECT_EQ(outcome.kind, "limit point") << increments << outcome.message;
    EXPECT_NE(outcome.message.find("load factor 0.31972"), std::string::npos) << outcome.message;
  }
  const Outcome outcome = outcome_of(arch(2, 1.5, block("0.3", "40 MPa", way), 10, press, "10 kPa"));
  EXPECT_EQ(outcome.kind, "limit point") << outcome.message;
  EXPECT_NE(outcome.message.find("load factor 0.31972"), std::string::npos) << outcome.message;
}

// Increments that end so near the limit point that the path seems to lead to where it jumps. (mN, their
// number, its load factor.)
TEST_F(Bystanders, ALimitPointIsNotJumpedOverByChance) {
  for (const auto& [force, increments, at] : {std::tuple(1000, 3, "0.47957"),
                                              {2008, 1, "0.23883"},
                                              {1106, 1, "0.43361"},
                                              {1583, 8, "0.30295"},
                                              {1186, 2, "0.40436"}}) {
    const Outcome outcome = outcome_of(arch(2, force, block("0"), increments));
    EXPECT_EQ(outcome.kind, "limit point") << force << outcome.message;
    EXPECT_NE(outcome.message.find(at), std::string::npos) << outcome.message;
  }
}

// Where displacements are next to nothing beside the load factor in the length of a path, steps along it
// ended on its snapped branch without a word (in 480 increments), or at a "bifurcation" (the slender one).
TEST_F(Bystanders, APathThatIsFollowedIsNotJumpedAlong) {
  for (const auto& [width, force, increments] :
       {std::tuple(2.0, 1000, 480), {0.5, 200, 1}, {0.5, 200, 100}}) {
    std::string text = arch(width, force, sheet("1.2"), increments);
    const std::string kind = "kind = \"force\"\n";
    text.insert(text.find(kind), "on_instability = \"follow\"\n");
    const Ran ran = run(text);
    EXPECT_EQ(ran.outcome.ending, Ending::complete) << ran.outcome.message;
    EXPECT_EQ(ran.events.count("limit point"), 2u) << width << " mm, " << increments;
  }
}

// One that holds what is held already changes nothing, while its other end goes on moving.
TEST_F(Bystanders, ASupportThatChangesElsewhereStopsNothing) {
  expect_alike("[[point_mass]]\nplace = \"left\"\nmass = \"10 g\"\n[[support]]\nplace = \"right\"\nfix = "
               "[\"x\", \"y\"]\n"
               "[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\ndisplacement = { x = { wave = \"sine\", "
               "amplitude = "
               "\"1 mm\", frequency = \"20 Hz\" } }\n",
               "place = \"right\"\nfix = [\"x\"]\n", "centre", "released", 1e-9);
}

// What is tied to a body moves on with it.
TEST_F(Bystanders, ASupportThatChangesElsewhereLeavesBodiesTheirSpeed) {
  expect_alike(
      "[[body]]\nname = \"hub\"\nplaces = [\"right\"]\nmass = \"10 g\"\ninertia = \"4 g.cm^2\"\ncentre = "
      "[\"20 mm\", \"4 mm\", 0]\n[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\n[drive]\nvoltage = "
      "{ wave = \"sine\", amplitude = \"4 kV\", frequency = \"10 Hz\" }\n[[step]]\nkind = \"release\"\n",
      "place = \"left\"\nfix = [\"y\"]\n", "right", "kinetic", 1e-6);
}

// The water stays in the balloon while its dashpots let go: it does no work, and what the film loses is heat.
TEST_F(Bystanders, AClosedChamberTakesNothingOfTheHeatOfDashpots) {
  const Ran ran =
      run("model = \"axisymmetric\"\n[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = "
          "\"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[[film.material.branch]]\nshear_modulus = \"40 "
          "kPa\"\nviscosity = \"40 kPa.s\"\n[balloon]\nradius = \"30 mm\"\n[chamber]\nvolume = \"160 "
          "ml\"\n[[step]]\nkind = \"inflate\"\nresponse = \"instantaneous\"\n[[step]]\nkind = "
          "\"relax\"\n[[quantity]]\nname = \"heat\"\nkind = \"energy\"\nof = \"dissipated\"\n"
          "[[quantity]]\nname = \"work\"\nkind = \"energy\"\nof = \"mechanical_work\"\n[[quantity]]\n"
          "name = \"elastic\"\nkind = \"energy\"\nof = \"elastic\"\n[output]\nerror_estimate = false\n");
  EXPECT_NEAR(ran.last("heat"), ran.last("elastic"), 1e-4 * ran.last("elastic")); // of two equal springs
  EXPECT_NEAR(ran.last("work"), 2 * ran.last("elastic"), 2e-4 * ran.last("elastic"));
}

// The corner belongs to the body: that is told before anything is computed.
TEST_F(Bystanders, ASupportOfALaterStepIsLookedAtBeforeTheFirst) {
  const std::string text =
      "model = \"planar\"\n[film]\nthickness = \"0.5 mm\"\nprestretch = 1.2\n[film.material]\nshear_modulus "
      "= "
      "\"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[rectangle]\nlength = \"20 mm\"\nwidth = \"10 mm\"\n[mesh]\n"
      "across = 2\n[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\n[[support]]\nplace = \"top\"\nfix = "
      "[\"y\"]\nfrom = \"second\"\n[[body]]\nname = \"hub\"\nplaces = [\"right\"]\n[[step]]\nkind = "
      "\"relax\"\n[[step]]\nname = \"second\"\nkind = \"relax\"\n";
  write("film.toml", text);
  const Case one = read_case(directory / "film.toml");
  EXPECT_THROW(Simulation(one, 1), CaseError);
}

// A way of its ends that is no round number, gone before, accelerates no mass.
TEST_F(Bystanders, AWayThatIsGoneAcceleratesNoMass) {
  const Ran ran = run(
      "[film]\nthickness = \"0.5 mm\"\nprestretch = 1.2\n[film.material]\nshear_modulus = \"40 kPa\"\n"
      "permittivity = \"4e-11 F/m\"\n[[film.material.branch]]\nshear_modulus = \"1 Pa\"\nrelaxation_time = "
      "\"1 "
      "ms\"\n[rectangle]\nlength = \"20 mm\"\nwidth = \"10 mm\"\n[mesh]\nacross = 1\n[[support]]\nplace = "
      "\"left\"\nfix = [\"x\", \"y\"]\ndisplacement = { x = \"173 mm\" }\n[[support]]\nplace = "
      "\"right\"\nfix = "
      "[\"x\", \"y\"]\ndisplacement = { x = \"173 mm\" }\n[[point_mass]]\nplace = \"right\"\nmass = \"10 "
      "kg\"\n"
      "[[step]]\nname = \"m\"\nkind = \"move\"\n[[step]]\nkind = \"hold\"\nduration = \"1 s\"\ninertia = "
      "true\n"
      "increments = 20\n[[quantity]]\nname = \"f\"\nkind = \"force\"\nof = \"right\"\nalong = "
      "\"x\"\n[[quantity]]\n"
      "name = \"most\"\nkind = \"peak\"\nof = \"f\"\nextreme = \"maximum\"\n[output]\n"
      "error_estimate = false\n");
  EXPECT_NEAR(ran.last("most"), ran.last("f"), 1e-6 * ran.last("f"));
}

TEST_F(Bystanders, ASupportThatHasLetGoBearsNothingInAMean) {
  const Ran ran = run(
      "[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = \"40 kPa\"\n"
      "permittivity = \"4e-11 F/m\"\n[patch]\nlength = \"20 mm\"\nwidth = \"20 mm\"\n[drive]\nvoltage = \"2 "
      "kV\"\n[[support]]\nplace = \"right\"\nfix = [\"x\"]\nuntil = \"a\"\n[[step]]\nkind = "
      "\"voltage\"\nname "
      "= \"a\"\nduration = \"1 s\"\n[[step]]\nkind = \"hold\"\nduration = \"1 s\"\nincrements = 2\n"
      "[[quantity]]\nname = \"f\"\nkind = \"force\"\nof = \"right\"\nalong = \"x\"\n[[quantity]]\nname = "
      "\"mean\"\nkind = \"mean\"\nof = \"f\"\nsince = \"a\"\n[output]\nerror_estimate = false\n");
  EXPECT_NEAR(ran.last("mean"), 0, 1e-9);
}

} // namespace
} // namespace dielast::cases::bystanders_test
