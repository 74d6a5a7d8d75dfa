// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of a honeycomb that touch: [contact].
#include "cases/devices/device.hpp"
#include "fem/contact/wall_contact.hpp"
#include "meshing/mesh_error.hpp"
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dielast::cases::contact_test {
namespace {

std::string honeycomb(double angle, const std::string& rest) {
  return fmt::format(
             "[film]\nmaterial = \"VHB 4910 (honeycomb)\"\nthickness = \"1 mm\"\nprestretch = [4.0, 2.5]\n"
             "[honeycomb]\nangle = \"{} deg\"\ncolumns = [2, 1]\nwall_length = \"8 mm\"\nwall_width = \"0.8 "
             "mm\"\nwall_height = \"2 mm\"\nwall_material = \"TPU 78 MPa\"\n[mesh]\nwall_elements = 4\n"
             "[drive]\nvoltage = \"7.5 kV\"\n[output]\nerror_estimate = false\n",
             angle) +
         rest;
}

const std::string contact = "[contact]\nthickness = \"0.1 mm\"\n";

const std::string release = "[[step]]\nkind = \"release\"\n";

class Contacts : public Paths {};

/// Without the barrier the walls cross; with it their faces stay apart in every accepted state.
TEST_F(Contacts, keep_the_walls_of_a_collapsing_honeycomb_apart) {
  const auto least_distance = [&](const std::string& text) {
    const Case one = read(text);
    Simulation simulation(one, 1);
    const Device& device = simulation.device();
    const fem::WallContactSearch touching(device.mesh, *device.mesh.walls(), device.bars.widths);
    bool apart = true;
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      apart = apart && touching.find(frame.measured.state).empty();
      return true;
    };
    const Outcome outcome = simulation.run(observer);
    EXPECT_EQ(outcome.ending, Ending::complete) << outcome.message;
    return apart;
  };
  EXPECT_FALSE(least_distance(honeycomb(70, release)));
  EXPECT_TRUE(least_distance(honeycomb(70, contact + release)));
}

/// Where walls do not touch the barrier changes nothing.
TEST_F(Contacts, change_nothing_where_walls_do_not_touch) {
  const auto without = values(honeycomb(90, ""));
  const auto with = values(honeycomb(90, contact));
  for (const char* name : {"eps_x", "eps_y", "released_length_x", "stored_energy"})
    EXPECT_NEAR(with.at(name), without.at(name), 1e-9 * std::abs(without.at(name))) << name;
}

/// A slab of film's material on a table; 1000 kg/m^3.
std::string slab(const std::string& rest, const std::string& friction = "0") {
  return "[film]\nthickness = \"1 mm\"\nwidth = \"10 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\n"
         "permittivity = \"4e-11 F/m\"\ndensity = \"1000 kg/m^3\"\n"
         "[slab]\nlength = \"10 mm\"\nheight = \"1 mm\"\n[mesh]\nacross = 2\n"
         "[gravity]\ndirection = [0, -1, 0]\nfilm = true\nacceleration = \"10 m/s^2\"\n"
         "[contact]\nthickness = \"1 um\"\n[table]\nat = \"bottom\"\nfriction = " +
         friction +
         "\n[drive]\nvoltage = \"10 kV\"\n[output]\nerror_estimate = false\n"
         "[[quantity]]\nname = \"weight\"\nkind = \"contact force\"\n"
         "[[quantity]]\nname = \"length\"\nkind = \"growth\"\nof = \"film\"\nalong = \"x\"\nsince = "
         "\"weight\"\n"
         "[[quantity]]\nname = \"heat\"\nkind = \"energy\"\nof = \"dissipated\"\n" +
         rest;
}

const std::string weight_and_voltage =
    "[[step]]\nkind = \"weight\"\n[[step]]\nkind = \"voltage\"\nincrements = 5\n";

/// Free to slide, the slab stretches as in plane strain: mu (l^2 - 1/l^2) = eps (l E)^2, and the table bears
/// its weight, 1 mN.
TEST_F(Contacts, slab_on_a_table_without_friction_stretches_freely) {
  const auto end = values(slab("[[support]]\nplace = \"left\"\nfix = [\"x\"]\n" + weight_and_voltage));
  EXPECT_NEAR(end.at("weight"), 1e-3, 1e-7);
  const double l = 1 + end.at("length"), field = 10e3 / 1e-3;
  EXPECT_NEAR(40e3 * (l * l - 1 / (l * l)), 4e-11 * l * l * field * field, 0.01 * 4e-11 * field * field);
  EXPECT_EQ(end.at("heat"), 0);
}

/// More friction, less stretch; what slides makes heat. A slab that weighs a hundred times as much, so that
/// friction may hold it.
TEST_F(Contacts, friction_of_a_table_holds_a_slab) {
  const auto at_end = [&](const std::string& friction) {
    std::string text = slab(weight_and_voltage, friction);
    text.replace(text.find("10 m/s^2"), 8, "1000 m/s^2");
    return values(text);
  };
  const auto little = at_end("0.05"), much = at_end("0.5");
  EXPECT_NEAR(little.at("weight"), 0.1, 1e-4);
  EXPECT_NEAR(much.at("weight"), 0.1, 1e-4);
  EXPECT_GT(little.at("heat"), 0);
  EXPECT_LT(much.at("length"), 0.8 * little.at("length"));
}

/// Increments in which nodes slide by little are as good as others: the fewer slide far, and the many get as
/// far.
TEST_F(Contacts, friction_does_not_ask_how_many_increments_there_are) {
  for (const std::string friction : {"0.1", "0.3"}) {
    std::vector<double> lengths;
    for (const char* increments : {"20", "160"}) {
      std::string text = slab("[[step]]\nkind = \"weight\"\nincrements = 10\n[[step]]\nkind = \"voltage\"\n"
                              "increments = " +
                                  std::string(increments) + "\n",
                              friction);
      text.replace(text.find("10 m/s^2"), 8, "1000 m/s^2");
      lengths.push_back(values(text).at("length"));
    }
    EXPECT_GT(lengths[0], 1e-3);
    EXPECT_NEAR(lengths[1], lengths[0], 0.02 * lengths[0]) << friction;
  }
}

TEST_F(Contacts, refuse_walls_that_touch_as_drawn) {
  EXPECT_THROW(build_device(read(honeycomb(63, contact))), meshing::MeshError);
}

/// In space: its weight, and with friction less stretch.
TEST_F(Contacts, block_in_space_lies_on_a_table) {
  const auto block = [&](const std::string& friction, const std::string& supports) {
    std::string text = slab(supports + weight_and_voltage, friction);
    text.replace(text.find("height = \"1 mm\""), 15, "height = \"1 mm\"\nwidth = \"10 mm\"");
    text.replace(text.find("width = \"10 mm\""), 16, "");
    text.replace(text.find("across = 2"), 10, "across = 1");
    return "model = \"3d\"\n" + text;
  };
  const auto held = [](const char* place, const char* axis) {
    return fmt::format("[[support]]\nplace = \"{}\"\nfix = [\"{}\"]\n", place, axis);
  };
  EXPECT_THROW(read(block("0", held("left", "x"))), CaseError);
  const auto free = values(block("0", held("left", "x") + held("back", "z")));
  EXPECT_NEAR(free.at("weight"), 1e-3, 1e-7);
  // Free along x and z: mu (l^2 - 1/l^4) = eps (l^2 E)^2.
  const double l = 1 + free.at("length"), field = 10e3 / 1e-3;
  EXPECT_NEAR(40e3 * (l * l - std::pow(l, -4)), 4e-11 * std::pow(l, 4) * field * field,
              0.01 * 4e-11 * field * field);
  const auto rough = values(block("0.5", ""));
  EXPECT_NEAR(rough.at("weight"), 1e-3, 1e-6);
  EXPECT_GT(rough.at("heat"), 0);
}

/// A block that a cap presses on its table and drags: corners of its faces stand for next to no area, and
/// what they bear at the block's ends says little by itself. Plane strain has 9.11 kPa (across = 2) and 11.3
/// kPa (4).
TEST_F(Contacts, dragged_block_in_space_presses_at_its_ends_as_in_plane_strain) {
  const auto found = values(
      "model = \"3d\"\n[film]\nthickness = \"0.1 mm\"\n[film.material]\nshear_modulus = \"40 "
      "kPa\"\npermittivity = "
      "\"4e-11 F/m\"\n[slab]\nlength = \"2 mm\"\nheight = \"1 mm\"\nwidth = \"2 mm\"\n[mesh]\nacross = "
      "2\ngrading = 1\n"
      "[table]\nat = \"bottom\"\nfriction = 0.3\n[contact]\nthickness = \"10 um\"\n"
      "[[body]]\nname = \"cap\"\nplaces = [\"top\"]\nfix = [\"z\", \"turn_x\", \"turn_y\", \"turn_z\"]\n"
      "[[support]]\nplace = \"cap\"\ndisplacement = { x = \"0.2 mm\" }\n"
      "[[load]]\nplace = \"cap\"\nforce = [0, \"-20 mN\", 0]\n"
      "[[step]]\nkind = \"force\"\nincrements = 5\n[[step]]\nkind = \"move\"\nincrements = 4\n"
      "[[quantity]]\nname = \"largest\"\nkind = \"contact pressure\"\n[output]\nerror_estimate = false\n");
  EXPECT_NEAR(found.at("largest"), 10e3, 1e3);
}

/// Also where a body holds it.
TEST_F(Contacts, block_without_friction_is_kept_from_sliding_by_a_body) {
  const std::string slides = slab(weight_and_voltage);
  EXPECT_THROW(read(slides), CaseError);
  EXPECT_NO_THROW(read(slides + "[[body]]\nname = \"cap\"\nplaces = [\"top\"]\nfix = [\"x\", \"turn_z\"]\n"));
}

/// Of a table's places: a surface, which faces down. A barrier that reaches over the solid keeps nothing
/// apart.
TEST_F(Contacts, only_undersides_lie_on_a_table_and_the_barrier_is_thin) {
  for (const auto& [written, instead, blamed] :
       {std::array{"\"bottom\"", "\"top\"", "table.at"}, std::array{"\"bottom\"", "\"left\"", "table.at"},
        std::array{"\"bottom\"", "\"film\"", "table.at"},
        std::array{"\"1 um\"", "\"90 mm\"", "contact.thickness: found 90 mm, and what lies"}}) {
    std::string text = slab(weight_and_voltage, "0.5");
    text.replace(text.find(written), std::string(written).size(), instead);
    try {
      build_device(read(text));
      ADD_FAILURE() << instead;
    } catch (const CaseError& error) {
      EXPECT_NE(std::string(error.what()).find(blamed), std::string::npos) << error.what();
    }
  }
}

/// A block, and one half as long above it, whose back is moved down by 0.1 mm; the gap in mm. `up`: y, of
/// revolution z.
std::string two_blocks(double gap, char up = 'y',
                       const std::string& between = "\"lower.top\", \"upper.bottom\"") {
  const bool of_revolution = up == 'z';
  const auto part = [&](const char* name, const char* length, int across, const std::string& at) {
    return fmt::format(
        "[part.{0}]\n{3}[part.{0}.film]\nthickness = \"1 mm\"\nsection = \"solid\"\nmaterial = \"VHB 4910 "
        "(honeycomb)\"\n[part.{0}.slab]\nlength = \"{1}\"\nheight = \"2 mm\"\n[part.{0}.mesh]\nacross "
        "= {2}\ngrading = 1\n",
        name, length, across, at);
  };
  const std::string height = fmt::format("\"{} mm\"", 2 + gap);
  return fmt::format("model = \"{}\"\n", of_revolution ? "axisymmetric" : "planar") +
         part("lower", "10 mm", 2, "") +
         part("upper", "5 mm", 3,
              of_revolution ? "at = [0, 0, " + height + "]\n" : "at = [\"2 mm\", " + height + ", 0]\n") +
         fmt::format(
             "[contact]\nthickness = \"0.01 mm\"\nbetween = [{1}]\n"
             "[[support]]\nplace = \"lower.bottom\"\nfix = [{2}\"{0}\"]\n"
             "[[support]]\nplace = \"upper.top\"\n{3}displacement = {{ {0} = \"-0.1 mm\" }}\n"
             "[[step]]\nkind = \"move\"\n[output]\nerror_estimate = false\n"
             "[[quantity]]\nname = \"pressed\"\nkind = \"contact force\"\n"
             "[[quantity]]\nname = \"below\"\nkind = \"contact force\"\nof = \"lower.top\"\n"
             "[[quantity]]\nname = \"pressure\"\nkind = \"contact pressure\"\nof = \"upper.bottom\"\n"
             "[[quantity]]\nname = \"held\"\nkind = \"force\"\nof = \"lower.bottom\"\nalong = \"{0}\"\n"
             "[[quantity]]\nname = \"pushed\"\nkind = \"force\"\nof = \"upper.top\"\nalong = \"{0}\"\n",
             up, between, of_revolution ? "" : "\"x\", ", of_revolution ? "" : "fix = [\"x\"]\n");
}

/// What the one block is pushed with the other one's support bears.
TEST_F(Contacts, pass_the_force_on_from_solid_to_solid) {
  for (const char up : {'y', 'z'}) {
    const auto end = values(two_blocks(0.02, up));
    EXPECT_GT(end.at("held"), 0) << up;
    EXPECT_NEAR(end.at("pushed"), -end.at("held"), 1e-6 * end.at("held")) << up;
    EXPECT_NEAR(end.at("pressed"), end.at("held"), 0.1 * end.at("held"))
        << up; // at the edge some of it aside
    EXPECT_EQ(end.at("below"), end.at("pressed")) << up;
    const double area = up == 'y' ? 5e-3 * 1 : std::numbers::pi * 25e-6;
    EXPECT_GT(end.at("pressure"), end.at("held") / area) << up;
  }
}

/// Two discs alike, with few elements: the edge of one stands on that of the other, and slips off it. One
/// that is wider by half of the barrier's reach is pressed on.
TEST_F(Contacts, tell_of_edges_that_slip_off_each_other) {
  const auto disc = [](const char* name, const char* at, double radius, int across) {
    return fmt::format("[part.{0}]\nat = [0, 0, \"{1}\"]\n[part.{0}.film]\nthickness = \"1 mm\"\nsection = "
                       "\"solid\"\n[part.{0}.film.material]\nshear_modulus = \"50 kPa\"\npermittivity = "
                       "\"4e-11 F/m\"\n[part.{0}.slab]\nlength = \"{2} mm\"\nheight = \"4 "
                       "mm\"\n[part.{0}.mesh]\nacross = {3}\n",
                       name, at, radius, across);
  };
  for (const double wider : {0.0, 0.005}) {
    const Run pressed =
        run("model = \"axisymmetric\"\n" + disc("lower", "0 mm", 10 + wider, 3) +
                disc("upper", "4.02 mm", 10, 2) +
                "[contact]\nthickness = \"10 um\"\nbetween = [\"upper.bottom\", \"lower.top\"]\n"
                "[[support]]\nplace = \"lower.bottom\"\nfix = [\"z\"]\n"
                "[[support]]\nplace = \"upper.top\"\ndisplacement = { z = \"-0.5 mm\" }\n"
                "[[step]]\nkind = \"move\"\n[output]\nerror_estimate = false\n"
                "[[quantity]]\nname = \"held\"\nkind = \"force\"\nof = \"lower.bottom\"\nalong = \"z\"\n",
            "held");
    if (wider == 0) {
      EXPECT_EQ(pressed.outcome.kind, "limit point");
      EXPECT_NE(pressed.outcome.message.find("reach over the other by contact.thickness"), std::string::npos)
          << pressed.outcome.message;
    } else {
      EXPECT_EQ(pressed.outcome.ending, Ending::complete) << pressed.outcome.message;
    }
  }
}

/// What moves without strain is on no other path: increments are as long as they are asked for.
TEST_F(Contacts, let_a_solid_come_near_without_strain) {
  std::string text = two_blocks(0.5);
  const std::string kind = "kind = \"move\"\n";
  text.insert(text.find(kind) + kind.size(), "increments = 2\n");
  const Case one = read(text);
  Simulation simulation(one, 1);
  int accepted = 0;
  SimulationObserver observer;
  observer.on_accept = [&](const Frame&) { return ++accepted > 0; };
  EXPECT_EQ(simulation.run(observer).ending, Ending::complete);
  EXPECT_LE(accepted, 3); // as drawn, too
}

/// In space, one of 10 x 10 mm below one of 5 x 5 mm.
std::string two_blocks_in_space(double gap, const std::string& besides = "") {
  const auto part = [&](const char* name, const char* size, const std::string& at) {
    return fmt::format(
        "[part.{0}]\n{2}[part.{0}.film]\nthickness = \"1 mm\"\nsection = \"solid\"\nmaterial = "
        "\"VHB 4910 (honeycomb)\"\n[part.{0}.slab]\nlength = \"{1}\"\nwidth = \"{1}\"\nheight = "
        "\"2 mm\"\n[part.{0}.mesh]\nacross = 1\ngrading = 1\n",
        name, size, at);
  };
  return "model = \"3d\"\n" + part("lower", "10 mm", "") +
         part("upper", "5 mm", fmt::format("at = [\"2 mm\", \"{} mm\", \"0.3 mm\"]\n", 2 + gap)) +
         fmt::format("[contact]\nthickness = \"0.01 mm\"\nbetween = [\"lower.top\", \"upper.bottom\"{}]\n",
                     besides) +
         "[[support]]\nplace = \"lower.bottom\"\nfix = [\"x\", \"y\", \"z\"]\n"
         "[[support]]\nplace = \"upper.top\"\nfix = [\"x\", \"z\"]\ndisplacement = { y = \"-0.1 mm\" }\n"
         "[[step]]\nkind = \"move\"\nincrements = 2\n[output]\nerror_estimate = false\n"
         "[[quantity]]\nname = \"pressed\"\nkind = \"contact force\"\n"
         "[[quantity]]\nname = \"below\"\nkind = \"contact force\"\nof = \"lower.top\"\n"
         "[[quantity]]\nname = \"pressure\"\nkind = \"contact pressure\"\nof = \"upper.bottom\"\n"
         "[[quantity]]\nname = \"held\"\nkind = \"force\"\nof = \"lower.bottom\"\nalong = \"y\"\n"
         "[[quantity]]\nname = \"pushed\"\nkind = \"force\"\nof = \"upper.top\"\nalong = \"y\"\n";
}

TEST_F(Contacts, pass_the_force_on_from_solid_to_solid_in_space) {
  const auto end = values(two_blocks_in_space(0.02));
  EXPECT_GT(end.at("held"), 0);
  EXPECT_NEAR(end.at("pushed"), -end.at("held"), 1e-6 * end.at("held"));
  EXPECT_NEAR(end.at("pressed"), end.at("held"), 0.15 * end.at("held")); // at the edges some of it aside
  EXPECT_EQ(end.at("below"), end.at("pressed"));
  EXPECT_GT(end.at("pressure"), end.at("held") / 25e-6);
  EXPECT_NO_THROW(build_device(read(two_blocks_in_space(0.01))));
  EXPECT_THROW(build_device(read(two_blocks_in_space(0.009))), meshing::MeshError);
  EXPECT_THROW(build_device(read(two_blocks_in_space(-0.5, ", \"upper.left\""))), meshing::MeshError);
  EXPECT_THROW(build_device(read(two_blocks_in_space(0.1, ", \"lower.left\""))), meshing::MeshError);
}

/// Pressed and pushed aside by a little: without friction the lower one's support feels nothing of it.
TEST_F(Contacts, hold_solids_with_friction_between_their_surfaces) {
  const auto pushed = [&](std::string text, const std::string& friction) {
    text.insert(text.find("between = "), "friction = " + friction + "\n");
    const std::string down = "fix = [\"x\"]\ndisplacement = { y = \"-0.1 mm\" }";
    text.replace(text.find(down), down.size(), "displacement = { y = \"-0.022 mm\", x = \"0.004 mm\" }");
    text.replace(text.find("kind = \"move\""), 13, "kind = \"move\"\nincrements = 10");
    text += "[[quantity]]\nname = \"aside\"\nkind = \"force\"\nof = \"lower.bottom\"\nalong = \"x\"\n"
            "[[quantity]]\nname = \"heat\"\nkind = \"energy\"\nof = \"dissipated\"\n";
    return values(text);
  };
  const auto smooth = pushed(two_blocks(0.02), "0"), rough = pushed(two_blocks(0.02), "0.2");
  EXPECT_LT(std::abs(smooth.at("aside")), 0.01 * smooth.at("held"));
  EXPECT_EQ(smooth.at("heat"), 0);
  EXPECT_GT(std::abs(rough.at("aside")), 0.03 * rough.at("held"));
  EXPECT_LT(std::abs(rough.at("aside")), 0.21 * rough.at("held"));
  EXPECT_GT(rough.at("heat"), 0);
}

/// A block whose front comes down across the other one's upper edge: nothing but edges meet.
TEST_F(Contacts, end_where_edges_of_surfaces_meet) {
  std::string text = two_blocks_in_space(0.2);
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("\"lower.top\", \"upper.bottom\"", "\"lower.right\", \"upper.front\"");
  replace("at = [\"2 mm\"", "at = [\"6.77 mm\"");
  replace("-0.1 mm", "-1 mm");
  for (const char* name : {"pressed", "below", "pressure"}) {
    const std::size_t at = text.find(std::string("[[quantity]]\nname = \"") + name);
    text.erase(at, text.find("[[quantity]]", at + 1) - at);
  }
  const Case one = read(text);
  Simulation simulation(one, 1);
  const Outcome outcome = simulation.run({});
  EXPECT_EQ(outcome.ending, Ending::gave_up);
  EXPECT_NE(outcome.message.find("edges of surfaces in [contact] meet"), std::string::npos)
      << outcome.message;
}

TEST_F(Contacts, refuse_surfaces_that_touch_or_cross_as_drawn) {
  EXPECT_NO_THROW(build_device(read(two_blocks(0.01))));
  EXPECT_THROW(build_device(read(two_blocks(0.009))), meshing::MeshError);
  EXPECT_THROW(build_device(read(two_blocks(-0.5, 'y', "\"lower.top\", \"upper.bottom\", \"upper.left\""))),
               meshing::MeshError);
  EXPECT_THROW(build_device(read(two_blocks(0.1, 'y', "\"lower.top\", \"lower.left\", \"upper.bottom\""))),
               meshing::MeshError);
}

} // namespace
} // namespace dielast::cases::contact_test
