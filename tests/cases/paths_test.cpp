// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases::paths_test {
namespace {

/// A free film of a Gent material that pulls in under a dead stress of mu: at 12516.7 V and stretch 1.781.
const std::string pull_in = R"toml([film]
thickness = "1 mm"
[film.material]
law = "gent"
shear_modulus = "45 kPa"
stretch_limit = 100
permittivity = "4e-11 F/m"
[patch]
mode = "equal-biaxial"
stress_x = "45 kPa"
)toml";
constexpr double pull_in_voltage = 12516.7;

TEST_F(Paths, a_limit_point_stops_any_number_of_increments) {
  for (const int increments : {1, 2, 3, 5, 10, 17, 20, 40, 100, 200}) {
    SCOPED_TRACE(increments);
    const Run stopped =
        run(pull_in + steps("\"20 kV\"", fmt::format("kind = \"voltage\"\nincrements = {}\n", increments)),
            "stretch_x");
    EXPECT_EQ(stopped.outcome.ending, Ending::gave_up);
    EXPECT_EQ(stopped.outcome.kind, "limit point");
    // the last equilibrium is a row, with the loads of the limit
    EXPECT_NEAR(stopped.rows.back().voltage, pull_in_voltage, 0.1);
    EXPECT_NEAR(stopped.rows.back().load_factor, pull_in_voltage / 20e3, 1e-5);
    EXPECT_NEAR(stopped.rows.back().value, 1.781, 1e-3);
    for (const Row& row : stopped.rows) EXPECT_EQ(row.unstable_modes, 0);
  }
}

TEST_F(Paths, a_jump_lands_on_the_far_branch_from_the_limit_itself) {
  for (const int increments : {10, 100}) {
    const Run jumped = run(pull_in + steps("\"13 kV\"", fmt::format("kind = \"voltage\"\nincrements = {}\n"
                                                                    "on_instability = \"jump\"\n",
                                                                    increments)),
                           "stretch_x");
    EXPECT_EQ(jumped.outcome.ending, Ending::complete) << jumped.outcome.message;
    const auto far =
        std::find_if(jumped.rows.begin(), jumped.rows.end(), [](const Row& row) { return row.value > 3; });
    ASSERT_NE(far, jumped.rows.end());
    EXPECT_NEAR(far->voltage, pull_in_voltage, 0.1);
    EXPECT_NEAR((far - 1)->voltage, pull_in_voltage, 0.1);
    EXPECT_EQ(std::count_if(jumped.events.begin(), jumped.events.end(),
                            [](const post::Event& event) { return event.kind == "limit point"; }),
              1);
  }
}

// There is no way to the drawn state on which the loss of tension could be located.
TEST_F(Paths, film_drawn_without_tension_has_lost_it_there) {
  const Run pressed =
      run("[film]\nthickness = \"0.2 mm\"\nprestretch = [1.2, 0.9]\n[film.material]\n"
          "shear_modulus = \"45 kPa\"\nrelative_permittivity = 4.7\n[disc]\nradius = \"30 mm\"\n"
          "[mesh]\nrings = 3\n[drive]\nvoltage = \"0.1 kV\"\n",
          "max_field");
  EXPECT_EQ(pressed.outcome.ending, Ending::complete) << pressed.outcome.message;
  ASSERT_FALSE(pressed.events.empty());
  EXPECT_EQ(pressed.events.front().kind, "loss of tension");
  EXPECT_NEAR(pressed.rows.back().value, 0.1e3 * 1.08 / 0.2e-3, 1);
}

TEST_F(Paths, a_followed_fold_is_one_event) {
  const Run followed = run(pull_in + steps("\"13 kV\"", "kind = \"voltage\"\nincrements = 40\n"
                                                        "on_instability = \"follow\"\n"),
                           "stretch_x");
  EXPECT_EQ(followed.outcome.ending, Ending::complete) << followed.outcome.message;
  std::vector<std::string> folds;
  for (const post::Event& event : followed.events)
    if (event.kind == "limit point") folds.push_back(event.message);
  EXPECT_EQ(folds.size(), 2U) << fmt::format("{}", folds.size()); // pull-in, and the valley behind it
  for (const post::Event& event : followed.events)
    EXPECT_EQ(event.message.find("buckle"), std::string::npos) << event.message;
}

