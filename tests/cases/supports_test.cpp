// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/film_cases.hpp"

#include <cmath>

// Supports that hold in some steps only.

namespace dielast::cases::supports_test {
namespace {

constexpr double modulus = 40e3, thickness = 1e-3, width = 20e-3;

/// A square of film at 2 kV in the end; `steps` and supports of its sides as written.
std::string patch(const std::string& steps, const std::string& rest) {
  return "[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nlaw = \"neo-hookean\"\n"
         "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n" +
         rest + "[patch]\nlength = \"20 mm\"\nwidth = \"20 mm\"\n[drive]\nvoltage = \"2 kV\"\n" +
         "[output]\nerror_estimate = false\nfields = false\n" + steps;
}

std::string side(const std::string& place, const std::string& axis, const std::string& when) {
  return fmt::format("[[support]]\nplace = \"{}\"\nfix = [\"{}\"]\n{}\n", place, axis, when);
}

std::string step(const std::string& kind, const std::string& name, const std::string& rest = "") {
  return fmt::format("[[step]]\nkind = \"{}\"\nname = \"{}\"\n{}\n", kind, name, rest);
}

std::string force(const std::string& place, const std::string& axis) {
  return fmt::format("[[quantity]]\nname = \"force_{0}\"\nkind = \"force\"\nof = \"{1}\"\nalong = \"{0}\"\n",
                     axis, place);
}

const std::string branch =
    "[[film.material.branch]]\nshear_modulus = \"20 kPa\"\nrelaxation_time = \"2 s\"\n";

class Supports : public FilmCases {
 protected:
  void expect_balanced(const Ran& ran, double bound) const {
    EXPECT_LT(std::abs(ran.last("energy_error")),
              bound * std::max(std::abs(ran.last("mechanical_work")), ran.last("electrical_work")));
  }
};

// Held while it is charged, then let go: as if it had never been held.
TEST_F(Supports, LetGoOfTheFilmSlowly) {
  const std::string charge = step("voltage", "charge"), go = step("voltage", "go");
  const Ran free = run(patch(charge, ""));
  const Ran held = run(patch(charge + go, side("right", "x", "until = \"charge\"") +
                                              side("top", "y", "until = \"charge\"") + force("right", "x")));
  const std::size_t rows = held.values.at("stretch_x").size(), charged = (rows - 1) / 2;
  EXPECT_EQ(held.values.at("stretch_x")[charged], 1.5);
  const double field = 2e3 / thickness, square = 4e-11 * field * field;
  EXPECT_NEAR(held.values.at("force_x")[charged],
              thickness * width * (modulus * (1.5 - std::pow(1.5, -5)) - square * std::pow(1.5, 3)), 1e-9);
  EXPECT_NEAR(held.last("stretch_x"), free.last("stretch_x"), 1e-9);
  EXPECT_NEAR(held.last("stretch_y"), free.last("stretch_y"), 1e-9);
  for (std::size_t row = charged + 1; row < rows; ++row)
    EXPECT_LT(held.values.at("stretch_x")[row], held.values.at("stretch_x")[row - 1]) << row;
  expect_balanced(held, 1e-6);
}

TEST_F(Supports, LetGoWhileTimePasses) {
  const std::string charge = step("voltage", "charge", "duration = \"1 s\"");
  for (const std::string kind : {"hold", "transient"}) {
    const std::string rest =
        step(kind, "go", "duration = \"4 s\"") + step("hold", "wait", "duration = \"60 s\"");
    const Ran free = run(patch(step("voltage", "charge"), ""));
    const Ran held = run(patch(charge + rest, branch + side("right", "x", "until = \"charge\"") +
                                                  side("top", "y", "until = \"charge\"")));
    EXPECT_NEAR(held.last("stretch_x"), free.last("stretch_x"), 1e-4) << kind;
    expect_balanced(held, 1e-3);
  }
}

// What takes hold keeps the place where it is, and carries what the sources leave to it.
TEST_F(Supports, TakeHoldWhereTheFilmIs) {
  const Ran free = run(patch(step("voltage", "charge"), ""));
  const Ran held = run(patch(step("voltage", "charge") + step("voltage", "discharge", "to = \"0 V\""),
                             side("right", "x", "from = \"discharge\"") +
                                 side("top", "y", "from = \"discharge\"") + force("right", "x")));
  const double stretch = free.last("stretch_x");
  EXPECT_NEAR(held.last("stretch_x"), stretch, 1e-12);
  EXPECT_NEAR(held.last("force_x"), thickness * width * modulus * (stretch - std::pow(stretch, -5)), 1e-9);
  EXPECT_EQ(held.values.at("force_x")[5], 0);
  expect_balanced(held, 1e-6);
}

// With inertia the film swings on from where it is let go, about where it comes to rest.
TEST_F(Supports, LetGoOfWhatHasAMass) {
  const std::string mass = "[[point_mass]]\nplace = \"right\"\nmass = \"1 g\"\ndamping = \"1 N.s/m\"\n";
  const Ran free = run(patch(step("voltage", "charge"), ""));
  const Ran held = run(patch(step("voltage", "charge") + step("hold", "go", "duration = \"0.2 s\"") +
                                 step("hold", "wait", "duration = \"1 s\""),
                             mass + side("right", "x", "until = \"charge\"")));
  EXPECT_NEAR(held.last("stretch_x"), free.last("stretch_x"), 1e-4);
  expect_balanced(held, 1e-3);
}

// What is shaken is carried by its support: its inertia, its damper, and the film.
TEST_F(Supports, CarryTheInertiaOfWhatTheyShake) {
  constexpr double amplitude = 1e-3, omega = 2 * 3.14159265358979323846 * 5, mass = 20e-3, damping = 0.05;
  for (const double phase : {90.0, 0.0}) {
    const std::string shaken = fmt::format("density = 0\n[[support]]\nplace = \"right\"\nfix = "
                                           "[\"x\"]\ndisplacement = {{ x = {{ wave = \"sine\", "
                                           "amplitude = \"1 mm\", frequency = \"5 Hz\", phase = \"{} deg\" "
                                           "}} }}\n[[point_mass]]\nplace = \"right\"\nmass = "
                                           "\"20 g\"\ndamping = \"0.05 N.s/m\"\n",
                                           phase);
    const Ran ran = run(
        patch(step("move", "draw") + step("transient", "shake", "duration = \"0.4 s\"\nincrements = 1600"),
              shaken + force("right", "x") +
                  "[[quantity]]\nname = \"pull\"\nkind = \"film force\"\nof = \"right\"\nalong = \"x\"\n"));
    double largest = 0, error = 0, late_error = 0;
    for (std::size_t row = 0; row < ran.time.size(); ++row) {
      const double t = ran.time[row], angle = omega * t + phase * 3.14159265358979323846 / 180;
      if (t == 0) continue;
      const double inertial = ran.values.at("force_x")[row] + ran.values.at("pull")[row];
      const double expected =
          -mass * amplitude * omega * omega * std::sin(angle) + damping * amplitude * omega * std::cos(angle);
      largest = std::max(largest, std::abs(expected));
      error = std::max(error, std::abs(inertial - expected));
      if (t < 0.1) continue;
      late_error = std::max(late_error, std::abs(inertial - expected));
    }
    EXPECT_NEAR(largest, mass * amplitude * omega * omega, 0.005 * largest);
    EXPECT_LT(late_error, 1e-5 * largest) << phase;
    if (phase == 0) continue; // it sets out with a jerk
    expect_balanced(ran, 1e-3);
    EXPECT_LT(error, 2e-3 * largest);
  }
}

// A run that is stopped while a support lets go ends like one that is not, bit for bit.
TEST_F(Supports, AreThoseOfTheStepThatARunGoesOnIn) {
  write("film.toml",
        patch(step("voltage", "charge") + step("hold", "go", "duration = \"4 s\"") +
                  step("voltage", "discharge", "to = \"0 V\""),
              branch + side("right", "x", "until = \"charge\"") + side("top", "y", "from = \"discharge\"")));
  const Case one = read_case(directory / "film.toml");
  std::vector<double> whole;
  SimulationObserver keep;
  keep.on_accept = [&](const Frame& frame) {
    whole = frame.values;
    return true;
  };
  Simulation(one, 1).run(keep);
  for (const int rows : {5, 11, 15, 25, 35, 38}) {
    Simulation stopped(one, 1);
    SimulationObserver stop;
    stop.on_accept = [&](const Frame& frame) { return frame.record.index < rows; };
    ASSERT_EQ(stopped.run(stop).ending, Ending::interrupted) << rows;
    const SimulationProgress progress = stopped.progress();
    Simulation resumed(one, 1);
    resumed.enter(progress.step);
    resumed.resume(progress);
    std::vector<double> values;
    SimulationObserver last;
    last.on_accept = [&](const Frame& frame) {
      values = frame.values;
      return true;
    };
    EXPECT_EQ(resumed.run(last).ending, Ending::complete) << rows;
    EXPECT_EQ(values, whole) << rows;
  }
}

// Two supports carry a moment on walls by a pair of forces.
TEST_F(Supports, CarryAMomentOnWalls) {
  constexpr double moment = 2e-4;
  const Ran ran =
      run("[film]\nmaterial = \"VHB 4910 (honeycomb)\"\nthickness = \"1 mm\"\nprestretch = [4.0, "
          "2.5]\n[honeycomb]\n"
          "angle = \"150 deg\"\ncolumns = [2, 1, 2]\nwall_length = \"8 mm\"\nwall_width = \"0.8 "
          "mm\"\nwall_height = "
          "\"2 mm\"\n[mesh]\nwall_elements = 2\n[output]\nerror_estimate = false\nfields = "
          "false\n[[support]]\nplace "
          "= \"left_apex\"\nfix = [\"x\", \"y\"]\n[[support]]\nplace = \"right_apex\"\nfix = "
          "[\"y\"]\n[[load]]\nplace = "
          "\"corner_top\"\nmoment = [\"0 N.m\", \"0 N.m\", \"2e-4 N.m\"]\n[[step]]\nkind = "
          "\"release\"\n[[step]]\n"
          "kind = \"force\"\nincrements = 3\n[[quantity]]\nname = \"span\"\nkind = \"distance\"\nbetween = "
          "[\"left_apex\", \"right_apex\"]\nalong = \"x\"\n" +
          force("right_apex", "y") + force("left_apex", "x"));
  EXPECT_NEAR(ran.last("force_y") * ran.last("span"), -moment, 1e-6 * moment);
  EXPECT_NEAR(ran.last("force_x"), 0, 1e-8);
  EXPECT_GT(ran.last("mechanical_work"), 0);
  EXPECT_LT(std::abs(ran.last("energy_error")), 1e-6 * ran.last("mechanical_work"));
}

std::string moved(const std::string& place, const std::string& x, const std::string& when = "") {
  return fmt::format("[[support]]\nplace = \"{}\"\nfix = [\"x\", \"y\"]\n{}\ndisplacement = {{ x = {} }}\n",
                     place, when, x);
}

// A film whose frame and left side, a part of it, are held or moved as written.
TEST_F(Supports, ThatMoveTheSameNodesMustAgree) {
  const auto film = [](const std::string& supports, const std::string& steps) {
    return "[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = \"40 kPa\"\n"
           "permittivity = \"4e-11 F/m\"\n[rectangle]\nlength = \"60 mm\"\nwidth = \"40 mm\"\n"
           "electrode_length = \"30 mm\"\nelectrode_width = \"20 mm\"\n[mesh]\nacross = 2\n"
           "[output]\nerror_estimate = false\nfields = false\n" +
           supports +
           "[[quantity]]\nname = \"left\"\nkind = \"displacement\"\nof = \"left\"\nalong = \"x\"\n" + steps;
  };
  const std::string move = "[[step]]\nkind = \"move\"\n",
                    again = "[[step]]\nkind = \"move\"\nname = \"again\"\n",
                    in_time = "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\nincrements = 4\n";
  const std::string sine = "{ wave = \"sine\", amplitude = \"1 mm\", frequency = \"0.25 Hz\" }";
  const auto refusal = [&](const std::string& supports, const std::string& steps) -> std::string {
    write("film.toml", film(supports, steps));
    try {
      Simulation(read_case(directory / "film.toml"), 1);
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  };
  const std::string told = refusal(moved("frame", "1e-3") + moved("left", "-1e-3"), move);
  EXPECT_NE(told.find("film.toml:26:22:"), std::string::npos) << told;
  EXPECT_NE(told.find("support[2].displacement.x: in step \"move\" it moves nodes of \"left\" that "
                      "support[1].displacement.x (line 21) moves elsewhere, as a part of \"frame\""),
            std::string::npos)
      << told;
  EXPECT_NE(refusal(moved("left", "-1e-3") + moved("frame", "1e-3"), move), "");
  EXPECT_NE(refusal(moved("frame", "0") + moved("left", "1e-3"), move), "");
  EXPECT_NE(refusal(moved("frame", "0") + moved("left", sine), in_time), "");
  EXPECT_EQ(refusal(moved("frame", sine) + moved("left", sine), in_time), "");
  EXPECT_EQ(refusal(moved("right", "1e-3") + moved("left", "-1e-3"), move), "");
  const std::string first = "until = \"move\"", later = "from = \"again\"";
  EXPECT_EQ(refusal(moved("frame", "1e-3", first) + moved("left", "-1e-3", later), move + again), "");
  EXPECT_NE(refusal(moved("frame", "1e-3") + moved("left", "-1e-3", later), move + again), "");
  const auto of_patch = [&](const std::string& keys, const std::string& supports) -> std::string {
    write("film.toml", "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\n"
                       "permittivity = \"4e-11 F/m\"\n[patch]\nlength = \"10 mm\"\n" +
                           keys + supports + move);
    try {
      Simulation(read_case(directory / "film.toml"), 1);
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  };
  const auto side_moved = [](const char* place, const char* axis, const char* by) {
    return fmt::format("[[support]]\nplace = \"{}\"\ndisplacement = {{ {} = {} }}\n", place, axis, by);
  };
  const std::string stretched = of_patch("stretch_x = 1.5\n", side_moved("right", "x", "1e-3"));
  EXPECT_NE(
      stretched.find("support[1].displacement.x: in step \"move\" it moves nodes of \"right\" that [patch] "
                     "moves elsewhere"),
      std::string::npos)
      << stretched;
  const std::string biaxial = "mode = \"equal-biaxial\"\n"; // both sides move alike
  EXPECT_NE(of_patch(biaxial, side_moved("right", "x", "1e-3") + side_moved("top", "y", "2e-3")), "");
  EXPECT_EQ(of_patch(biaxial, side_moved("right", "x", "1e-3") + side_moved("top", "y", "1e-3")), "");
  const std::string held = "[[support]]\nplace = \"frame\"\nfix = [\"x\", \"y\"]\n";
  for (const std::string& both : {held + moved("left", "1e-3"), moved("left", "1e-3") + held})
    EXPECT_NEAR(run(film(both, move)).last("left"), 1e-3, 1e-15);
}

TEST_F(Supports, LeaveNothingToMassesAndSpringsOnWhatTheyHold) {
  const auto warnings = [&](const std::string& rest, const std::string& steps = "kind = \"modes\"\n") {
    write("film.toml",
          "[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = \"40 kPa\"\n"
          "permittivity = \"4e-11 F/m\"\n[rectangle]\nlength = \"60 mm\"\nwidth = \"40 mm\"\n"
          "electrode_length = \"30 mm\"\nelectrode_width = \"20 mm\"\n[mesh]\nacross = 2\n" +
              rest + "[[step]]\n" + steps);
    std::string all;
    for (const std::string& one : build_device(read_case(directory / "film.toml")).warnings)
      all += one + "\n";
    return all;
  };
  const auto mass = [](const std::string& place) {
    return "[[point_mass]]\nmass = \"1 g\"\nplace = \"" + place + "\"\n";
  };
  const auto spring = [](const std::string& first, const std::string& second) {
    return "[[spring]]\nbetween = [\"" + first + "\", \"" + second +
           "\"]\nalong = \"x\"\nstiffness = \"1 N/m\"\nfree_length = \"1 mm\"\n";
  };
  const std::string held = side("left", "x\", \"y", "") + side("right", "x", "");
  const std::string told = warnings(held + mass("left"));
  EXPECT_NE(told.find("warning: point_mass[1].place: has no effect here: \"left\" is held where it is"),
            std::string::npos)
      << told;
  EXPECT_EQ(warnings(held + mass("right")), ""); // it slides
  EXPECT_EQ(warnings(held + mass("electrode")), "");
  const std::string between = warnings(held + spring("left", "right"));
  EXPECT_NE(
      between.find("warning: spring[1].between: has no effect here: \"left\" and \"right\" are held along x"),
      std::string::npos)
      << between;
  const std::string one = warnings(held + spring("electrode", "electrode"));
  EXPECT_NE(one.find("has no effect here: both places are \"electrode\""), std::string::npos) << one;
  EXPECT_EQ(warnings(held + spring("left", "electrode")), "");
  const std::string moves = "kind = \"move\"\n";
  const std::string shifted = side("left", "x\", \"y", "") + moved("right", "1e-3");
  EXPECT_EQ(warnings(shifted + spring("left", "right"), moves), "");
}

// What pulls as drawn is told: the film where its edge is free, otherwise what is attached to it.
TEST_F(Supports, ThatHoldTheFilmAreNotBlamedForASpring) {
  const auto warnings = [&](const std::string& rest) {
    write("pulled.toml",
          "[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = \"40 "
          "kPa\"\npermittivity = \"4e-11 F/m\"\n[rectangle]\nlength = \"60 mm\"\nwidth = \"40 "
          "mm\"\nelectrode_length = \"30 mm\"\n[mesh]\nacross = 2\n[drive]\nvoltage = \"1 V\"\n" +
              side("left", "x\", \"y", "") + rest);
    return fmt::format("{}", fmt::join(Simulation(read_case(directory / "pulled.toml"), 1).warnings(), "\n"));
  };
  const std::string spring =
      "[[spring]]\nbetween = [\"left\", \"electrode\"]\nalong = \"x\"\nstiffness = \"1 "
      "N/m\"\nfree_length = \"1 mm\"\n";
  const std::string frame = side("right", "x", "") + side("bottom", "y", "") + side("top", "y", "");
  EXPECT_EQ(warnings(frame).find("settle"), std::string::npos);
  EXPECT_NE(warnings(frame + spring).find("what is attached to the film pulls"), std::string::npos);
  EXPECT_NE(warnings(spring).find("is not held in its prestretch"), std::string::npos);
}

// A support that is there already takes hold once more: all stays as it was, the pressures of a solid and the
// forces on it, too.
TEST_F(Supports, LeaveSolidsAsTheyAre) {
  const auto slab = [](const std::string& when) {
    return "[film]\nthickness = \"0.1 mm\"\nwidth = \"10 mm\"\n[film.material]\nshear_modulus = \"0.4 "
           "MPa\"\nrelative_permittivity = 2.8\n[slab]\nlength = \"10 mm\"\nheight = \"2 "
           "mm\"\n[mesh]\nacross "
           "= 2\n" +
           side("right", "x\", \"y", "") + side("right", "x", when) +
           "[[load]]\nplace = \"left\"\nforce = [\"50 uN\", 0, 0]\n[drive]\nvoltage = \"1.5 kV\"\n"
           "[output]\nerror_estimate = false\n" +
           step("force", "pull", "increments = 2") + step("voltage", "charge", "increments = 2") +
           "[[quantity]]\nname = \"ux\"\nkind = \"displacement\"\nof = \"left\"\nalong = \"x\"\n";
  };
  const Ran once = run(slab("")), again = run(slab("from = \"charge\""));
  for (const auto& [name, values] : once.values)
    EXPECT_NEAR(again.last(name), values.back(), 1e-9 * std::abs(values.back())) << name;
}

// The device is built anew with other supports.
TEST_F(Supports, OfALatticeChangeWhileItsWallsAreWatched) {
  const Ran ran = run("[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nshear_modulus = \"20 "
                      "kPa\"\nrelative_permittivity = 4\n[honeycomb]\nangle = \"150 deg\"\ncolumns = [1, 2, "
                      "1]\nwall_length = \"8 mm\"\nwall_width = \"0.8 mm\"\nwall_height = \"2 "
                      "mm\"\n[honeycomb.wall_material]\nyoungs_modulus = \"78 MPa\"\npoisson_ratio = "
                      "0.45\nyield_strain = 1e-3\ndensity = \"1200 kg/m^3\"\n[mesh]\nwall_elements = 4\n"
                      "[drive]\nvoltage = \"3 kV\"\n[output]\nerror_estimate = false\n" +
                      side("film", "x\", \"y", "until = \"hold\"") +
                      step("voltage", "hold", "increments = 1") + step("voltage", "go", "increments = 4"));
  EXPECT_EQ(ran.events.count("wall yield"), 1u);
}

} // namespace
} // namespace dielast::cases::supports_test
