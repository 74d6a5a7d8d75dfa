// SPDX-License-Identifier: GPL-3.0-or-later
// Released lattices in space: how they lie, and how they vibrate.
#include "tests/cases/film_cases.hpp"

#include <algorithm>

namespace dielast::cases::lattices_in_space_test {
namespace {

class LatticesInSpace : public FilmCases {
 protected:
  static std::string lattice(const std::string& rest, const std::string& walls,
                             const std::string& branches = "") {
    return "model = \"3d\"\n[film]\nthickness = \"1 mm\"\nprestretch = [4, 2.5]\n[film.material]\n"
           "shear_modulus = \"45 kPa\"\npermittivity = \"4e-11 F/m\"\n" +
           branches +
           "[honeycomb]\nangle = \"150 deg\"\ncolumns = [2, 1, 2]\nwall_length = \"8 mm\"\nwall_width = "
           "\"0.8 mm\"\nwall_material = \"TPU 78 MPa\"\n" +
           walls +
           "[mesh]\nwall_elements = 2\n[drive]\nvoltage = \"4 kV\"\n[output]\nerror_estimate = false\n"
           "fields = false\n" +
           rest;
  }
  static std::string modal(int mode) {
    return fmt::format("[[quantity]]\nname = \"m{0}\"\nkind = \"modal stiffness\"\nmode = {0}\n", mode);
  }
};

// Walls on one face curl the film, which turns the pinned body. By symmetry the upper and the lower side are
// at one height, so that what is between them has no direction but y.
TEST_F(LatticesInSpace, are_measured_upright) {
  const Ran ran = run(lattice("[[step]]\nkind = \"release\"\n[[step]]\nkind = \"voltage\"\nincrements = 2\n"
                              "[[quantity]]\nname = \"apart\"\nkind = \"distance\"\n"
                              "between = [\"corner_top\", \"corner_bottom\"]\nat = \"release\"\n"
                              "[[quantity]]\nname = \"up\"\nkind = \"displacement\"\nof = \"corner_top\"\n"
                              "along = \"z\"\n[[quantity]]\nname = \"down\"\nkind = \"displacement\"\n"
                              "of = \"corner_bottom\"\nalong = \"z\"\n",
                              "wall_height = \"3 mm\"\nwall_print = \"one face\"\n"));
  const auto &up = ran.values.at("up"), &down = ran.values.at("down");
  EXPECT_GT(std::abs(up.back()), 1e-4);
  EXPECT_NEAR(down.back(), up.back(), 2e-3 * std::abs(up.back())); // the mesh is not quite symmetric
  const double released = ran.last("released_length_y");
  EXPECT_NEAR(ran.last("apart"), released, 1e-7 * released);
}

// Loads that balance, however small, and masses that move freely begin where the device lies.
TEST_F(LatticesInSpace, go_on_lying_as_they_do) {
  const std::string load = "[[load]]\nplace = \"corner_top\"\nforce = [0, \"1 uN\", 0]\n"
                           "[[load]]\nplace = \"corner_bottom\"\nforce = [0, \"-1 uN\", 0]\n";
  const std::string walls = "wall_height = \"3 mm\"\nwall_print = \"one face\"\n",
                    release = "[[step]]\nkind = \"release\"\n";
  const double free = run(lattice(release, walls)).last("released_length_y");
  for (const std::string& rest :
       {load + "[[step]]\nkind = \"force\"\n",
        std::string("[[step]]\nkind = \"hold\"\ninertia = true\nduration = \"1 ms\"\nincrements = 1\n")}) {
    const Ran ran = run(lattice(release + rest +
                                    "[[quantity]]\nname = \"now\"\nkind = \"distance\"\n"
                                    "between = [\"corner_top\", \"corner_bottom\"]\nalong = \"y\"\n",
                                walls));
    EXPECT_NEAR(ran.last("now"), free, 1e-4 * free) << rest;
  }
}

// What the branches still do is small, but no stiffness of a turn: frequencies of what has relaxed.
TEST_F(LatticesInSpace, that_are_nearly_at_rest_do_not_vibrate_as_a_whole) {
  const std::string branches = "[[film.material.branch]]\nshear_modulus = \"26 kPa\"\nrelaxation_time = "
                               "\"1 s\"\n[[film.material.branch]]\nshear_modulus = \"10 kPa\"\n"
                               "relaxation_time = \"20 s\"\n";
  const auto lowest = [&](const std::string& steps) {
    return run(lattice(steps + modal(1), "wall_height = \"2 mm\"\n", branches)).last("m1");
  };
  const double relaxed = lowest("[[step]]\nkind = \"release\"\n");
  EXPECT_GT(relaxed, 1e4);
  EXPECT_NEAR(lowest("[[step]]\nkind = \"release\"\nduration = \"0.2 s\"\nincrements = 4\n[[step]]\n"
                     "kind = \"hold\"\nduration = \"240 s\"\n"),
              relaxed, 1e-3 * relaxed);
}

// Low walls, so that the released state is far from stable: those nearest to zero are others.
TEST_F(LatticesInSpace, have_the_lowest_modes_of_unstable_states) {
  const Ran ran = run(lattice("[[step]]\nkind = \"release\"\nincrements = 2\non_instability = \"follow\"\n"
                              "[[step]]\nkind = \"modes\"\ncount = 6\n" +
                                  modal(1) + modal(2) + modal(3),
                              "wall_height = \"0.4 mm\"\n"));
  const auto& rows = ran.analyses.at(0).rows;
  ASSERT_LT(ran.last("m2"), 0);
  for (int mode = 1; mode <= 3; ++mode)
    EXPECT_NEAR(ran.last(fmt::format("m{}", mode)) / rows.at(static_cast<std::size_t>(mode) - 1).at(3), 1,
                1e-8)
        << mode;
  EXPECT_TRUE(std::ranges::is_sorted(rows, {}, [](const auto& row) { return row.at(3); }));
}

} // namespace
} // namespace dielast::cases::lattices_in_space_test
