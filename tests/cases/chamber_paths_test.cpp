// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/gmsh_text.hpp"
#include "meshing/rings.hpp"
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <numeric>

// Which states a run of a film with a chamber accepts, see paths_test.cpp.

namespace dielast::cases::chamber_paths_test {
namespace {

/// A balloon of a Gent material; `chamber`: sections of its chamber and steps.
std::string gent_balloon(const std::string& wrinkling, int rings, const std::string& chamber) {
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
{})toml",
                     wrinkling, rings, chamber);
}

/// Pumped past its greatest pressure: 1454.17 Pa at stretch 1.445 (closed form).
std::string gent_balloon(const std::string& wrinkling, int rings, int increments) {
  return gent_balloon(wrinkling, rings,
                      fmt::format(R"toml([chamber]
pressure = "1.6 kPa"
[[step]]
kind = "pressure"
increments = {}
)toml",
                                  increments));
}

TEST_F(Paths, a_balloon_stops_at_its_greatest_pressure) {
  for (const int increments : {5, 10, 13, 100}) {
    const Run stopped = run(gent_balloon("", 16, increments), "pressure");
    EXPECT_EQ(stopped.outcome.kind, "limit point");
    EXPECT_NEAR(stopped.rows.back().value, 1454.17, 0.1) << increments; // closed form, at stretch 1.445
  }
}

// Its least stress is at one place of its edge in these states and at another between them; with 160
// increments it is lost at 5669.4 V.
TEST_F(Paths, a_diaphragm_is_told_to_lose_its_tension_where_it_does) {
  for (const auto& [increments, within] : {std::pair{4, 0.01}, std::pair{10, 0.002}}) {
    const Run ran = run(fmt::format(R"toml(model = "axisymmetric"
[film]
thickness = "0.8 mm"
prestretch = 2.3
[film.material]
shear_modulus = "30 kPa"
permittivity = "4.16e-11 F/m"
[annulus]
inner_radius = "12 mm"
outer_radius = "50 mm"
[plate]
mass = "120 g"
[drive]
voltage = "6 kV"
[[step]]
kind = "weight"
[[step]]
kind = "voltage"
increments = {}
)toml",
                                    increments),
                        "breakdown_ratio");
    const auto told = std::ranges::find(ran.events, "loss of tension", &post::Event::kind);
    ASSERT_TRUE(told != ran.events.end() && told->before);
    EXPECT_NEAR(told->before->voltages.at(0), 5669.4, within * 5669.4) << increments;
  }
}