TEST_F(Paths, in_time_pull_in_is_a_limit_point_too) {
  for (const int increments : {10, 30}) {
    SCOPED_TRACE(increments);
    const Run stopped = run(
        pull_in +
            steps("{ wave = \"trapezoid\", to = \"16 kV\", rise = \"1 s\", hold = \"1 s\", fall = \"1 s\" }",
                  fmt::format("kind = \"transient\"\nduration = \"1 s\"\nincrements = {}\n", increments)),
        "stretch_x");
    EXPECT_EQ(stopped.outcome.ending, Ending::gave_up);
    EXPECT_EQ(stopped.outcome.kind, "limit point") << stopped.outcome.message;
    EXPECT_NEAR(stopped.rows.back().voltage, pull_in_voltage, 0.1);
    EXPECT_NEAR(stopped.rows.back().time, pull_in_voltage / 16e3, 1e-5);
  }
}

TEST_F(Paths, the_last_state_with_a_permittivity_is_kept) {
  const Run stopped = run(R"toml([film]
thickness = "1 mm"
[film.material]
shear_modulus = "40 kPa"
relative_permittivity = 4.7
electrostriction = -0.4
[patch]
mode = "equal-biaxial"
stress_x = "150 kPa"
[drive]
voltage = "1 kV"
[[step]]
kind = "voltage"
[[step]]
kind = "force"
increments = 3
)toml",
                          "stretch_x");
  EXPECT_EQ(stopped.outcome.kind, "loss of permittivity") << stopped.outcome.message;
  EXPECT_LT(stopped.rows.back().value, 2.25); // 1 + c (2 l - 2) = 0
  EXPECT_GT(stopped.rows.back().value, 2.24);
}

// One increment of Newton's method turns these films inside out, or leads to a second equilibrium far away.
TEST_F(Paths, a_film_that_settles_goes_back_to_where_it_is_free) {
  for (const double prestretch : {1.9, 2.15, 3.0}) {
    const Run settled = run(fmt::format(R"toml([film]
thickness = "1 mm"
prestretch = {}
[film.material]
law = "yeoh"
c1 = "200 kPa"
c2 = "-3 kPa"
permittivity = "3e-11 F/m"
[patch]
mode = "equal-biaxial"
[drive]
voltage = "1 kV"
)toml",
                                        prestretch),
                            "stretch_x");
    EXPECT_EQ(settled.outcome.ending, Ending::complete) << settled.outcome.message;
    EXPECT_NEAR(settled.rows.back().value, 1.0, 1e-4) << prestretch;
    for (const Row& row : settled.rows) EXPECT_GT(row.value, 0.9);
  }
}

TEST_F(Paths, dashpots_that_flow_after_an_instantaneous_step_do_not_throw_the_film_through_zero) {
  const Run relaxed = run(R"toml([film]
thickness = "1 mm"
[film.material]
shear_modulus = "5 kPa"
permittivity = "4e-11 F/m"
[[film.material.branch]]
law = "st-venant-kirchhoff"
youngs_modulus = "5.6 kPa"
poisson_ratio = 0.3
relaxation_time = "1 s"
dashpot = "nominal"
[patch]
mode = "equal-biaxial"
stress_x = "6.3 kPa"
[drive]
voltage = "3 kV"
[[step]]
kind = "force"
increments = 3
response = "instantaneous"
[[step]]
kind = "voltage"
increments = 8
)toml",
                          "stretch_x");
  EXPECT_EQ(relaxed.outcome.ending, Ending::complete) << relaxed.outcome.message;
  // the neo-Hookean film alone: s = mu (l - l^-5) - eps E^2 l^3
  EXPECT_NEAR(relaxed.rows[4].value, 1.43033, 1e-4);
  EXPECT_NEAR(relaxed.rows.back().value, 1.6737, 1e-4);
  for (std::size_t r = 5; r < relaxed.rows.size(); ++r)
    EXPECT_GT(relaxed.rows[r].value, relaxed.rows[r - 1].value);
}

// A branch much quicker than the step: its first increments are shorter than any other path would ask for,
// and were taken for a limit point.
TEST_F(Paths, quick_branches_flow_to_their_end) {
  constexpr double voltage = 11.619e3;
  for (const char* time : {"1e-4 s", "3e-4 s", "1e-3 s"}) {
    const Run flown = run(fmt::format(R"toml([film]
thickness = "1 mm"
[film.material]
law = "gent"
shear_modulus = "18 kPa"
stretch_limit = 110
permittivity = "4e-11 F/m"
[[film.material.branch]]
law = "gent"
shear_modulus = "42 kPa"
stretch_limit = 55
relaxation_time = "{}"
[patch]
mode = "equal-biaxial"
[drive]
voltage = "{} V"
[[step]]
kind = "voltage"
response = "instantaneous"
[[step]]
kind = "hold"
duration = "500 s"
increments = 500
[solver]
time_tolerance = "1e-8"
)toml",
                                      time, voltage),
                          "stretch_x");
    EXPECT_EQ(flown.outcome.ending, Ending::complete) << time << flown.outcome.message;
    // the film without its branch: mu (l^2 - l^-4) / (1 - (2 l^2 + l^-4 - 3)/J) = eps (Phi/H)^2 l^4
    const double l = flown.rows.back().value, stiffening = 1 - (2 * l * l + std::pow(l, -4) - 3) / 110;
    EXPECT_NEAR(18e3 * (l * l - std::pow(l, -4)) / stiffening, 4e-11 * std::pow(voltage / 1e-3 * l * l, 2), 1)
        << time;
  }
}

