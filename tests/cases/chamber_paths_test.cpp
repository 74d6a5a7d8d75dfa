// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>

#include <cmath>

// Which states a run of a film with a chamber accepts, see paths_test.cpp.

namespace dielast::cases {
namespace {

/// A balloon of a Gent material, pumped past its greatest pressure: 1454.17 Pa at stretch 1.445 (closed
/// form).
std::string gent_balloon(const std::string& wrinkling, int rings, int increments) {
  return fmt::format(R"toml([film]
thickness = "0.5 mm"
{}[film.material]
law = "gent"
shear_modulus = "45 kPa"
stretch_limit = 30
permittivity = "4e-11 F/m"
[balloon]
radius = "20 mm"
[mesh]
rings = {}
[chamber]
pressure = "1.6 kPa"
[[step]]
kind = "pressure"
increments = {}
)toml",
                     wrinkling, rings, increments);
}

TEST_F(Paths, a_balloon_stops_at_its_greatest_pressure) {
  for (const int increments : {5, 10, 13, 100}) {
    const Run stopped = run(gent_balloon("", 16, increments), "pressure");
    EXPECT_EQ(stopped.outcome.kind, "limit point");
    EXPECT_NEAR(stopped.rows.back().value, 1454.17, 0.1) << increments; // closed form, at stretch 1.445
  }
}

// The tangent that Newton's last step was taken with told of an unstable mode that the state itself has not.
TEST_F(Paths, a_filled_balloon_ends_at_its_bifurcation_whatever_the_increments) {
  std::vector<double> ends;
  for (const int increments : {4, 100, 331, 700}) {
    const Run stopped = run(fmt::format(R"toml([film]
thickness = "1 mm"
[film.material]
law = "yeoh"
c1 = "23.596414361381903 kPa"
c2 = "-0.057683585822078894 kPa"
c3 = "0.0015656637500486186 kPa"
permittivity = "4e-11 F/m"
[mesh]
rings = 6
[balloon]
radius = "20 mm"
[chamber]
volume = "715.110737991969 ml"
bulk_modulus = "96802.75499534968 kPa"
[[step]]
kind = "inflate"
increments = {}
)toml",
                                        increments),
                            "pressure");
    EXPECT_EQ(stopped.outcome.kind, "limit point") << increments;
    ends.push_back(stopped.rows.back().load_factor);
    EXPECT_NEAR(ends.back(), ends.front(), 1e-6) << increments;
  }
}

// States were extrapolated in the square of the pressure, far off, and met the branch beyond the limit point.
TEST_F(Paths, a_charged_balloon_is_not_led_astray_by_the_predictor) {
  std::vector<double> ends;
  for (const int increments : {10, 14, 100, 300}) {
    const Run stopped = run(fmt::format(R"toml([film]
thickness = "1 mm"
[film.material]
law = "arruda-boyce"
shear_modulus = "26.578 kPa"
locking_stretch = 3.0845
permittivity = "4e-11 F/m"
[mesh]
rings = 6
[balloon]
radius = "20 mm"
[[electrode]]
name = "film"
place = "film"
[chamber]
pressure = "6.294 kPa"
[drive]
voltage = "13927 V"
[[step]]
kind = "voltage"
[[step]]
kind = "pressure"
increments = {}
)toml",
                                        increments),
                            "pressure");
    EXPECT_EQ(stopped.outcome.kind, "limit point") << increments;
    ends.push_back(stopped.rows.back().value);
    EXPECT_NEAR(ends.back(), ends.front(), 1e-3) << increments;
  }
  EXPECT_NEAR(ends.front(), 0.1234 * 6294, 1);
}

// From slack film no path leads: what is found there must lead back.
TEST_F(Paths, a_balloon_that_starts_slack_stops_at_its_greatest_pressure) {
  for (const int increments : {1, 2, 5, 13}) {
    const Run stopped = run(gent_balloon("wrinkling = \"tension field\"\n", 8, increments), "pressure");
    EXPECT_EQ(stopped.outcome.kind, "limit point") << increments;
    EXPECT_NEAR(stopped.rows.back().value, 1454.28, 0.1) << increments; // on eight rings
  }
}