// The drawn state, flat: its volume is known to a rounding of the positions, not of itself.
TEST_F(Paths, a_disc_is_pumped_back_to_nothing) {
  for (const int increments : {20, 60, 200}) {
    const Run ran = run(fmt::format(R"toml(model = "axisymmetric"
[film]
thickness = "1 mm"
prestretch = 1.2
[film.material]
law = "gent"
stretch_limit = 150
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
[disc]
radius = "20 mm"
[mesh]
rings = 16
[chamber]
bulk_modulus = "100 kPa"
[[step]]
kind = "inflate"
to = "300 ml"
increments = 60
[[step]]
name = "down"
kind = "inflate"
to = "0 ml"
increments = {}
)toml",
                                    increments),
                        "pressure");
    EXPECT_EQ(ran.outcome.ending, Ending::complete) << ran.outcome.message;
    EXPECT_NEAR(ran.rows.back().value, 0, 1e-6);
    EXPECT_TRUE(ran.events.empty());
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

// Hardly any of what is pumped in widens film that carries no tension, as long as the gas gives way.
TEST_F(Paths, a_balloon_is_filled_with_gas_from_its_drawn_state) {
  for (const auto& [modulus, volume] : {std::pair{"100 Pa", 5.8399e-5}, std::pair{"3 kPa", 5.55483e-4}})
    for (const int increments : {1, 20, 200}) {
      const std::string chamber = fmt::format("[chamber]\nbulk_modulus = \"{}\"\n", modulus);
      const std::string step = fmt::format("[[step]]\nkind = \"inflate\"\nto = \"800 ml\"\n"
                                           "on_instability = \"jump\"\nincrements = {}\n",
                                           increments);
      const Run filled = run(gent_balloon("", 64, chamber + step), "volume");
      EXPECT_EQ(filled.outcome.ending, Ending::complete) << filled.outcome.message;
      EXPECT_TRUE(filled.events.empty()) << modulus << " " << increments;
      EXPECT_NEAR(filled.rows.back().value, volume, 1e-4 * volume); // closed form
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

// The same ring as a template, by its meridian, and as a mesh of one's own: the pressure acts on the plate,
// too.
TEST_F(Paths, a_plate_closes_the_chamber_below_any_film) {
  const std::string device =
      "[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nshear_modulus = \"45 kPa\"\n"
      "relative_permittivity = 4.5\n[plate]\nmass = \"5 g\"\n[chamber]\npressure = \"100 Pa\"\n"
      "[[step]]\nkind = \"pressure\"\nincrements = 4\n[[quantity]]\nname = \"volume\"\nkind = "
      "\"volume\"\n[[quantity]]\nname = \"height\"\nkind = \"displacement\"\nof = \"inner\"\nalong = "
      "\"z\"\n[output]\nerror_estimate = false\n";
  const std::string ring = "[annulus]\ninner_radius = \"10 mm\"\nouter_radius = \"30 mm\"\n";
  write("ring.msh", meshing::gmsh_text(meshing::annulus_mesh(10e-3, 30e-3, 8, 2, true, 4)));
  const auto
      exact = values("model = \"axisymmetric\"\n" + device + ring),
      drawn = values("model = \"3d\"\n" + device + ring + "[mesh]\nrings = 8\n"),
      own = values(
          "model = \"3d\"\n" + device +
          "[mesh]\nfile = \"ring.msh\"\nunit = \"1 m\"\n[[support]]\nplace = \"outer\"\nfix = [\"x\", \"y\", "
          "\"z\"]\n");
  for (const char* name : {"volume", "height"}) {
    EXPECT_NEAR(drawn.at(name), exact.at(name), 5e-3 * exact.at(name)) << name;
    EXPECT_NEAR(own.at(name), drawn.at(name), 1e-6 * drawn.at(name)) << name;
  }
}

/// A quarter of a ring of film, of 3-node triangles between rays and circles; its middle is at x = `from`, y
/// = 0.
meshing::Mesh quarter_of_a_ring(double inner, double outer, double from) {
  constexpr int along = 6, around = 8;
  meshing::Mesh mesh;
  std::vector<int> triangles;
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= around; ++j) {
      const double r = inner + (outer - inner) * i / along, angle = std::numbers::pi / 2 * j / around;
      const int node = mesh.node_count();
      mesh.nodes.emplace_back(from + r * (j == around ? 0 : std::cos(angle)), r * std::sin(angle), 0);
      if (i == 0) mesh.node_sets["inner"].push_back(node);
      if (i == along) mesh.node_sets["outer"].push_back(node);
      if (j == 0) mesh.node_sets["side_y"].push_back(node);
      if (j == around) mesh.node_sets["side_x"].push_back(node);
      if (i == along || j == around) continue;
      const int beyond = node + around + 1;
      triangles.insert(triangles.end(), {node, beyond, beyond + 1, node, beyond + 1, node + 1});
    }
  mesh.blocks = {{meshing::CellType::triangle3, triangles}};
  std::vector<int> all(triangles.size() / 3);
  std::iota(all.begin(), all.end(), 0);
  mesh.cell_sets["film"] = {0, all};
  std::vector<int>& nodes = mesh.node_sets["film"];
  nodes.resize(mesh.nodes.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  return mesh;
}

TEST_F(Paths, a_plate_closes_its_part_of_the_chamber_below_a_quarter) {
  const std::string device = "[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nshear_modulus = "
                             "\"45 kPa\"\nrelative_permittivity = "
                             "4.5\n[plate]\nmass = \"5 g\"\nat = \"inner\"\n[chamber]\npressure = \"100 "
                             "Pa\"\n[[step]]\nkind = \"pressure\"\n[[quantity]]\nname = "
                             "\"volume\"\nkind = \"volume\"\n[[quantity]]\nname = \"height\"\nkind = "
                             "\"displacement\"\nof = \"inner\"\nalong = \"z\"\n"
                             "[output]\nerror_estimate = false\n";
  const std::string own =
      "model = \"3d\"\n" + device +
      "[mesh]\nfile = \"quarter.msh\"\nunit = \"1 m\"\n[[support]]\nplace = \"outer\"\nfix = [\"x\", "
      "\"y\", \"z\"]\n[[support]]\nplace = \"side_x\"\nfix = [\"x\"]\n[[support]]\nplace = \"side_y\"\nfix = "
      "[\"y\"]\n";
  const auto whole = values("model = \"axisymmetric\"\n" + device +
                            "[annulus]\ninner_radius = \"10 mm\"\nouter_radius = \"30 mm\"\n");
  write("quarter.msh", meshing::gmsh_text(quarter_of_a_ring(10e-3, 30e-3, 0)));
  const auto quarter = values(own);
  EXPECT_NEAR(quarter.at("height"), whole.at("height"), 0.04 * whole.at("height"));
  EXPECT_NEAR(4 * quarter.at("volume"), whole.at("volume"), 0.04 * whole.at("volume"));
  write("quarter.msh", meshing::gmsh_text(quarter_of_a_ring(10e-3, 30e-3, 5e-3)));
  EXPECT_THROW(build_device(read(own)), CaseError);
}

} // namespace
} // namespace dielast::cases::chamber_paths_test
