// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/film_cases.hpp"

#include <cmath>

// Supports that hold in some steps only.

namespace dielast::cases {
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

} // namespace
} // namespace dielast::cases
