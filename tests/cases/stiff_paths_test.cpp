// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>

#include <algorithm>

// Transients in which something flows much faster than the smallest increment lasts, and in which what has no
// mass follows what has one.

namespace dielast::cases::stiff_paths_test {
namespace {

class StiffPaths : public Paths {
 protected:
  /// Capacitance of a disc whose electrode has been at 4 kV, switched on at once, for 500 s.
  double switched_disc(const std::string& branch, const std::string& sheet) {
    const Run done =
        run("[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nshear_modulus = \"40 kPa\"\n"
            "permittivity = \"4e-11 F/m\"\n" +
                branch +
                "[disc]\nradius = \"30 mm\"\nelectrode_radius = \"15 mm\"\n[mesh]\nrings = 3\norder = 1\n"
                "[[electrode]]\nname = \"film\"\nplace = \"electrode\"\n" +
                sheet +
                "[drive]\nvoltage = { wave = \"step\", to = \"4 kV\" }\n"
                "[[step]]\nkind = \"transient\"\nduration = \"500 s\"\nincrements = 20\n",
            "capacitance");
    EXPECT_EQ(done.outcome.ending, Ending::complete) << done.outcome.message;
    return done.rows.back().value;
  }

  static bool is_resolved(const Run& done) {
    return std::ranges::none_of(done.events,
                                [](const post::Event& event) { return event.kind == "unresolved energy"; });
  }

  /// A balloon of massless film, with a limit point of its pressure at which it has twice its volume, and a
  /// ring of 1000 t around its equator, which hardly moves.
  Run balloon_in_a_ring(const std::string& pressure, const std::string& more, int stretch_limit = 60) {
    return run(fmt::format(R"toml([film]
thickness = "0.5 mm"
[film.material]
law = "gent"
shear_modulus = "45 kPa"
stretch_limit = {}
permittivity = "4e-11 F/m"
density = 0
[balloon]
radius = "20 mm"
[mesh]
rings = 16
[chamber]
pressure = {}
[[point_mass]]
place = "equator"
mass = "1e6 kg"
[[step]]
kind = "transient"
duration = "1 s"
increments = 10
inertia = true
{})toml",
                           stretch_limit, pressure, more),
               "volume");
  }
};

constexpr const char* ramp_to_far_beyond = "{ wave = \"ramp\", to = \"2.6 kPa\", duration = \"1 s\" }";

// What flows within the first increment, however small it is, takes the film continuously to where it would
// be if it had flowed at once: that is no other branch.
TEST_F(StiffPaths, a_sheet_that_hardly_resists_ends_where_one_that_does_not_resist_does) {
  const double ideal = switched_disc("", "");
  for (const char* resistance : {"1 mOhm", "1 Ohm", "100 Ohm", "10 kOhm"}) {
    const std::string sheet =
        fmt::format("sheet_resistance = \"{}\"\nterminal = \"electrode_edge\"\n", resistance);
    EXPECT_NEAR(switched_disc("", sheet), ideal, 1e-6 * ideal) << resistance;
  }
}

TEST_F(StiffPaths, dashpots_that_flow_at_once_end_where_film_without_them_does) {
  const double relaxed = switched_disc("", "");
  for (const char* time : {"1e-9 s", "1e-7 s"}) {
    const std::string branch =
        fmt::format("[[film.material.branch]]\nshear_modulus = \"40 kPa\"\nrelaxation_time = \"{}\"\n", time);
    EXPECT_NEAR(switched_disc(branch, ""), relaxed, 1e-6 * relaxed) << time;
  }
}

// The masses' motion has no other branch, but what has no mass has: it leapt over its limit point, at 60
// with an energy that did not balance, and ended at others without a word of them.
TEST_F(StiffPaths, film_without_a_mass_has_its_limit_point_beside_a_mass_that_hardly_moves) {
  struct Limit {
    int stretch_limit;
    double time; ///< s, of a run without a mass whose equator is held
  };
  for (const Limit& limit : {Limit{60, 0.707768}, {80, 0.700364}, {140, 0.691817}})
    for (const char* tolerance : {"1e-6", "1e-3"}) {
      const Run stopped = balloon_in_a_ring(
          ramp_to_far_beyond, fmt::format("[solver]\ntime_tolerance = {}\n", tolerance), limit.stretch_limit);
      EXPECT_EQ(stopped.outcome.kind, "limit point") << stopped.outcome.message;
      EXPECT_NEAR(stopped.rows.back().time, limit.time, 1e-5) << limit.stretch_limit << ", " << tolerance;
    }
}

TEST_F(StiffPaths, film_without_a_mass_jumps_beside_one_where_it_may) {
  const Run jumped = balloon_in_a_ring(ramp_to_far_beyond, "on_instability = \"jump\"\n");
  EXPECT_EQ(jumped.outcome.ending, Ending::complete) << jumped.outcome.message;
  EXPECT_TRUE(is_resolved(jumped));
  EXPECT_GT(jumped.rows.back().value, 1.6e-3); // m^3; of the near branch at most 1.1e-4
}

TEST_F(StiffPaths, a_load_that_jumps_takes_film_without_a_mass_along_its_path) {
  const Run below = balloon_in_a_ring("{ wave = \"step\", to = \"1.7 kPa\" }", "");
  EXPECT_EQ(below.outcome.ending, Ending::complete) << below.outcome.message;
  EXPECT_TRUE(is_resolved(below));
  const Run beyond = balloon_in_a_ring("{ wave = \"step\", to = \"1.9 kPa\" }", "");
  EXPECT_EQ(beyond.outcome.kind, "limit point") << beyond.outcome.message;
  EXPECT_LT(beyond.rows.back().value, 1.1e-4);
  EXPECT_NE(beyond.outcome.message.find("near 1.8"), std::string::npos) << beyond.outcome.message; // kPa
}

// A message names the loads, or that there are none yet.
TEST_F(StiffPaths, film_that_never_carries_its_loads_is_called_slack) {
  const Run stopped = run(R"toml(model = "3d"
[film]
thickness = "1 mm"
wrinkling = "tension field"
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
[disc]
radius = "20 mm"
electrode_radius = "10 mm"
[mesh]
rings = 3
[drive]
voltage = "2 kV"
[[step]]
kind = "voltage"
)toml",
                          "capacitance");
  EXPECT_EQ(stopped.outcome.kind, "slack film");
  EXPECT_NE(stopped.outcome.message.find("stopped at the beginning of the step, where"), std::string::npos)
      << stopped.outcome.message;
}

