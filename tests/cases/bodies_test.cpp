// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/checkpoint.hpp"
#include "tests/cases/film_cases.hpp"

#include <cmath>

// Rigid bodies that carry places of the film, through case files.

namespace dielast::cases::bodies_test {
namespace {

/// An annulus in space or in the plane whose inner edge a body of 2 g carries, 3 mm beside the middle.
std::string annulus(const std::string& model, const std::string& body, const std::string& rest) {
  return "model = \"" + model +
         "\"\n[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nlaw = \"neo-hookean\"\n"
         "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\ndensity = \"0 kg/m^3\"\n"
         "[annulus]\ninner_radius = \"10 mm\"\nouter_radius = \"40 mm\"\n[mesh]\nrings = 5\n"
         "[[support]]\nplace = \"outer\"\nfix = [\"x\", \"y\", \"z\"]\n"
         "[[body]]\nname = \"hub\"\nplaces = [\"inner\"]\nmass = \"2 g\"\n"
         "centre = [\"3 mm\", \"0 mm\", \"0 mm\"]\n" +
         body +
         "[output]\nfields = false\nerror_estimate = false\n"
         "[[quantity]]\nname = \"angle\"\nkind = \"angle\"\nof = \"hub\"\nalong = \"y\"\n" +
         rest;
}

std::string quantity(const std::string& name, const std::string& kind, const std::string& along) {
  return fmt::format("[[quantity]]\nname = \"{}\"\nkind = \"{}\"\nof = \"hub\"\nalong = \"{}\"\n", name, kind,
                     along);
}

constexpr double weight = 2e-3 * 9.81, arm = 3e-3;

class Bodies : public FilmCases {};

TEST_F(Bodies, a_pivot_and_a_fixed_rotation_carry_the_weight_and_its_moment) {
  const Ran ran = run(annulus("3d", "pivot = [\"0 mm\", \"0 mm\", \"0 mm\"]\nfix = [\"turn_y\"]\n",
                              "[[step]]\nkind = \"weight\"\n" + quantity("lift", "force", "z") +
                                  quantity("moment", "moment", "y") + quantity("sag", "displacement", "z")));
  EXPECT_NEAR(ran.last("lift"), weight, 1e-9);
  EXPECT_NEAR(ran.last("moment"), -weight * arm, 1e-12); // gravity turns it the other way
  EXPECT_EQ(ran.last("angle"), 0);
  EXPECT_EQ(ran.last("sag"), 0);
}

TEST_F(Bodies, what_no_support_takes_the_film_does) {
  const Ran ran =
      run(annulus("3d", "", "[[step]]\nkind = \"weight\"\n" + quantity("sag", "displacement", "gravity")));
  const double a = 10e-3, b = 40e-3, tension = 40e3 * 1e-3 * (1 - std::pow(2, -6));
  const double pi = 3.14159265358979;
  EXPECT_NEAR(ran.last("angle"), weight * arm * (b * b - a * a) / (2 * pi * tension * a * a * b * b), 3e-5);
  EXPECT_NEAR(ran.last("sag"), weight * std::log(b / a) / (2 * pi * tension) + arm * ran.last("angle"), 5e-7);
}

TEST_F(Bodies, of_revolution_may_reach_the_axis) {
  const auto sag = [&](const std::string& of, const std::string& rigid) {
    return run("model = \"axisymmetric\"\n[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\n"
               "shear_modulus = \"50 kPa\"\nrelative_permittivity = 4\n[disc]\nradius = \"20 "
               "mm\"\nelectrode_radius = \"5 mm\"\n"
               "[mesh]\nrings = 8\n[[step]]\nkind = \"weight\"\n[[quantity]]\nname = \"sag\"\nkind = "
               "\"displacement\"\nalong = \"z\"\nof = \"" +
               of + "\"\n" + rigid)
        .last("sag");
  };
  const double plate = sag("electrode", "[plate]\nmass = \"30 g\"\nat = \"electrode\"\n");
  EXPECT_LT(plate, -1e-3);
  EXPECT_NEAR(sag("hub", "[[body]]\nname = \"hub\"\nplaces = [\"electrode\"]\nmass = \"30 g\"\n"), plate,
              1e-9);
}

TEST_F(Bodies, gravity_pulls_where_it_is_told_to) {
  const std::string in_plane = "[gravity]\ndirection = [0, -2, 0]\n[[step]]\nkind = \"weight\"\n";
  for (const char* model : {"planar", "3d"}) {
    const Ran ran =
        run(annulus(model, "fix = [\"x\", \"y\", \"turn_z\"]\n",
                    in_plane + quantity("lift", "force", "y") + quantity("moment", "moment", "z")));
    EXPECT_NEAR(ran.last("lift"), weight, 1e-9) << model;
    EXPECT_NEAR(ran.last("moment"), 0, 1e-12) << model; // its place is its centre
  }
}

// A force that is there at once takes an undamped body twice as far as the same at rest.
TEST_F(Bodies, swing_and_tilt_in_time) {
  const std::string turning = "inertia = [\"40 g.mm^2\", \"40 g.mm^2\", \"80 g.mm^2\"]\n"
                              "fix = [\"x\", \"y\", \"turn_y\", \"turn_z\"]\n";
  const std::string sag =
      quantity("sag", "displacement", "gravity") + quantity("moment", "moment", "y") +
      "[[quantity]]\nname = \"deepest\"\nkind = \"peak\"\nof = \"sag\"\nextreme = \"maximum\"\n";
  const Ran at_rest = run(annulus("3d", turning, "[[step]]\nkind = \"weight\"\n" + sag));
  const Ran swings =
      run(annulus("3d", turning,
                  "[[load]]\nplace = \"hub\"\nforce = [\"0 N\", \"0 N\", { wave = \"step\", to = "
                  "\"-19.62 mN\" }]\n[[step]]\nkind = \"transient\"\nduration = \"30 "
                  "ms\"\nincrements = 200\n" +
                      sag));
  EXPECT_NEAR(swings.last("deepest"), 2 * at_rest.last("sag"), 2e-2 * at_rest.last("sag"));
  EXPECT_NEAR(swings.last("energy_error"), 0, 1e-2 * std::abs(swings.last("mechanical_work")));
}

TEST_F(Bodies, have_inertia_by_default_where_they_have_a_mass) {
  for (const auto& [mass, moves] : {std::pair{"", false},
                                    {"mass = \"0 g\"\n", false},
                                    {"mass = 0\n", false},
                                    {"mass = \"1 g\"\n", true},
                                    {"mass = 1e-3\n", true}}) {
    write("film.toml", "[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\n"
                       "shear_modulus = 4e4\npermittivity = 4e-11\n[annulus]\ninner_radius = 0.01\n"
                       "outer_radius = 0.03\n[[support]]\nplace = \"outer\"\nfix = [\"x\", \"y\"]\n"
                       "[[body]]\nname = \"hub\"\nplaces = [\"inner\"]\nfix = [\"turn_z\"]\n" +
                           std::string(mass) + "[[step]]\nkind = \"hold\"\nduration = \"1 s\"\n");
    EXPECT_EQ(read_case(directory / "film.toml").steps[0].inertia, moves) << mass;
  }
}

// The bar of a strip moves along y alone, unless the case has a body of that name.
TEST_F(Bodies, oblique_gravity_that_a_guided_weight_does_not_follow_is_told) {
  const auto warnings = [this](const std::string& direction, const std::string& more) {
    write("strip.toml", "model = \"3d\"\n[film]\nthickness = \"0.2 mm\"\n[film.material]\nshear_modulus = "
                        "\"80 kPa\"\npermittivity = \"4e-11 F/m\"\n[strip]\nlength = \"12 mm\"\nwidth = "
                        "\"10 mm\"\n[mesh]\nacross = 4\n[weight]\nmass = \"25 g\"\n[gravity]\ndirection = " +
                            direction + "\n[drive]\nvoltage = 0\n" + more);
    std::string all;
    for (const std::string& one : build_device(read_case(directory / "strip.toml")).warnings)
      all += one + "\n";
    return all;
  };
  const std::string guided = warnings("[0, -3, -4]", "");
  EXPECT_NE(guided.find("gravity.direction: has no effect along z on the body \"bar\""), std::string::npos)
      << guided;
  EXPECT_EQ(warnings("[0, -1, 0]", ""), "");
  EXPECT_EQ(warnings("[0, -3, -4]",
                     "[[body]]\nname = \"bar\"\nplaces = [\"lower_end\"]\nfix = [\"x\", \"turn_x\"]\n"),
            "");
}

// What holds the place of a load takes it, and nothing moves.
TEST_F(Bodies, loads_that_nothing_but_supports_take_are_told) {
  const auto warnings = [this](const std::string& body, const std::string& place, const std::string& what,
                               const std::string& support = "") {
    write("body.toml",
          annulus("3d", body,
                  fmt::format("[[load]]\nplace = \"{}\"\n{}\n{}[[step]]\nkind = \"weight\"\n[[step]]\n"
                              "kind = \"force\"\n[[step]]\nkind = \"force\"\nname = \"again\"\n",
                              place, what, support)));
    std::string all;
    for (const std::string& one : build_device(read_case(directory / "body.toml")).warnings)
      all += one + "\n";
    return all;
  };
  const std::string pivot = "pivot = [0, 0, 0]\nfix = [\"turn_x\"]\n",
                    push = "force = [0, \"5 mN\", \"1 mN\"]";
  const std::string at_pivot = warnings(pivot, "hub", push);
  EXPECT_NE(at_pivot.find("load[1].force: has no effect along y and z: \"hub\" is held there while it acts"),
            std::string::npos)
      << at_pivot;
  EXPECT_NE(at_pivot.find("moment about that point, moment = ["), std::string::npos) << at_pivot;
  const std::string turned = warnings(pivot, "hub", "moment = [\"1 mN m\", \"1 mN m\", 0]");
  EXPECT_NE(turned.find("load[1].moment: has no effect about x:"), std::string::npos) << turned;
  const std::string edge = warnings("", "outer", push);
  EXPECT_NE(edge.find("has no effect along y and z: \"outer\" is held"), std::string::npos) << edge;
  EXPECT_EQ(warnings("", "hub", push), "");
  const std::string held = "[[support]]\nplace = \"hub\"\nfix = [\"y\"]\n";
  EXPECT_NE(warnings("", "hub", push, held).find("effect along y:"), std::string::npos);
  EXPECT_NE(warnings("", "hub", push, held + "until = \"again\"\n").find("effect along y:"),
            std::string::npos);
  EXPECT_EQ(warnings("", "hub", push, held + "until = \"force\"\n"), ""); // it acts when it is let go
}

TEST_F(Bodies, may_be_held_by_a_support_but_not_what_they_carry) {
  const auto with = [this](const std::string& text) {
    write("body.toml", annulus("3d", "", "[[step]]\nkind = \"weight\"\n" + text));
    return build_device(read_case(directory / "body.toml"));
  };
  const Device device = with("[[support]]\nplace = \"hub\"\nfix = [\"z\", \"turn_x\"]\n");
  const int hub = device.mesh.node_sets.at("hub").front();
  for (const int c : {2, 3}) EXPECT_TRUE(device.model.dofs.is_held(device.model.dofs.equation(hub, c)));
  EXPECT_THROW(with("[[support]]\nplace = \"film\"\nfix = [\"z\"]\n"), CaseError);
  EXPECT_THROW(with("[plate]\nmass = \"1 g\"\n"), CaseError);
}

TEST_F(Bodies, have_names_of_their_own_and_carry_no_bodies) {
  const auto with = [this](const std::string& name, const std::string& place) {
    write("body.toml", annulus("3d", "", "[[step]]\nkind = \"weight\"\n") + "[[body]]\nname = \"" + name +
                           "\"\nplaces = [\"" + place + "\"]\n");
    return build_device(read_case(directory / "body.toml"));
  };
  EXPECT_THROW(with("film", "outer"), CaseError); // would have been the film's place from then on
  EXPECT_THROW(with("ring", "hub"), CaseError);
  EXPECT_THROW(with("ring", "ring"), CaseError);
}

TEST_F(Bodies, are_archived_and_restored) {
  write("body.toml", annulus("3d", "", "[[step]]\nkind = \"weight\"\n"));
  const Case one = read_case(directory / "body.toml");
  Simulation simulation(one, 1);
  int archived = 0;
  SimulationObserver observer;
  observer.on_accept = [&](const Frame&) {
    const fem::RampProgress progress = simulation.progress().in_step.ramp;
    const auto sizes = post::StateSizes::of(simulation.device().model);
    const fem::RampProgress restored = post::restore_ramp(post::archive(progress), sizes);
    EXPECT_EQ(restored.points.back().state.displacement, progress.points.back().state.displacement);
    ++archived;
    return true;
  };
  simulation.run(observer);
  EXPECT_GT(archived, 4);
}

TEST_F(Bodies, walls_can_be_clamped_and_film_cannot) {
  const auto clamped = [this](const std::string& place) {
    write("clamped.toml", test::small_honeycomb + "[[support]]\nplace = \"" + place +
                              "\"\nfix = [\"x\", \"y\", \"turn_z\"]\n");
    return build_device(read_case(directory / "clamped.toml"));
  };
  const Device device = clamped("corner_top");
  const int corner = device.mesh.node_sets.at("corner_top").front();
  for (const int c : {0, 1, 5}) EXPECT_TRUE(device.model.dofs.is_held(device.model.dofs.equation(corner, c)));
  write("film.toml",
        "model = \"planar\"\n[film]\nmaterial = \"VHB 4910 (diaphragm)\"\nthickness = \"1 "
        "mm\"\nprestretch = 2\n[annulus]\ninner_radius = \"10 mm\"\nouter_radius = \"20 "
        "mm\"\n[drive]\nvoltage = \"1 kV\"\n[[support]]\nplace = \"outer\"\nfix = [\"x\", \"y\", "
        "\"turn_z\"]\n");
  EXPECT_THROW(build_device(read_case(directory / "film.toml")), CaseError);
}

std::string moment(const std::string& place, double x, double y, double z) {
  return fmt::format("[[load]]\nplace = \"{}\"\nmoment = [\"{:.17g} N.m\", \"{:.17g} N.m\", \"{:.17g} "
                     "N.m\"]\n[[step]]\nkind = "
                     "\"force\"\nincrements = 4\n",
                     place, x, y, z);
}

// Its work is half of moment times angle, as the film answers linearly.
TEST_F(Bodies, a_moment_tilts_as_a_weight_beside_the_middle) {
  const double a = 10e-3, b = 40e-3, tension = 40e3 * 1e-3 * (1 - std::pow(2, -6)), m = weight * arm;
  const double pi = 3.14159265358979;
  const Ran ran = run(annulus("3d", "", moment("hub", 0, m, 0)));
  EXPECT_NEAR(ran.last("angle"), m * (b * b - a * a) / (2 * pi * tension * a * a * b * b), 3e-5);
  EXPECT_NEAR(ran.last("mechanical_work"), m * ran.last("angle") / 2, 1e-2 * m * ran.last("angle"));
  EXPECT_LT(std::abs(ran.last("energy_error")), 1e-6 * ran.last("mechanical_work"));
  const Ran fixed =
      run(annulus("3d", "fix = [\"turn_y\"]\n", moment("hub", 0, m, 0) + quantity("carried", "moment", "y")));
  EXPECT_NEAR(fixed.last("carried"), -m, 1e-12);
  EXPECT_EQ(fixed.last("angle"), 0);
}

TEST_F(Bodies, moments_about_several_axes_do_work_that_the_balance_knows) {
  const double m = 70 * weight * arm;
  const Ran ran = run(annulus("3d", "", moment("hub", m, 0.7 * m, 0.5 * m)));
  EXPECT_GT(ran.last("angle"), 0.1);
  EXPECT_LT(std::abs(ran.last("energy_error")), 1e-2 * ran.last("mechanical_work"));
}

TEST_F(Bodies, film_has_nothing_that_a_moment_could_turn) {
  for (const auto& [model, place] : {std::pair{"3d", "outer"}, {"planar", "hub"}}) {
    write("film.toml", annulus(model, "", moment(place, 0, 1e-6, 0)));
    std::string message;
    try {
      build_device(read_case(directory / "film.toml"));
    } catch (const CaseError& error) {
      message = error.what();
    }
    const std::string told = fmt::format(
        ": error: load[1].moment: nothing turns about y at \"{}\": membranes have no rotations, walls and "
        "bodies have, in a planar model about z",
        place);
    EXPECT_TRUE(message.ends_with(told)) << message;
    EXPECT_TRUE(message.starts_with((directory / "film.toml").string() + ":")) << message;
  }
}

/// A rectangle of film 40 mm x 20 mm of 3-node triangles, as gmsh writes it, with its left and right side.
std::string rectangle() {
  constexpr int across = 8, up = 4;
  std::string nodes, elements;
  int count = 0;
  const auto node = [](int i, int j) { return 1 + i * (up + 1) + j; };
  for (int i = 0; i <= across; ++i)
    for (int j = 0; j <= up; ++j) nodes += fmt::format("{} {} {} 0\n", node(i, j), 5 * i, 5 * j);
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < up; ++j) {
      elements +=
          fmt::format("{} 2 2 3 1 {} {} {}\n", ++count, node(i, j), node(i + 1, j), node(i + 1, j + 1));
      elements +=
          fmt::format("{} 2 2 3 1 {} {} {}\n", ++count, node(i, j), node(i + 1, j + 1), node(i, j + 1));
    }
  for (int j = 0; j < up; ++j)
    for (const auto& [group, i] : {std::pair{1, 0}, {2, across}})
      elements += fmt::format("{} 1 2 {} {} {} {}\n", ++count, group, group, node(i, j), node(i, j + 1));
  return fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"left\"\n1 2 \"right\"\n2 3 "
      "\"film\"\n$EndPhysicalNames\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
      (across + 1) * (up + 1), nodes, count, elements);
}