/// A prestretched disc under which a liquid is shut in, and which is then driven.
const std::string shut_in = R"toml(model = "axisymmetric"
[film]
thickness = "1 mm"
prestretch = 1.93
[film.material]
law = "mooney-rivlin"
c1 = "56 kPa"
c2 = "0.66 kPa"
permittivity = "4e-11 F/m"
[mesh]
rings = 6
[disc]
radius = "40 mm"
electrode_radius = "25 mm"
[chamber]
volume = "61 ml"
[drive]
voltage = "51 kV"
[[step]]
kind = "inflate"
[[step]]
kind = "voltage"
)toml";

// Rounding leaves a stress of 1e-10 Pa in flat film without a prestretch: no stiffness that a slope of the
// path could be told by.
TEST_F(Paths, a_slack_disc_rises_whatever_rounding_leaves_in_it) {
  for (const int rings : {8, 10, 12, 13})
    for (const double thickness : {0.9, 1.455443094105451}) {
      const Run pressed = run(fmt::format(R"toml([film]
thickness = "{} mm"
prestretch = 1
[film.material]
law = "ogden"
moduli = ["35.82456332556839 kPa"]
exponents = [2.5]
permittivity = "4e-11 F/m"
[disc]
radius = "20 mm"
electrode_radius = "5.197127879316197 mm"
[mesh]
rings = {}
[chamber]
pressure = "170 Pa"
[[step]]
kind = "pressure"
)toml",
                                          thickness, rings),
                              "pressure");
      EXPECT_EQ(pressed.outcome.ending, Ending::complete) << rings << " " << pressed.outcome.message;
    }
}

TEST_F(Paths, a_closed_chamber_has_its_limit_point_whatever_the_increments) {
  std::vector<double> limits;
  for (const int increments : {1, 4, 30}) {
    const Run stopped = run(shut_in + fmt::format("increments = {}\n", increments), "electrode_radius");
    EXPECT_EQ(stopped.outcome.kind, "limit point") << stopped.outcome.message;
    limits.push_back(stopped.rows.back().load_factor);
    EXPECT_NEAR(limits.back(), limits.front(), 1e-6) << increments;
  }
}

// A filled balloon under voltage swells more on one side of its equator: a bifurcation.
TEST_F(Paths, a_bifurcation_is_where_it_is_whatever_the_increments) {
  std::vector<double> critical;
  for (const int increments : {3, 100}) {
    const Run stopped = run(fmt::format(R"toml([film]
thickness = "1 mm"
[film.material]
law = "yeoh"
c1 = "6.2 kPa"
c2 = "-0.06 kPa"
c3 = "0.0054 kPa"
permittivity = "4e-11 F/m"
[balloon]
radius = "20 mm"
[[electrode]]
name = "film"
place = "film"
[mesh]
rings = 6
[chamber]
volume = "130 ml"
[drive]
voltage = "9 kV"
[[step]]
kind = "inflate"
[[step]]
kind = "voltage"
increments = {}
)toml",
                                        increments),
                            "pressure");
    EXPECT_EQ(stopped.outcome.kind, "limit point");
    EXPECT_NE(stopped.outcome.message.find("(a bifurcation)"), std::string::npos) << stopped.outcome.message;
    critical.push_back(stopped.rows.back().load_factor);
    // what ends the run is one event, called what the run's ending is
    const auto is_critical_point = [](const post::Event& event) { return is_critical(event.kind); };
    EXPECT_EQ(std::ranges::count_if(stopped.events, is_critical_point), 1);
    EXPECT_EQ(stopped.events.back().kind, stopped.outcome.kind);
  }
  EXPECT_NEAR(critical[0], critical[1], 1e-6);
}

} // namespace
} // namespace dielast::cases
