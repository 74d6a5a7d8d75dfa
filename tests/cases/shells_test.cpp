// SPDX-License-Identifier: GPL-3.0-or-later
// Shells as a user writes them: film.section = "shell".
#include "cases/devices/device.hpp"
#include "cases/runs/phases.hpp"
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::cases::shells_test {
namespace {

constexpr double radius = 0.1, thickness = 1e-3, modulus = 1e5, density = 1000,
                 permittivity = 5 * 8.8541878128e-12;

std::string clamped_disc(const std::string& rest) {
  return fmt::format(R"(
model = "3d"
[film]
thickness = "{} m"
section = "shell"
[film.material]
shear_modulus = "{} Pa"
relative_permittivity = 5
density = "{} kg/m^3"
[disc]
radius = "{} m"
[mesh]
rings = 8
[output]
error_estimate = false
)",
                     thickness, modulus, density, radius) +
         rest;
}

/// eps (Phi/H)^2 H = 14.68 D/a^2, D = mu H^3/3 (Timoshenko & Gere 1961, sec. 9.3: the clamped plate).
double buckling_voltage() {
  return thickness *
         std::sqrt(14.68 * modulus * thickness * thickness / 3 / (radius * radius) / permittivity);
}

TEST_F(Paths, a_clamped_disc_buckles_at_its_voltage) {
  for (const int increments : {3, 7}) {
    const Run stopped =
        run(clamped_disc(fmt::format("[drive]\nvoltage = \"{} V\"\n[[step]]\nkind = \"voltage\"\nincrements "
                                     "= {}\non_instability = \"stop\"\n",
                                     1.5 * buckling_voltage(), increments)),
            "capacitance");
    EXPECT_EQ(stopped.outcome.ending, Ending::gave_up) << stopped.outcome.message;
    EXPECT_NE(stopped.outcome.message.find("bifurcation"), std::string::npos) << stopped.outcome.message;
    ASSERT_FALSE(stopped.rows.empty());
    EXPECT_NEAR(stopped.rows.back().voltage, buckling_voltage(), 0.0025 * buckling_voltage());
  }
}

// The load of the dome rises so steeply that its path is soon next to normal to the mode.
TEST_F(Paths, a_clamped_disc_goes_over_to_its_dome_by_the_branch_and_by_a_jump_alike) {
  const auto ends = [this](const std::string& way) {
    const Run one =
        run(clamped_disc(fmt::format("[drive]\nvoltage = \"{} V\"\n[[quantity]]\nname = \"depth\"\nkind = "
                                     "\"size\"\nof = \"film\"\nalong = \"z\"\n[[step]]\nkind = "
                                     "\"voltage\"\nincrements = 4\n{}\n",
                                     1.3 * buckling_voltage(), way)),
            "depth");
    EXPECT_EQ(one.outcome.ending, Ending::complete) << one.outcome.message;
    // the critical point is told where it is, not where the first state beyond it is
    const auto told = std::ranges::find(one.events, "bifurcation", &post::Event::kind);
    if (told == one.events.end() || !told->before) {
      ADD_FAILURE() << "no bifurcation, or not where it is: " << way;
    } else {
      EXPECT_NEAR(told->before->voltages.at(0), buckling_voltage(), 0.0025 * buckling_voltage());
      EXPECT_NEAR(told->before->load_factor, told->before->voltages[0] / (1.3 * buckling_voltage()), 1e-6);
    }
    return one.rows.back().value;
  };
  const double dome = ends("on_bifurcation = \"switch\"");
  EXPECT_GT(dome, thickness);
  EXPECT_NEAR(dome, ends("on_instability = \"jump\""), 1e-6 * dome);
}

// A run that goes on from where it was kept ends like one that was never stopped, bit for bit: beside a
// switch of branches, at the end of a path that was followed, beside a jump.
TEST_F(Paths, a_run_goes_on_beside_a_switch_of_branches_and_a_jump) {
  for (const char* way : {"on_bifurcation = \"switch\"", "on_instability = \"jump\""}) {
    std::string text = clamped_disc(
        fmt::format("[drive]\nvoltage = \"{} V\"\n[[step]]\nkind = \"voltage\"\nincrements = 4\n{}\n"
                    "[[step]]\nkind = \"voltage\"\nname = \"less\"\nto = \"{} V\"\nincrements = 3\n",
                    1.3 * buckling_voltage(), way, 1.2 * buckling_voltage()));
    text.replace(text.find("rings = 8"), 9, "rings = 4");
    write("dome.toml", text);
    const Case one = read_case(directory / "dome.toml");
    Simulation straight(one, 1);
    std::vector<std::vector<double>> rows;
    std::map<std::size_t, SimulationProgress> kept; // behind so many rows
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      rows.push_back(frame.values);
      if (!frame.ends_path) kept.emplace(rows.size(), straight.progress());
      return true;
    };
    ASSERT_EQ(straight.run(observer).ending, Ending::complete);
    EXPECT_EQ(rows.size() - kept.size(), way[3] == 'i' ? 1u : 0u) << way;
    for (const auto& [before, progress] : kept) {
      if (before < 5 || before % 3 == 1) continue; // a part of them takes less time
      Simulation resumed(one, 1);
      resumed.enter(progress.step);
      resumed.resume(progress);
      std::vector<std::vector<double>> rest(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(before));
      observer.on_accept = [&](const Frame& frame) {
        rest.push_back(frame.values);
        return true;
      };
      EXPECT_EQ(resumed.run(observer).ending, Ending::complete);
      EXPECT_EQ(rest, rows) << way << ", behind " << before;
    }
  }
}

