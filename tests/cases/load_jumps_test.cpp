// SPDX-License-Identifier: GPL-3.0-or-later
// Loads that jump past the stability of a device, and devices that come to rest at the beginning of a step.
#include "tests/cases/film_cases.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::cases::load_jumps_test {
namespace {

class LoadJumps : public FilmCases {
 protected:
  /// A column under these steps and forces along it; Euler's load is 0.82 mN.
  static std::string column(const std::string& force, const std::string& steps) {
    return "model = \"3d\"\n[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"45 kPa\"\n"
           "relative_permittivity = 4\n[patch]\nlength = \"10 mm\"\n[part.bar]\nat = [0, \"50 mm\", 0]\n"
           "[part.bar.line]\nto = [\"100 mm\", 0, 0]\n[part.bar.mesh]\nwall_elements = 6\n[part.bar.beam]\n"
           "width = \"2 mm\"\nheight = \"1.5 mm\"\nmaterial = { youngs_modulus = \"10 MPa\", poisson_ratio = "
           "0.3 }\n[[support]]\nplace = \"film\"\nfix = [\"x\", \"y\", \"z\"]\n[[support]]\nplace = "
           "\"bar.start\"\nfix = [\"x\", \"y\", \"z\", \"turn_x\", \"turn_y\", \"turn_z\"]\n[[load]]\nplace "
           "= "
           "\"bar.end\"\nforce = [" +
           force + ", 0, 0]\n" + steps +
           "[[quantity]]\nname = \"z\"\nkind = \"displacement\"\nof = \"bar.end\"\nalong = "
           "\"z\"\n[[quantity]]\n"
           "name = \"mean\"\nkind = \"mean\"\nof = \"z\"\nsince = \"before\"\n[output]\nerror_estimate = "
           "false\n";
  }
};

const std::string before = "[[step]]\nname = \"before\"\nkind = \"relax\"\n";

// Whether the load jumps or grows, the device jumps to one bent state, and no time passes on the way.
TEST_F(LoadJumps, LeadToTheStateThatARampLeadsTo) {
  const double bent =
      std::abs(run(column("\"-1.8 mN\"", before + "[[step]]\nkind = \"force\"\nincrements = 4\n"
                                                  "on_instability = \"jump\"\n"))
                   .last("z"));
  EXPECT_GT(bent, 0.05);
  for (const char* at : {"0 s", "0.5 s"}) {
    const Ran ran = run(column(
        fmt::format("{{ wave = \"step\", to = \"-1.8 mN\", at = \"{}\" }}", at),
        before + "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\nincrements = 4\non_instability = "
                 "\"jump\"\n"));
    EXPECT_NEAR(std::abs(ran.last("z")), bent, 1e-6 * bent) << at;
    EXPECT_NEAR(std::abs(ran.last("mean")), (at[2] == '5' ? 0.5 : 1) * bent, 1e-5 * bent) << at;
    EXPECT_NEAR(ran.time.back(), 1, 1e-9) << at;
    EXPECT_TRUE(std::ranges::is_sorted(ran.time)) << at;
    EXPECT_EQ(ran.events.count("jump"), 1U) << at;
  }
}

// Jumps are counted step by step.
TEST_F(LoadJumps, AreManyInManySteps) {
  std::string steps;
  for (int cycle = 0; cycle < 60; ++cycle)
    for (const int to : {26, 0})
      steps += fmt::format("[[step]]\nname = \"v{0}_{1}\"\nkind = \"voltage\"\nto = \"{1} kV\"\nincrements = "
                           "2\non_instability = "
                           "\"jump\"\n",
                           cycle, to);
  const Ran ran = run("[film]\nthickness = \"1 mm\"\n[film.material]\nlaw = \"gent\"\nshear_modulus = \"20 "
                      "kPa\"\nstretch_limit = 60\npermittivity = \"4e-11 F/m\"\n[patch]\n" +
                      steps + "[output]\nerror_estimate = false\n");
  EXPECT_GE(ran.events.count("jump"), 120U);
}

// What comes to rest at the beginning of a step is there for all of it, in however few increments.
TEST_F(LoadJumps, AMeanIsOfWhereADeviceComesToRest) {
  const Ran ran =
      run("model = \"axisymmetric\"\n[film]\nthickness = \"1 mm\"\nprestretch = "
          "2\n[film.material]\nshear_modulus = "
          "\"40 kPa\"\nrelative_permittivity = 4.7\n[annulus]\ninner_radius = \"12.7 mm\"\nouter_radius = "
          "\"68.58 "
          "mm\"\n[plate]\nmass = \"100 g\"\n[mesh]\nrings = 4\n[drive]\nvoltage = { wave = \"step\", to = "
          "\"5 kV\" "
          "}\n[[step]]\nkind = \"weight\"\n[[step]]\nname = \"swing\"\nkind = \"transient\"\nduration = "
          "\"0.087 s\"\n"
          "inertia = true\nincrements = 50\n[[step]]\nkind = \"hold\"\nduration = \"1 s\"\ninertia = "
          "false\nincrements = 1\n"
          "[[quantity]]\nname = \"place\"\nkind = \"displacement\"\nof = \"inner\"\nalong = \"z\"\nsince = "
          "\"weight\"\n[[quantity]]\nname = \"mean\"\nkind = \"mean\"\nof = \"place\"\nsince = "
          "\"swing\"\n[solver]\n"
          "time_tolerance = 1e-3\n[output]\nerror_estimate = false\n");
  EXPECT_EQ(ran.events.count("came to rest"), 1U);
  EXPECT_NEAR(ran.last("mean"), ran.last("place"), 1e-6 * std::abs(ran.last("place")));
}

// Gains of small motions do not depend on how fast others are that are asked for beside them.
TEST_F(LoadJumps, AFreeFilmsGainKnowsNothingOfOtherFrequencies) {
  const auto gain = [&](const char* to) {
    const Ran ran = run(fmt::format(
        "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\nrelative_permittivity = "
        "4.7\ndensity = \"960 kg/m^3\"\nviscosity = \"1e4 Pa.s\"\n[disc]\nradius = \"10 mm\"\n[mesh]\nrings "
        "= "
        "4\n[drive]\nvoltage = \"1 kV\"\n[[support]]\nplace = \"rim\"\nfix = [\"x\", \"y\"]\nuntil = "
        "\"v0\"\n[[step]]\nkind = \"voltage\"\nname = \"v0\"\nto = 0\nincrements = 1\n[[step]]\nkind = "
        "\"voltage\"\n[[step]]\nkind = \"harmonic\"\nfrom = \"0.001 Hz\"\nto = \"{}\"\npoints = 2\n"
        "response_of = \"r\"\n[[quantity]]\nname = \"r\"\nkind = \"radius\"\nof = \"rim\"\n[output]\n"
        "error_estimate = false\n",
        to));
    return ran.analyses.at(0).rows.at(0).at(1);
  };
  const double slow = gain("1 Hz");
  EXPECT_GT(slow, 0);
  EXPECT_NEAR(gain("100 kHz"), slow, 1e-6 * slow);
}

} // namespace
} // namespace dielast::cases::load_jumps_test
