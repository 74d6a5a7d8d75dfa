// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/beam_section.hpp"
#include "tests/cases/film_cases.hpp"
#include "tests/cases/held_by_rods.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

// Bodies that turn more than once, and bars whose sections turn.

namespace dielast::cases::turns_test {
namespace {

constexpr double pi = std::numbers::pi, length = 50e-3;

/// A rod that nothing moves, as a case needs a film, beside a bar 50 mm long along x from the origin.
std::string bar(const std::string& elements, const std::string& rest, double width = 2e-3,
                double height = 1e-3) {
  return "model = \"3d\"\n[part.r.film]\nthickness = \"1 mm\"\n[part.r.film.material]\nshear_modulus = \"1 "
         "kPa\"\n"
         "permittivity = \"1e-12 F/m\"\ndensity = 0\n[part.r.rod]\nwidth = \"1 mm\"\n[part.r.line]\n"
         "from = [0, \"1 m\", 0]\nto = [\"50 mm\", \"1 m\", 0]\n"
         "[[support]]\nplace = \"r.film\"\nfix = [\"x\", \"y\", \"z\"]\n" +
         fmt::format("[part.b.beam]\nwidth = {}\nheight = {}\n", width, height) +
         "[part.b.beam.material]\nyoungs_modulus = \"78 MPa\"\npoisson_ratio = 0.36\n"
         "density = \"1200 kg/m^3\"\n[part.b.line]\nto = [\"50 mm\", 0, 0]\n" +
         elements + "[output]\nfields = false\nerror_estimate = false\n" + rest;
}

const std::string clamped = "[[support]]\nplace = \"b.start\"\n"
                            "fix = [\"x\", \"y\", \"z\", \"turn_x\", \"turn_y\", \"turn_z\"]\n";

materials::BeamSection bar_section(double width = 2e-3, double height = 1e-3) {
  return materials::rectangular_section({.youngs_modulus = 78e6, .poisson_ratio = 0.36, .density = 1200},
                                        width, height);
}

std::string angle(const std::string& along) {
  return "[[quantity]]\nname = \"angle_" + along + "\"\nkind = \"angle\"\nof = \"d\"\nalong = \"" + along +
         "\"\n";
}

class Turns : public FilmCases {};

std::string elements(int count, int order) {
  return fmt::format("[part.b.mesh]\nwall_elements = {}\norder = {}\n", count, order);
}

// T L/(G J), of a square bar up to 14.5 rad, where it buckles (Greenhill). The work is half of moment times
// angle.
TEST_F(Turns, of_a_twisted_bar_are_counted_one_way_and_back) {
  const double width = 1e-3, height = 1e-3, whole = -4.25 * pi;
  const double moment = whole * bar_section(width, height).GJ / length;
  const std::string load =
      fmt::format("[[load]]\nplace = \"d\"\nmoment = [{{ wave = \"trapezoid\", to = {}, rise = 1, "
                  "hold = 1, fall = 1 }}, 0, 0]\n",
                  moment);
  const Ran ran = run(bar(
      elements(40, 2),
      clamped +
          "[[body]]\nname = \"d\"\nplaces = [\"b.end\"]\nfix = [\"y\", \"z\", \"turn_y\", \"turn_z\"]\n" +
          load + "[[step]]\nkind = \"transient\"\nduration = 3\nincrements = 24\n" + angle("x") + angle("y") +
          "[[quantity]]\nname = \"most\"\nkind = \"peak\"\nof = \"angle_x\"\n"
          "extreme = \"minimum\"\n",
      width, height));
  const std::vector<double>& angles = ran.values.at("angle_x");
  for (std::size_t k = 0; k < ran.time.size(); ++k) {
    const double t = ran.time[k], exact = whole * (t < 1 ? t : t < 2 ? 1 : 3 - t);
    EXPECT_NEAR(angles[k], exact, 1e-4 * std::abs(whole)) << t;
    EXPECT_NEAR(ran.values.at("mechanical_work")[k], moment * exact * exact / whole / 2,
                1e-4 * moment * whole);
  }
  EXPECT_NEAR(ran.last("most"), whole, 1e-4 * std::abs(whole));
  EXPECT_NEAR(ran.last("angle_y"), 0, 1e-6);
  EXPECT_LT(std::abs(ran.last("energy_error")), 1e-4 * moment * whole);
}

/// A body on a pivot, which turns freely: only a massless film that does not move is beside it.
std::string spinner(const std::string& moment, const std::string& steps) {
  return bar("", "[[body]]\nname = \"d\"\nplaces = [\"b.line\"]\nmass = \"1 g\"\n"
                 "inertia = \"0.1 g.mm^2\"\ncentre = [0, 0, 0]\n"
                 "pivot = [0, 0, 0]\n[[load]]\nplace = \"d\"\nmoment = " +
                     moment + "\n" + steps);
}

/// With the bar's mass at the distance of its nodes, and what it has about its own axes.
double inertia_about_z() {
  const double m = 1200 * 2e-6 * length;
  return 1e-10 + m * length * length / 3 + bar_section().rotary3 * length;
}

// M t^2/(2 I), and on at the speed that was reached.
TEST_F(Turns, of_a_free_body_follow_a_constant_moment_and_go_on_without) {
  const double moment = 2e-5, t = 0.5, I = inertia_about_z();
  const Ran ran = run(spinner("[0, 0, { wave = \"trapezoid\", to = \"2e-5 N m\", hold = \"0.5 s\" }]",
                              "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\nincrements = 400\n" +
                                  angle("z") + angle("x")));
  ASSERT_GT(moment * t * t / (2 * I), 4 * pi);
  for (std::size_t k = 0; k < ran.time.size(); ++k) {
    const double now = ran.time[k];
    const double exact = moment / I * (now < t ? now * now / 2 : t * t / 2 + t * (now - t));
    EXPECT_NEAR(ran.values.at("angle_z")[k], exact, 1e-3 * exact + 1e-6) << now;
  }
  EXPECT_NEAR(ran.last("angle_x"), 0, 1e-6);
  EXPECT_NEAR(ran.last("mechanical_work"), moment * moment * t * t / (2 * I),
              1e-3 * moment * moment * t * t / I);
  EXPECT_LT(std::abs(ran.last("energy_error")), 1e-3 * ran.last("mechanical_work"));
}

TEST_F(Turns, are_kept_by_what_goes_on) {
  write("film.toml", spinner("[0, 0, \"2e-5 N m\"]", "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\n"
                                                     "increments = 100\n" +
                                                         angle("z")));
  const Case one = read_case(directory / "film.toml");
  const auto take = [&](Simulation& simulation, int rows) {
    std::vector<double> angles;
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      for (std::size_t q = 0; q < one.quantities.size(); ++q)
        if (one.quantities[q].name == "angle_z") angles.push_back(frame.values[q]);
      return std::ssize(angles) != rows;
    };
    simulation.run(observer);
    return angles;
  };
  Simulation whole(one, 1), first(one, 1), second(one, 1);
  const std::vector<double> all = take(whole, -1);
  take(first, 80);
  second.resume(first.progress());
  const std::vector<double> rest = take(second, -1);
  ASSERT_EQ(rest.size() + 80, all.size());
  EXPECT_GT(all[80], 2 * pi);
  for (std::size_t k = 0; k < rest.size(); ++k) EXPECT_EQ(rest[k], all[80 + k]);
}

// All of what resists is the body's, and that of the bar's sections about its axis.
TEST_F(Turns, of_a_bar_about_its_axis_meet_the_inertia_of_its_sections) {
  const double moment = 1e-8, I = 1e-10 + (bar_section().rotary2 + bar_section().rotary3) * length;
  const Ran ran = run(spinner("[\"1e-8 N m\", 0, 0]", "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\n"
                                                      "increments = 800\n" +
                                                          angle("x")));
  ASSERT_GT(moment / (2 * I), 6 * pi);
  EXPECT_NEAR(ran.last("angle_x"), moment / (2 * I), 1e-3 * moment / (2 * I));
  EXPECT_LT(std::abs(ran.last("energy_error")), 1e-3 * ran.last("mechanical_work"));
}

/// Natural frequencies, Hz, of a bar without a [[body]] or with one at its end.
class BarModes : public Turns {
 protected:
  std::vector<double> frequencies(const std::string& elements, const std::string& held) {
    write("film.toml", bar(elements, held + "[[step]]\nkind = \"modes\"\ncount = 24\n"));
    const Case one = read_case(directory / "film.toml");
    Simulation simulation(one, 1);
    std::vector<double> found;
    SimulationObserver observer;
    observer.on_analysis = [&](const Analysis& analysis, const fem::State&) {
      for (const auto& row : analysis.rows) found.push_back(row[1]);
    };
    EXPECT_EQ(simulation.run(observer).ending, Ending::complete);
    return found;
  }
  /// By how much the nearest is off, in parts.
  static double off(const std::vector<double>& found, double frequency) {
    double least = 1;
    for (const double f : found) least = std::min(least, std::abs(f / frequency - 1));
    return least;
  }
};

// (2 n - 1)/(4 L) sqrt(G J/(rho I_p)), of second and fourth order.
TEST_F(BarModes, of_torsion_are_those_of_a_clamped_bar) {
  const materials::BeamSection s = bar_section();
  const double first = std::sqrt(s.GJ / (s.rotary2 + s.rotary3)) / (4 * length);
  EXPECT_NEAR(first, 573, 1);
  double before = 0;
  for (const int count : {8, 16}) {
    const double error = off(frequencies(elements(count, 1), clamped), 3 * first);
    if (count == 16) {
      EXPECT_NEAR(std::log2(before / error), 2, 0.2);
    }
    before = error;
  }
  const std::vector<double> fine = frequencies(elements(16, 2), clamped);
  EXPECT_LT(off(fine, first), 1e-5);
  EXPECT_LT(off(fine, 3 * first), 1e-4);
}

// b tan b = I_bar/I_disc, f = b/(2 pi L) sqrt(G J/(rho I_p)).
TEST_F(BarModes, of_torsion_know_the_disc_at_the_end) {
  const materials::BeamSection s = bar_section();
  const double rotary = s.rotary2 + s.rotary3;
  for (const double disc : {1e-8, 1e-10}) { // kg m^2
    double b = 0, high = pi / 2;
    for (int halving = 0; halving < 60; ++halving)
      ((b + high) / 2 * std::tan((b + high) / 2) < rotary * length / disc ? b : high) = (b + high) / 2;
    const std::vector<double> found = frequencies(
        elements(16, 2),
        clamped + fmt::format("[[body]]\nname = \"d\"\nplaces = [\"b.end\"]\nmass = \"1 g\"\ninertia = [{0}, "
                              "{0}, {0}]\nfix = [\"y\", \"z\"]\n",
                              disc));
    EXPECT_LT(off(found, b / (2 * pi * length) * std::sqrt(s.GJ / rotary)), 1e-5) << disc;
  }
}

// E I k^4 - (rho A + (rho I + E I rho/(kappa G)) k^2) w^2 + rho^2 I/(kappa G) w^4 = 0 of a bar on two pivots.
TEST_F(BarModes, of_bending_are_those_of_timoshenko) {
  const materials::BeamSection s = bar_section();
  const std::vector<double> found = frequencies(
      elements(32, 2), "[[support]]\nplace = \"b.start\"\nfix = [\"x\", \"y\", \"z\", \"turn_x\"]\n"
                       "[[support]]\nplace = \"b.end\"\nfix = [\"y\", \"z\"]\n");
  for (const auto& [EI, GA, rotary] : {std::tuple{s.EI3, s.GA2, s.rotary3}, {s.EI2, s.GA3, s.rotary2}})
    for (int n = 1; n < 4; ++n) {
      const double k = n * pi / length, m = s.line_density;
      const double a = rotary * m / GA, b = m + (rotary + EI * m / GA) * k * k, c = EI * std::pow(k, 4);
      const double square = 2 * c / (b + std::sqrt(b * b - 4 * a * c));
      EXPECT_LT(off(found, std::sqrt(square) / (2 * pi)), 2e-5) << n;
    }
}

// What a bar that is let go keeps swinging with is what it was wound up with.
TEST_F(Turns, of_a_bar_that_winds_and_unwinds_keep_their_energy) {
  const Ran ran = run(bar(elements(8, 2), clamped +
                                              "[[body]]\nname = \"d\"\nplaces = [\"b.end\"]\n"
                                              "fix = [\"y\", \"z\", \"turn_y\", \"turn_z\"]\n"
                                              "[[load]]\nplace = \"d\"\nmoment = [\"2e-3 N m\", 0, 0]\n"
                                              "[[step]]\nkind = \"transient\"\ninertia = true\n"
                                              "duration = \"4 ms\"\nincrements = 400\n" +
                                              angle("x")));
  const double at_rest = 2e-3 * length / bar_section().GJ;
  const std::vector<double>& angles = ran.values.at("angle_x");
  EXPECT_NEAR(*std::ranges::max_element(angles), 2 * at_rest, 0.05 * at_rest); // a wave that comes back
  EXPECT_GT(2 * at_rest, 4 * pi);
  EXPECT_LT(std::abs(ran.last("energy_error")), 1e-2 * 2e-3 * 2 * at_rest);
}

// Two frequencies of the first meet in a pair that swings up, by an independent Hessian: the symmetric part
// of the tangent knows nothing of that. A thousandth of a thousandth of it changes nothing, nor does one axis
// alone.
TEST_F(Turns, about_several_axes_under_a_moment_have_no_modes) {
  const auto moment = [](const char* about) {
    return fmt::format("[[load]]\nplace = \"b\"\nmoment = {}\n[[step]]\nkind = \"force\"\n", about);
  };
  const std::string modes = "[[step]]\nkind = \"modes\"\ncount = 3\n",
                    stiffness =
                        "[[quantity]]\nname = \"k\"\nkind = \"stiffness\"\nof = \"m.end\"\nalong = \"z\"\n";
  const auto outcome = [&](const std::string& text) {
    write("moment.toml", text);
    SimulationObserver observer;
    observer.on_analysis = [](const Analysis&, const fem::State&) {};
    const Case one = read_case(directory / "moment.toml");
    return Simulation(one, 1).run(observer);
  };
  const Outcome refused = outcome(test::held_by_rods("", moment("[0.15e-3, -0.1e-3, 0.1e-3]") + modes));
  EXPECT_EQ(refused.ending, Ending::gave_up);
  EXPECT_NE(refused.message.find("moments about axes that stay"), std::string::npos) << refused.message;
  EXPECT_TRUE(
      std::isnan(run(test::held_by_rods("", moment("[0.15e-3, -0.1e-3, 0.1e-3]") + stiffness)).last("k")));
  const Ran light = run(test::held_by_rods("", moment("[0.15e-9, -0.1e-9, 0.1e-9]") + modes + stiffness)),
            about_one = run(test::held_by_rods("fix = [\"turn_x\", \"turn_z\"]\n",
                                               moment("[0, -0.1e-3, 0]") + modes + stiffness));
  // Ten times as large it ends where the symmetric part is no longer positive definite, which says little.
  const Outcome stopped = outcome(test::held_by_rods("", moment("[1.5e-3, -1e-3, 1e-3]")));
  EXPECT_EQ(stopped.ending, Ending::gave_up);
  EXPECT_NE(stopped.message.find("the path may well go on"), std::string::npos) << stopped.message;
  EXPECT_EQ(light.analyses.at(0).rows.size(), 3u);
  EXPECT_EQ(about_one.analyses.at(0).rows.size(), 1u);
  EXPECT_GT(light.last("k"), 0);
  EXPECT_GT(about_one.last("k"), 0);
}

} // namespace
} // namespace dielast::cases::turns_test