std::string diaphragm(const std::string& prestretch, const std::string& voltage) {
  return fmt::format(R"toml(model = "axisymmetric"
[film]
thickness = "1 mm"
prestretch = {}
[film.material]
shear_modulus = "40 kPa"
relative_permittivity = 4.7
[annulus]
inner_radius = "12.7 mm"
outer_radius = "68.58 mm"
[mesh]
rings = 12
[plate]
at = "inner"
mass = "100 g"
[drive]
voltage = "{}"
[[step]]
kind = "weight"
[[step]]
kind = "voltage"
)toml",
                     prestretch, voltage);
}

TEST_F(Paths, far_beyond_a_limit_point_no_unstable_state_is_accepted) {
  for (const char* voltage : {"100 kV", "1000 kV"}) {
    const Run stopped = run(diaphragm("2.0", voltage), "drop");
    EXPECT_EQ(stopped.outcome.ending, Ending::gave_up) << voltage;
    for (const Row& row : stopped.rows) EXPECT_EQ(row.unstable_modes, 0);
  }
}

TEST_F(Paths, a_start_that_is_unstable_is_told_and_not_called_a_limit_point) {
  const Run stopped = run(diaphragm("0.5", "1 kV"), "drop");
  EXPECT_EQ(stopped.outcome.ending, Ending::gave_up);
  EXPECT_EQ(stopped.outcome.kind, "instability") << stopped.outcome.message;
}

TEST_F(Paths, what_was_accepted_before_a_stop_is_kept_in_rows) {
  std::string text = test::small_honeycomb;
  text.replace(text.find("6 kV"), 4, "20 kV");
  text.replace(text.find("increments = 3"), 14, "increments = 2");
  text += "[[check]]\nquantity = \"eps_y\"\nvalue = 0.3\ntolerance = 1.0\nsource = \"anything\"\n";
  const Run stopped = run(text, "eps_y");
  EXPECT_EQ(stopped.outcome.ending, Ending::gave_up);
  EXPECT_GT(stopped.rows.size(), 4U); // drawn, released, sub-steps, the limit
  EXPECT_GT(stopped.rows.back().load_factor, stopped.rows[stopped.rows.size() - 2].load_factor);
  const double between = stopped.rows.back().load_factor - stopped.rows[stopped.rows.size() - 2].load_factor;
  EXPECT_LT(between, 0.01);
  // the end of the run was not reached: nothing can be checked there
  ASSERT_EQ(stopped.results.checks.size(), 1U);
  EXPECT_FALSE(stopped.results.checks[0].passed);
}

// 2.4 uN bend a strip of 28.5 um by nearly all of its length: the first increment that Newton's method finds
// is a ten-thousandth of that, however many are asked for.
TEST_F(Paths, AThinCantileverNeedsNoKeysOfTheSolver) {
  for (const int increments : {3, 100}) {
    const Run done =
        run(fmt::format("model = \"3d\"\n[film]\nthickness = \"28.5 um\"\nsection = \"shell\"\n"
                        "[film.material]\nshear_modulus = \"20 kPa\"\npermittivity = \"4e-11 F/m\"\n"
                        "[rectangle]\nlength = \"7.5 mm\"\nwidth = \"2.25 mm\"\n[mesh]\nacross = 2\n"
                        "[[support]]\nplace = \"left\"\n"
                        "fix = [\"x\", \"y\", \"z\", \"turn_x\", \"turn_y\", \"turn_z\"]\n"
                        "[[load]]\nplace = \"right\"\nforce = [0, 0, \"2.4 uN\"]\n"
                        "[[step]]\nkind = \"force\"\nincrements = {}\n[[quantity]]\n"
                        "name = \"tip\"\nkind = \"displacement\"\nof = \"right\"\nalong = \"z\"\n",
                        increments),
            "tip");
    EXPECT_EQ(done.outcome.ending, Ending::complete) << done.outcome.message;
    EXPECT_NEAR(done.rows.back().value, 7.31936e-3, 1e-8) << increments;
  }
}

