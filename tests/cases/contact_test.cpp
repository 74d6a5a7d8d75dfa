// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of a honeycomb that touch, and solids on a table: [contact].
#include "cases/devices/device.hpp"
#include "fem/contact/wall_contact.hpp"
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

/// The node on the axis stands for next to no area: its own force over that was 692 kPa. It has the pressure
/// of the node beside it, in the middle of an element.
TEST_F(Contacts, a_sphere_presses_the_table_as_hertz_says) {
  for (const auto& [across, close] : {std::pair{12, 0.25}, {24, 0.1}}) {
    const auto found = values(fmt::format(R"toml([film]
thickness = "5 mm"
[film.material]
shear_modulus = "100 kPa"
permittivity = "4e-11 F/m"
[hollow_sphere]
inner_radius = "5 mm"
outer_radius = "10 mm"
[mesh]
across = {}
[table]
at = "outer"
[contact]
thickness = "5 um"
[[support]]
place = "equator"
displacement = {{ z = "-0.1 mm" }}
[[step]]
kind = "move"
increments = 5
[[quantity]]
name = "force"
kind = "contact force"
[[quantity]]
name = "pressure"
kind = "contact pressure"
[output]
error_estimate = false
)toml",
                                          across));
    const double force = found.at("force"), radius = std::cbrt(3 * force * 10e-3 / (16 * 100e3));
    const double expected = 1.5 * force / (std::numbers::pi * radius * radius);
    EXPECT_NEAR(found.at("pressure"), expected, close * expected) << across;
  }
}

TEST_F(Contacts, refuse_walls_that_touch_as_drawn) {
  EXPECT_THROW(build_device(read(honeycomb(63, contact))), CaseError);
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

/// The pressure of 4 N on 40 mm x 10 mm, whatever stands beside it.
TEST_F(Contacts, of_a_part_and_its_table_go_by_the_part) {
  const auto block = [](const std::string& part, const char* modulus, int width, int at) {
    return fmt::format(
        "[{0}film]\nthickness = \"1 mm\"\nsection = \"solid\"\nwidth = \"{2} mm\"\n[{0}film.material]\n"
        "shear_modulus = \"{1}\"\npermittivity = \"4e-11 F/m\"\n[{0}slab]\nlength = \"10 mm\"\n"
        "height = \"3 mm\"\n[{0}mesh]\nacross = 2\n{3}",
        part, modulus, width,
        part.empty() ? ""
                     : fmt::format("[{}]\nat = [\"{} mm\", 0, 0]\n", part.substr(0, part.size() - 1), at));
  };
  const std::string rest =
      "[table]\nat = \"b.bottom\"\n[contact]\nthickness = \"5 um\"\n"
      "[[support]]\nplace = \"b.left\"\nfix = [\"x\"]\n[[load]]\nplace = \"b.top\"\nforce = [0, \"-4 N\", "
      "0]\n"
      "[[step]]\nkind = \"force\"\n[output]\nerror_estimate = false\n"
      "[[quantity]]\nname = \"pressure\"\nkind = \"contact pressure\"\n"
      "[[quantity]]\nname = \"sunk\"\nkind = \"displacement\"\nof = \"b.bottom\"\nalong = \"y\"\n";
  const auto alone = values("model = \"planar\"\n" + block("part.b.", "10 kPa", 40, 0) + rest);
  const auto beside = values("model = \"planar\"\n" + block("", "400 kPa", 10, 0) +
                             "[[support]]\nplace = \"bottom\"\nfix = [\"x\", \"y\"]\n" +
                             block("part.b.", "10 kPa", 40, 20) + rest);
  EXPECT_NEAR(beside.at("pressure"), 10e3, 100);
  EXPECT_NEAR(beside.at("pressure"), alone.at("pressure"), 1e-9 * 10e3);
  EXPECT_NEAR(beside.at("sunk"), alone.at("sunk"), 1e-12);
}

} // namespace
} // namespace dielast::cases::contact_test