// Leissa 1969, Vibration of Plates, table 2.1: lambda^2 = 10.2158.
TEST_F(Paths, a_clamped_disc_vibrates_as_a_plate) {
  const Run modes =
      run(clamped_disc("[drive]\nvoltage = \"1 V\"\n[[step]]\nkind = \"voltage\"\n[[quantity]]\n"
                       "name = \"frequency\"\nkind = \"natural frequency\"\n[[quantity]]\n"
                       "name = \"stiffness\"\nkind = \"modal stiffness\"\n"),
          "frequency");
  EXPECT_EQ(modes.outcome.ending, Ending::complete) << modes.outcome.message;
  const double expected =
      10.2158 / (radius * radius) * std::sqrt(modulus * thickness * thickness / 3 / density);
  EXPECT_NEAR(modes.rows.back().value, expected, 0.003 * expected);
}

// Thick for its size, and taut: bending adds 0.1 % to the membrane's first mode. Nothing vibrates in its
// plane below it, least of all what turns about the directors.
TEST_F(Paths, a_stretched_shell_vibrates_as_a_membrane) {
  const Run modes = run("model = \"3d\"\n[film]\nthickness = \"1 mm\"\nsection = \"shell\"\nprestretch = 3\n"
                        "[film.material]\nshear_modulus = \"40 kPa\"\nrelative_permittivity = 4\n"
                        "density = \"1000 kg/m^3\"\n[disc]\nradius = \"40 mm\"\n[mesh]\nrings = 6\n"
                        "[drive]\nvoltage = \"1 V\"\n[[step]]\nkind = \"voltage\"\n[[quantity]]\n"
                        "name = \"frequency\"\nkind = \"natural frequency\"\n",
                        "frequency");
  EXPECT_EQ(modes.outcome.ending, Ending::complete) << modes.outcome.message;
  const double expected = 2.404826 / 0.04 * std::sqrt(40e3 * (9 - std::pow(3, -4)) / 1000);
  EXPECT_NEAR(modes.rows.back().value, expected, 0.003 * expected);
}

/// The disc at 1.1 times its buckling voltage: what its step is told, and the quantities that are read.
std::string beyond_buckling(const std::string& told) {
  return clamped_disc(
      fmt::format("[drive]\nvoltage = \"{} V\"\n[[step]]\nkind = \"voltage\"\nincrements = 4\n{}\n"
                  "[[quantity]]\nname = \"stiffness\"\nkind = \"modal stiffness\"\n"
                  "[[quantity]]\nname = \"rise\"\nkind = \"size\"\nof = \"film\"\nalong = \"z\"\n",
                  1.1 * buckling_voltage(), told));
}