/// Its voltage rises without end while mode after mode loses its stiffness, two of them close to one another:
/// a mixture of these took part in the load, and was called a limit point.
TEST_F(Paths, a_flat_plate_has_no_limit_points) {
  const Run plate =
      run("model = \"3d\"\n[film]\nthickness = \"1 mm\"\nsection = \"shell\"\n[film.material]\n"
          "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[rectangle]\nlength = \"50 mm\"\n"
          "[mesh]\nacross = 8\n[drive]\nvoltage = \"3.4 kV\"\n[[support]]\nplace = \"frame\"\n"
          "fix = [\"x\", \"y\", \"z\"]\n[output]\nerror_estimate = false\n[[quantity]]\nname = \"w\"\n"
          "kind = \"displacement\"\nof = \"centre\"\nalong = \"z\"\n[[step]]\nkind = \"voltage\"\n"
          "increments = 34\non_instability = \"follow\"\non_bifurcation = \"follow\"\n",
          "w");
  EXPECT_EQ(plate.outcome.ending, Ending::complete) << plate.outcome.message;
  EXPECT_EQ(std::ranges::count(plate.events, "bifurcation", &post::Event::kind), 3);
  EXPECT_EQ(std::ranges::count(plate.events, "limit point", &post::Event::kind), 0);
}

/// The plate bears inertia, the film none: while the voltage jumps the plate stands still, to the digit, and
/// nothing that pulls at it counts.
TEST_F(Paths, film_without_mass_takes_a_jump_under_a_heavy_plate) {
  const Run lifted =
      run("[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nlaw = \"gent\"\n"
          "shear_modulus = \"40 kPa\"\nstretch_limit = 110\nrelative_permittivity = 4.7\n"
          "density = \"0 kg/m^3\"\n[annulus]\ninner_radius = \"12.7 mm\"\nouter_radius = \"68.58 mm\"\n"
          "[plate]\nmass = \"100 g\"\n[mesh]\nrings = 32\n[circuit]\nresistance = \"2 MOhm\"\n[drive]\n"
          "voltage = { wave = \"step\", to = \"5 kV\", at = \"0.1 s\" }\n[solver]\ntime_tolerance = 8e-6\n"
          "[output]\nerror_estimate = false\n[[step]]\nkind = \"weight\"\nincrements = 2\n[[step]]\n"
          "kind = \"transient\"\nduration = \"2 s\"\nincrements = 50\n",
          "stroke");
  EXPECT_EQ(lifted.outcome.ending, Ending::complete) << lifted.outcome.message;
}

// Thin and clamped, of solid film: under 1 % of its load it bends so far that Newton's method creeps, and its
// lowest eigenvalue, all but zero at first, grows.
TEST_F(Paths, a_thin_plate_of_solid_film_has_no_limit_point) {
  const auto plate = [this](int increments, const std::string& solver) {
    return run(
        "model = \"axisymmetric\"\n[film]\nthickness = \"1 mm\"\nsection = \"solid\"\n[film.material]\n"
        "shear_modulus = \"40 kPa\"\nrelative_permittivity = 4.7\n[slab]\nlength = \"50 mm\"\nheight = "
        "\"1 mm\"\n[mesh]\nacross = 2\ngrading = 3\n[chamber]\npressure = \"100 Pa\"\nat = \"bottom\"\n"
        "[[support]]\nplace = \"right\"\nfix = [\"x\", \"z\"]\n[[support]]\nplace = \"left\"\nfix = "
        "[\"x\"]\n[[quantity]]\nname = \"w\"\nkind = \"displacement\"\nof = \"left\"\nalong = \"z\"\n"
        "[output]\nerror_estimate = false\n[[step]]\nkind = \"pressure\"\nincrements = " +
            std::to_string(increments) + "\n" + solver,
        "w");
  };
  for (const int increments : {10, 25}) {
    const Run bent = plate(increments, "");
    EXPECT_EQ(bent.outcome.ending, Ending::complete) << bent.outcome.message;
    EXPECT_TRUE(bent.events.empty()) << bent.events.front().message;
    EXPECT_NEAR(bent.rows.back().value, 10.683975e-3, 1e-9);
  }
  const Run stopped = plate(10, "[solver]\nsmallest_increment = 1e-3\n");
  EXPECT_EQ(stopped.outcome.kind, "no equilibrium") << stopped.outcome.message;
  for (const post::Event& event : stopped.events) EXPECT_NE(event.kind, "limit point");
}

} // namespace
} // namespace dielast::cases::paths_test