// An edge that stays straight but is free to move and to turn; the other one carries what acts on it.
TEST_F(Bodies, an_edge_moves_rigidly_and_freely) {
  write("film.msh", rectangle());
  const double force = 0.4, m = 1e-3, width = 20e-3;
  const auto of = [](const std::string& name, const std::string& kind, const std::string& body,
                     const std::string& along) {
    return fmt::format("[[quantity]]\nname = \"{}\"\nkind = \"{}\"\nof = \"{}\"\nalong = \"{}\"\n", name,
                       kind, body, along);
  };
  const Ran ran = run(
      "model = \"planar\"\n[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nlaw = "
      "\"neo-hookean\"\n"
      "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[mesh]\nfile = \"film.msh\"\nunit = \"1 "
      "mm\"\n"
      "[[body]]\nname = \"frame\"\nplaces = [\"left\"]\nfix = [\"x\", \"y\", \"turn_z\"]\n[[body]]\nname = "
      "\"bar\"\nplaces = [\"right\"]\n[output]\nerror_estimate = false\nfields = false\n" +
      fmt::format("[[load]]\nplace = \"bar\"\nforce = [\"{} N\", \"0 N\", \"0 N\"]\n", force) +
      moment("bar", 0, 0, m) + of("angle", "angle", "bar", "z") + of("height", "size", "right", "y") +
      of("depth", "size", "right", "x") + of("pull", "force", "frame", "x") +
      of("lift", "force", "frame", "y") + of("carried", "moment", "frame", "z") +
      of("rise", "displacement", "bar", "y") + of("reach", "displacement", "bar", "x"));
  EXPECT_GT(ran.last("angle"), 0.05);
  EXPECT_NEAR(ran.last("height"), width * std::cos(ran.last("angle")), 1e-12);
  EXPECT_NEAR(ran.last("depth"), width * std::sin(ran.last("angle")), 1e-12);
  EXPECT_GT(std::abs(ran.last("reach")), 1e-3);
  EXPECT_NEAR(ran.last("pull"), -force, 1e-8);
  EXPECT_NEAR(ran.last("lift"), 0, 1e-8);
  EXPECT_NEAR(ran.last("carried"), -m + force * ran.last("rise"), 1e-9);
}