// Held flat by symmetry alone the disc is followed beyond its buckling voltage: the square of its lowest
// frequency goes with 1 - (Phi/Phi_c)^2.
TEST_F(Paths, the_modal_stiffness_of_a_disc_passes_zero_where_it_buckles) {
  const Run flat = run(beyond_buckling("on_instability = \"follow\""), "stiffness");
  EXPECT_EQ(flat.outcome.ending, Ending::complete) << flat.outcome.message;
  ASSERT_GT(flat.rows.size(), 4u);
  const double drawn = flat.rows[0].value;
  EXPECT_NEAR(drawn, std::pow(10.2158 / (radius * radius), 2) * modulus * thickness * thickness / 3 / density,
              0.006 * drawn);
  for (const Row& row : flat.rows)
    EXPECT_NEAR(row.value, drawn * (1 - std::pow(row.voltage / buckling_voltage(), 2)), 0.01 * drawn)
        << row.voltage;
  EXPECT_LT(flat.rows.back().value, -0.1 * drawn);
}

// Beyond it the linear equations have a response still, in which nothing says that the disc would leave its
// plane.
TEST_F(Paths, an_unstable_disc_answers_no_small_sine) {
  const auto ends = [&](double voltage) {
    const Case one =
        read(beyond_buckling("on_instability = \"follow\"\n[[step]]\nkind = \"harmonic\"\nfrom = "
                             "\"1 Hz\"\nto = \"2 Hz\"\npoints = 2"),
             {fmt::format("drive.voltage={} V", voltage)});
    Simulation simulation(one, 1);
    SimulationObserver observer;
    observer.on_analysis = [](const Analysis&, const fem::State&) {};
    return simulation.run(observer);
  };
  const Outcome stable = ends(0.9 * buckling_voltage()), unstable = ends(1.1 * buckling_voltage());
  EXPECT_EQ(stable.ending, Ending::complete) << stable.message;
  EXPECT_EQ(unstable.ending, Ending::gave_up);
  EXPECT_NE(
      unstable.message.find("small motions go about a stable state, and this one has 1 unstable mode at"),
      std::string::npos)
      << unstable.message;
}

// The branch on which it buckles leaves the flat one tangentially: next to the critical voltage the two are
// one but for round-off, and the disc has to be charged on until there is somewhere to jump to.
TEST_F(Paths, a_disc_jumps_from_where_it_buckles_onto_its_dome) {
  const Run domed = run(beyond_buckling("on_instability = \"jump\""), "rise");
  EXPECT_EQ(domed.outcome.ending, Ending::complete) << domed.outcome.message;
  EXPECT_GT(domed.rows.back().value, 0.1 * thickness);
  EXPECT_EQ(domed.rows.back().unstable_modes, 0);
}

/// A support of the centre, besides that of the rim.
std::string held_centre(const std::string& fix) {
  return "[[support]]\nplace = \"rim\"\nfix = [\"x\", \"y\", \"z\", \"turn_x\", \"turn_y\", \"turn_z\"]\n"
         "[[support]]\nplace = \"centre\"\nfix = [" +
         fix + "]\n";
}

// A disc's nodes have five unknowns, but for those at which something asks for single rotations.
TEST_F(Paths, shells_tilt_where_nothing_acts_on_single_rotations) {
  const auto of_centre = [this](const std::string& rest, int step = 0) {
    const Case one = read(clamped_disc(rest));
    const Device device = build_device(held_by(one, holding_in(one, one.steps, step)));
    const fem::DofMap& dofs = device.model.dofs;
    const int centre = device.mesh.node_sets.at("centre").front();
    for (int n = 0; n < dofs.node_count(); ++n) EXPECT_TRUE(dofs.tilts(n) || n == centre) << n;
    for (const int n : device.mesh.node_sets.at("rim")) EXPECT_TRUE(dofs.is_held(dofs.equation(n, 6)));
    return dofs.tilts(centre);
  };
  const std::string voltage = "[drive]\nvoltage = \"1 V\"\n[[step]]\nkind = \"voltage\"\nname = \"one\"\n",
                    again = voltage + "[[step]]\nkind = \"voltage\"\nname = \"two\"\n";
  EXPECT_TRUE(of_centre(voltage));
  EXPECT_TRUE(of_centre(voltage + held_centre("\"z\"")));
  EXPECT_TRUE(of_centre(voltage + held_centre("\"turn_x\", \"turn_y\", \"turn_z\"")));
  EXPECT_FALSE(of_centre(voltage + held_centre("\"turn_x\"")));
  for (const int step : {0, 1}) // in all steps alike
    EXPECT_FALSE(of_centre(again + held_centre("\"turn_x\"") + "until = \"one\"\n", step));
  EXPECT_FALSE(of_centre(voltage + "[[step]]\nkind = \"force\"\n[[load]]\nplace = \"centre\"\nmoment = [0, "
                                   "\"1 uN m\", 0]\n"));
}

