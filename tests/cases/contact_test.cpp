// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of a honeycomb that touch: [contact].
#include "cases/devices/device.hpp"
#include "fem/elements/wall_contact.hpp"
#include "meshing/mesh_error.hpp"
#include "tests/cases/path_cases.hpp"
#include "tests/cases/values_at_end.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace dielast::cases {
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

class Contacts : public Paths {
 protected:
  Case read(const std::string& text) {
    write("contact.toml", text);
    return read_case(directory / "contact.toml");
  }
};

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
  const auto without = test::values_at_end(read(honeycomb(90, "")));
  const auto with = test::values_at_end(read(honeycomb(90, contact)));
  for (const char* name : {"eps_x", "eps_y", "released_length_x", "stored_energy"})
    EXPECT_NEAR(with.at(name), without.at(name), 1e-9 * std::abs(without.at(name))) << name;
}

TEST_F(Contacts, refuse_walls_that_touch_as_drawn) {
  EXPECT_THROW(build_device(read(honeycomb(63, contact))), meshing::MeshError);
}

} // namespace
} // namespace dielast::cases