/// A hub of 2 g on a soft film in the plane with a fin in water on it.
std::string wet_hub(const std::string& rest) {
  std::string text = annulus("planar", "inertia = \"1 kg.mm^2\"\n", R"([[fin]]
name = "sail"
body = "hub"
along = "y"
height = "20 mm"
from = ["-15 mm", "0 mm", "0 mm"]
to = ["15 mm", "0 mm", "0 mm"]
[solver]
time_tolerance = "1e-6"
)" + rest);
  for (const char* line : {"centre = [\"3 mm\", \"0 mm\", \"0 mm\"]\n", "rings = 5\n"})
    text.replace(text.find(line), std::string(line).size(), line[0] == 'r' ? "rings = 3\n" : "");
  return text;
}

constexpr double added_mass = 1000 * 3.14159265358979 / 4 * 4e-4 * 0.03; ///< of its fin, kg

TEST_F(Bodies, a_fin_gives_the_fluid_what_drag_takes_and_the_added_mass_keeps) {
  const Ran ran = run(wet_hub(R"([[load]]
place = "hub"
force = ["0 N", { wave = "sine", amplitude = "0.3 N", frequency = "2 Hz" }, "0 N"]
[[step]]
kind = "transient"
duration = "1 s"
[[quantity]]
name = "power"
kind = "fin power"
of = "sail"
[[quantity]]
name = "mean_power"
kind = "mean"
of = "power"
[[quantity]]
name = "thrust"
kind = "thrust"
of = "sail"
[[quantity]]
name = "kinetic"
kind = "energy"
of = "kinetic"
)"));
  const double kept = ran.last("kinetic") * added_mass / (added_mass + 2e-3);
  EXPECT_GT(ran.last("dissipated_energy"), kept);
  EXPECT_NEAR(ran.last("mean_power") * 1.0, ran.last("dissipated_energy") + kept,
              1e-3 * ran.last("dissipated_energy"));
  EXPECT_NEAR(ran.last("thrust"), 0, 1e-9); // it does not turn
}

TEST_F(Bodies, added_mass_lowers_the_natural_frequency_and_has_no_weight) {
  const std::string weighed = "[gravity]\ndirection = [0, -1, 0]\nfilm = true\n[[step]]\nkind = \"weight\"\n"
                              "[[quantity]]\nname = \"f\"\nkind = \"natural frequency\"\nmode = 2\n" +
                              quantity("sag", "displacement", "y");
  const std::string with = wet_hub(weighed);
  std::string without = with;
  const auto fin = without.find("[[fin]]");
  without.erase(fin, without.find("[solver]") - fin);
  const Ran wet = run(with), dry = run(without);
  EXPECT_NEAR(wet.last("sag"), dry.last("sag"), 1e-12);
  EXPECT_LT(wet.last("f"), dry.last("f"));
}

TEST_F(Bodies, a_fin_that_turns_far_is_told) {
  const std::string load = "[[load]]\nplace = \"hub\"\nmoment = [\"0 N m\", \"0 N m\", \"0.02 N "
                           "m\"]\n[[step]]\nkind = \"force\"\n";
  EXPECT_EQ(run(wet_hub(load)).events.count("fin turns"), 1);
  std::string more = load;
  more.replace(more.find("0.02"), 4, "0.06");
  EXPECT_EQ(run(wet_hub(more)).events.count("fin turns"), 3); // beyond 0.2, 0.4 and 0.8 rad
}

} // namespace
} // namespace dielast::cases::bodies_test