// Its centre, which a force lifts, is not to turn at first: about one axis, or about all, which changes how
// many unknowns are free.
TEST_F(Paths, a_shell_is_let_go_of_as_if_it_had_never_been_held) {
  const auto rise = [this](const std::string& fix) {
    const std::string held = fix.empty() ? "" : held_centre(fix) + "until = \"push\"\n";
    const Run one =
        run(clamped_disc("[drive]\nvoltage = \"10 V\"\n[[step]]\nkind = \"force\"\nname = \"push\"\n"
                         "[[step]]\nkind = \"voltage\"\n[[load]]\nplace = \"centre\"\n"
                         "force = [0, 0, \"1 mN\"]\n[[quantity]]\nname = \"rise\"\nkind = \"size\"\n"
                         "of = \"film\"\nalong = \"z\"\n" +
                         held),
            "rise");
    EXPECT_EQ(one.outcome.ending, Ending::complete) << one.outcome.message;
    return one.rows.back().value;
  };
  const double free = rise("");
  EXPECT_GT(free, 1e-5);
  for (const char* fix : {"\"turn_x\"", "\"turn_x\", \"turn_y\", \"turn_z\""})
    EXPECT_NEAR(rise(fix), free, 1e-6 * free) << fix;
}

// A plate that is ten thicknesses long: in all that it does, transverse shear as well, the material is one
// spring beside a Maxwell element of the same modulus, whose compliance is (1 - exp(-t/2 tau)/2) of the
// relaxed one.
TEST_F(Paths, branches_act_in_the_transverse_shear_of_shells) {
  const auto tip = [this](const std::string& branch, const std::string& steps) {
    const Run one = run(R"(model = "3d"
[film]
thickness = "1 mm"
section = "shell"
[film.material]
shear_modulus = "1 MPa"
relative_permittivity = 5
)" + branch + R"(
[rectangle]
length = "10 mm"
width = "5 mm"
[mesh]
across = 2
[[support]]
place = "left"
fix = ["x", "y", "z", "turn_x", "turn_y", "turn_z"]
[[load]]
place = "right"
force = [0, 0, "1 uN"]
[[quantity]]
name = "tip"
kind = "displacement"
of = "right"
along = "z"
[output]
error_estimate = false
[[step]]
kind = "force"
response = "instantaneous"
)" + steps,
                        "tip");
    EXPECT_EQ(one.outcome.ending, Ending::complete) << one.outcome.message; // the energies balance
    return one.rows.back().value;
  };
  const std::string branch =
                        "[[film.material.branch]]\nshear_modulus = \"1 MPa\"\nrelaxation_time = \"1 s\"\n",
                    hold = "[[step]]\nkind = \"hold\"\nduration = \"2 s\"\nincrements = 20\n",
                    relax = "[[step]]\nkind = \"relax\"\n";
  const double relaxed = tip("", "");
  EXPECT_NEAR(tip(branch, ""), relaxed / 2, 1e-7 * relaxed);
  EXPECT_NEAR(tip(branch, hold), (1 - std::exp(-1.0) / 2) * relaxed, 2e-4 * relaxed);
  EXPECT_NEAR(tip(branch, hold + relax), relaxed, 1e-7 * relaxed);
}

