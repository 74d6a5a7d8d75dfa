// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/film_cases.hpp"

// Levels of a drive: ramps that say where they lead.

namespace dielast::cases::levels_test {
namespace {

using Levels = FilmCases;
using Rows = std::vector<std::vector<double>>;

const std::string viscous_patch =
    "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\n"
    "permittivity = \"4e-11 F/m\"\n[[film.material.branch]]\nshear_modulus = \"40 "
    "kPa\"\nrelaxation_time = \"1 s\"\n[patch]\nmode = \"equal-biaxial\"\n";

std::string ramp(const std::string& keys) { return "[[step]]\nkind = \"voltage\"\nincrements = 1\n" + keys; }

TEST_F(Levels, each_is_reached_and_the_last_ramp_follows_the_drive) {
  const std::string hold = "[[step]]\nkind = \"hold\"\nduration = \"1 s\"\nincrements = 1\n";
  EXPECT_EQ(run(viscous_patch + "[drive]\nvoltage = \"2 kV\"\n" + ramp("name = \"up\"\nto = \"3 kV\"\n") +
                hold + ramp("name = \"down\"\nto = \"0 V\"\n") + ramp(""))
                .voltages,
            (Rows{{0}, {3000}, {3000}, {0}, {2000}}));
}

TEST_F(Levels, need_no_drive) {
  const Ran driven = run(viscous_patch + ramp("to = \"3 kV\"\n"));
  EXPECT_EQ(driven.voltages, (Rows{{0}, {3000}}));
  const Ran charged =
      run(viscous_patch + fmt::format("[[step]]\nkind = \"charge\"\nincrements = 4\nto = \"{:.17g} C\"\n",
                                      driven.last("capacitance") * 3000));
  EXPECT_NEAR(charged.voltages.back().front(), 3000, 1e-4);
}

TEST_F(Levels, may_be_of_one_electrode) {
  const std::string cells = test::small_honeycomb.substr(0, test::small_honeycomb.find("[drive]")) +
                            "[mesh]\nwall_elements = 2\n"
                            "[[electrode]]\nname = \"a\"\nplace = \"cell[0,0]\"\n"
                            "[[electrode]]\nname = \"b\"\nplace = \"cell[2,0]\"\n"
                            "[[step]]\nkind = \"release\"\n";
  const Ran ran = run(cells + ramp("name = \"first\"\nelectrode = \"b\"\nto = \"2 kV\"\n") +
                      ramp("name = \"both\"\nto = \"1 kV\"\n"));
  EXPECT_EQ(ran.voltages, (Rows{{0, 0}, {0, 0}, {0, 2000}, {1000, 1000}}));
}

} // namespace
} // namespace dielast::cases::levels_test