// Film without tension has no stiffness across itself at the start.
TEST_F(StiffPaths, a_plate_sinks_into_film_that_was_not_stretched) {
  const auto drop = [this](const std::string& model, int rings) {
    const Run done = run(fmt::format(R"toml(model = "{}"
[film]
thickness = "1 mm"
prestretch = 1
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
[annulus]
inner_radius = "12.7 mm"
outer_radius = "68.58 mm"
[mesh]
rings = {}
[plate]
mass = "100 g"
[[step]]
kind = "weight"
)toml",
                                     model, rings),
                         "drop");
    EXPECT_EQ(done.outcome.ending, Ending::complete) << done.outcome.message;
    return done.rows.back().value;
  };
  const double meridian = drop("axisymmetric", 32);
  EXPECT_NEAR(drop("3d", 4), meridian, 2e-3 * meridian);
}

TEST_F(StiffPaths, taut_film_is_that_of_a_model_without_wrinkles) {
  const auto capacitance = [this](const char* wrinkling) {
    const Run done = run(fmt::format(R"toml([film]
thickness = "1 mm"
prestretch = 1.5
{}[film.material]
law = "gent"
shear_modulus = "40 kPa"
stretch_limit = 60
permittivity = "4e-11 F/m"
[disc]
radius = "20 mm"
electrode_radius = "10 mm"
[mesh]
rings = 4
[drive]
voltage = "3 kV"
[[step]]
kind = "voltage"
)toml",
                                     wrinkling),
                         "capacitance");
    EXPECT_EQ(done.outcome.ending, Ending::complete) << done.outcome.message;
    for (const post::Event& event : done.events) ADD_FAILURE() << event.message;
    return done.rows.back().value;
  };
  const double plain = capacitance("");
  EXPECT_NEAR(capacitance("wrinkling = \"tension field\"\n"), plain, 1e-9 * plain);
}

} // namespace
} // namespace dielast::cases::stiff_paths_test