// The strains of shells next to a curved rim are not quite in balance as drawn.
TEST_F(Paths, a_prestretched_shell_that_is_clamped_all_round_is_held) {
  std::string sides; // one of two millimetres is free
  for (const char* side : {"left", "bottom", "top"})
    sides += fmt::format("[[support]]\nplace = \"{}\"\nfix = [\"x\", \"y\", \"z\"]\n", side);
  const auto blames_its_supports = [this](const std::string& geometry) {
    const Case one =
        read(fmt::format("model = \"3d\"\n[film]\nthickness = \"1 mm\"\nsection = \"shell\"\nprestretch = 2\n"
                         "[film.material]\nshear_modulus = \"1 MPa\"\nrelative_permittivity = 4\n{}"
                         "[drive]\nvoltage = \"1 V\"\n[[step]]\nkind = \"voltage\"\n",
                         geometry));
    return std::ranges::any_of(Simulation(one, 1).warnings(), [](const std::string& warning) {
      return warning.find("is not held in its prestretch") != std::string::npos;
    });
  };
  for (const int rings : {3, 6, 12})
    EXPECT_FALSE(blames_its_supports(fmt::format("[disc]\nradius = \"50 mm\"\n[mesh]\nrings = {}\n", rings)))
        << rings;
  EXPECT_TRUE(blames_its_supports("[rectangle]\nlength = \"50 mm\"\nwidth = \"2 mm\"\n" + sides));
}

// A point of a plate carries no moment about its normal.
TEST_F(Paths, a_bar_tied_to_a_shell_at_one_node_is_warned_of) {
  const auto warns = [this](const std::string& places) {
    const Device device = build_device(read(R"(model = "3d"
[part.a]
[part.a.film]
thickness = "1 mm"
section = "shell"
[part.a.film.material]
shear_modulus = "1 MPa"
relative_permittivity = 4
[part.a.rectangle]
length = "50 mm"
width = "10 mm"
[part.l.line]
from = ["25 mm", "0 mm", "0 mm"]
to = ["75 mm", "0 mm", "0 mm"]
[part.l.beam]
width = "10 mm"
height = "1 mm"
[part.l.beam.material]
youngs_modulus = "3 MPa"
poisson_ratio = 0.49
[[support]]
place = "a.left"
fix = ["x", "y", "z", "turn_x", "turn_y", "turn_z"]
[[load]]
place = "l.end"
force = [0, "10 uN", 0]
[[step]]
kind = "force"
)" + places));
    return std::ranges::any_of(device.warnings, [](const std::string& warning) {
      return warning.find("as on a hinge") != std::string::npos;
    });
  };
  EXPECT_TRUE(warns("[[tie]]\nbetween = [\"a.right\", \"l.start\"]\n"));
  EXPECT_FALSE(warns("[[body]]\nname = \"grip\"\nplaces = [\"a.right\", \"l.start\"]\n"));
}

/// With b/a = beta w = P a^2 / (16 pi D) [1 - beta^2 - 4 beta^2 ln^2(beta) / (1 - beta^2)], D = mu H^3 / 3: a
/// ring that turns at neither edge (Timoshenko & Woinowsky-Krieger 1959, sec. 17).
TEST_F(Paths, a_ring_that_resists_bending_carries_a_plate) {
  const double inner = 0.4 * radius, beta = 0.4, mass = 1e-3, logarithm = std::log(beta);
  const Run one = run(fmt::format("model = \"3d\"\n[film]\nthickness = \"{} m\"\nsection = \"shell\"\n"
                                  "[film.material]\nshear_modulus = \"{} Pa\"\nrelative_permittivity = 5\n"
                                  "[annulus]\ninner_radius = \"{} m\"\nouter_radius = \"{} m\"\n"
                                  "[mesh]\nrings = 6\n[plate]\nmass = \"{} kg\"\n[[step]]\nkind = "
                                  "\"weight\"\n[gravity]\nacceleration = \"1e-4 m/s^2\"\n",
                                  thickness, modulus, inner, radius, mass),
                      "drop");
  ASSERT_EQ(one.outcome.ending, Ending::complete) << one.outcome.message;
  const double stiffness = modulus * std::pow(thickness, 3) / 3, load = mass * 1e-4, square = beta * beta;
  const double drop = load * radius * radius / (16 * std::numbers::pi * stiffness) *
                      (1 - square - 4 * square * logarithm * logarithm / (1 - square));
  EXPECT_NEAR(one.rows.back().value, drop, 0.005 * drop);
}

} // namespace
} // namespace dielast::cases::shells_test
