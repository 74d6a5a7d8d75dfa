// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/film_cases.hpp"

#include <algorithm>
#include <cmath>

// What a step does on its way, and what it leaves to the one that follows it.

namespace dielast::cases::step_order_test {
namespace {

using StepOrder = FilmCases;

const std::string plate_in_film = R"(
model = "axisymmetric"
annulus = { inner_radius = "12.7 mm", outer_radius = "68.58 mm" }
mesh = { rings = 8 }
film = { thickness = "1 mm", prestretch = 2, material = { shear_modulus = "40 kPa", permittivity = "4e-11 F/m" } }
)";

/// Without time the film has 10/11 of the source's voltage, up to what leaks at the limit; all of the way
/// there was scaled.
TEST_F(StepOrder, WithoutTimeALimitedSourceLeavesTheFilmWhereAsMuchLeaks) {
  const Ran ran =
      run(branched_patch +
          "[circuit]\nresistance = \"20 GOhm\"\nleakage_resistance = \"200 GOhm\"\n"
          "current_limit = \"0.01 uA\"\n[[step]]\nkind = \"voltage\"\nto = \"3.3 kV\"\n"
          "increments = 3\n[[step]]\nname = \"back\"\nkind = \"voltage\"\nto = \"-3.3 kV\"\nincrements = 6\n"
          "[[quantity]]\nname = \"U\"\nkind = \"source voltage\"\nof = \"film\"\n");
  const std::vector<double>& sources = ran.values.at("U");
  for (std::size_t i = 0; i < sources.size(); ++i)
    EXPECT_NEAR(ran.voltages[i][0], std::clamp(sources[i] / 1.1, -2e3, 2e3), 1e-3) << sources[i];
  for (const double wanted : {1100, 2200, 3300, -1100, -3300})
    EXPECT_TRUE(std::ranges::any_of(sources, [=](double U) { return std::abs(U - wanted) < 1e-6; }))
        << wanted;
}

/// `to` of a ramp of forces or displacements is a part of what the case gives.
TEST_F(StepOrder, ARampLeadsToAPartOfTheForcesOrDisplacements) {
  const auto patch = [](const char* pulled) {
    return fmt::format(
        "film = {{ thickness = \"1 mm\", material = {{ shear_modulus = \"40 kPa\", permittivity = "
        "\"4e-11 F/m\" }} }}\npatch = {{ mode = \"equal-biaxial\", {} }}\n",
        pulled);
  };
  const Ran pulled = run(patch("stress_x = \"40 kPa\"") +
                         "step = [{ kind = \"force\", to = 0.5 }, { kind = \"force\", name = \"all\" }, "
                         "{ kind = \"force\", name = \"off\", to = 0, increments = 1 }]\n");
  const std::vector<double>& stress = pulled.values.at("stress_x");
  EXPECT_NEAR(stress[10], 20e3, 1e-4);
  EXPECT_NEAR(stress[20], 40e3, 1e-4);
  EXPECT_NEAR(pulled.values.at("stretch_x").back(), 1, 1e-9);
  const Ran moved = run(patch("stretch_x = 3") + "step = [{ kind = \"move\" }, { kind = \"move\", name = "
                                                 "\"back\", to = 0.25, increments = 1 }]\n");
  EXPECT_NEAR(moved.values.at("stretch_x")[10], 3, 1e-12);
  EXPECT_NEAR(moved.values.at("stretch_x").back(), 1.5, 1e-12);
}

// A second step to where the first one has led is a slip: it says so.
TEST_F(StepOrder, ARampToWhatIsThereAlreadyIsTold) {
  const auto warnings = [&](const std::string& steps) {
    write("film.toml",
          "film = { thickness = \"1 mm\", material = { shear_modulus = \"40 kPa\", permittivity = "
          "\"4e-11 F/m\" } }\npatch = { mode = \"equal-biaxial\", stretch_x = 3 }\n"
          "drive = { voltage = \"1 kV\" }\n" +
              steps);
    std::string all;
    for (const Diagnostic& warning : read_case(directory / "film.toml").warnings)
      all += warning.message + "\n";
    return all;
  };
  const std::string cycle = "step = [{ kind = \"move\" }, { kind = \"voltage\" }, { kind = \"move\", name = "
                            "\"back\", control = \"charge\"";
  EXPECT_NE(
      warnings(cycle + " }]\n").find("leads nowhere: step \"move\" has led the displacements there already"),
      std::string::npos);
  EXPECT_EQ(warnings(cycle + ", to = 0.25 }, { kind = \"voltage\", name = \"again\" }]\n"), "");
  EXPECT_NE(warnings("step = [{ kind = \"move\" }, { kind = \"voltage\" }, { kind = \"voltage\", name = "
                     "\"again\" }]\n")
                .find("has led the voltage there already"),
            std::string::npos);
}

TEST_F(StepOrder, NoStepHasTheNameOfTheOneThatCutsTheFilmFree) {
  const auto named = [&](const char* name) {
    write(
        "film.toml",
        fmt::format("[film]\nthickness = \"0.5 mm\"\nprestretch = 1.3\n[film.material]\nshear_modulus = "
                    "\"40 kPa\"\nrelative_permittivity = 3\n[rectangle]\nlength = \"10 mm\"\n[mesh]\nacross "
                    "= 2\n[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\n[[step]]\nname = \"{}\"\nkind "
                    "= \"voltage\"\n",
                    name));
    return read_case(directory / "film.toml");
  };
  const Case settle = named("settle"), rise = named("rise");
  EXPECT_THROW(Simulation(settle, 1), CaseError);
  EXPECT_NO_THROW(Simulation(rise, 1));
}

// What was kinetic, and what the forces that accelerated it had stretched, is released, and told.
TEST_F(StepOrder, AStepWithoutInertiaGoesOnFromWhereWhatMovedComesToRest) {
  const auto ends = [&](const std::string& steps) {
    return run(
        plate_in_film +
        "plate = { mass = \"100 g\" }\ndrive.voltage = \"5 kV\"\nquantity = [{ name = \"released\", kind = "
        "\"energy\", of = \"released\" }]\nstep = [{ kind = \"weight\" }, " +
        steps + "]\n");
  };
  const auto works = [](const Ran& ran) { return ran.last("electrical_work") + ran.last("mechanical_work"); };
  const std::string rise = "{ kind = \"voltage\", to = \"5.5 kV\" }";
  const Ran slow = ends(rise);
  for (const std::string between : {"", "{ kind = \"hold\", inertia = false, duration = 1 }, "}) {
    const Ran stopped = ends("{ kind = \"transient\", duration = 0.09 }, " + between + rise);
    EXPECT_TRUE(stopped.events.contains("came to rest")) << between;
    EXPECT_NEAR(stopped.last("drop") / slow.last("drop"), 1, 1e-6) << between;
    EXPECT_NEAR(stopped.last("stored_energy") / slow.last("stored_energy"), 1, 1e-8) << between;
    const double released = stopped.last("released");
    EXPECT_GT(released, 1e-5) << between; // 5 kV at once do more work than the film takes
    EXPECT_NEAR(released, works(stopped) - works(slow), 1e-3 * released) << between;
    EXPECT_LT(stopped.last("energy_error"), 1e-3 * released) << between;
  }
}

// Steps that are not about loads leave them where a wave has led them.
TEST_F(StepOrder, AStepOfAnotherKindLeavesLoadsWhereTheyAre) {
  const auto sinks = [&](const std::string& step) {
    return run(plate_in_film +
               "support = [{ place = \"outer\", fix = [\"x\", \"y\", \"z\"] }]\nbody = [{ name = \"plate\", "
               "places = "
               "[\"inner\"] }]\nquantity = [{ name = \"sinks\", kind = \"displacement\", of = \"inner\", "
               "along = "
               "\"z\" }]\nload = [{ place = \"plate\", force = [0, 0, { wave = \"ramp\", from = \"-0.1 N\", "
               "to = "
               "\"-0.5 N\", duration = \"1 s\" }] }]\nstep = [{ kind = \"transient\", duration = 1, inertia "
               "= false, "
               "increments = 4 }" +
               step + "]\n")
        .last("sinks");
  };
  const double down = sinks("");
  for (const char* step :
       {", { kind = \"release\" }", ", { kind = \"weight\" }", ", { kind = \"hold\", duration = 1 }"})
    EXPECT_NEAR(sinks(step) / down, 1, 1e-9) << step;
  EXPECT_LT(sinks(", { kind = \"force\" }") / down, 0.5);
}

const std::string pulled_patch = R"(
[film]
thickness = "0.5 mm"
prestretch = [1.8, 1.1]
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
[[film.material.branch]]
shear_modulus = "30 kPa"
relaxation_time = "0.2 s"
[patch]
mode = "pure-shear"
[[quantity]]
name = "released"
kind = "energy"
of = "released"
)";

// Film is cut free under its voltage: charge goes back to the source, and dashpots turn into heat what they
// do wherever else a support lets go. What the frame held back is released instead of done on it.
TEST_F(StepOrder, WhatIsCutFreeIsReleasedAndNeitherTheSourcesWorkNorHeat) {
  const auto let_go = [&](const std::string& step) {
    return run("support = [{ place = \"right\", fix = [\"x\"], until = \"on\" }]\ndrive.voltage = \"3 kV\"\n"
               "step = [{ name = \"on\", kind = \"voltage\" }, { name = \"cut\", " +
               step + " }]\n" + pulled_patch);
  };
  const Ran held = let_go("kind = \"voltage\""), at_once = let_go("kind = \"release\"");
  const double charge = held.values.at("charge").at(10), charged = held.values.at("electrical_work").at(10);
  EXPECT_NEAR(charged, 1.5e3 * charge, 1e-9 * charged);
  EXPECT_NEAR(at_once.last("electrical_work"), charged + 3e3 * (at_once.last("charge") - charge),
              1e-9 * charged);
  EXPECT_EQ(at_once.last("dissipated_energy"), 0);
  EXPECT_NEAR(at_once.last("released"), -held.last("mechanical_work"), 1e-9 * at_once.last("released"));
  const std::string takes_time = ", duration = \"0.5 s\", increments = 100";
  const Ran slow = let_go("kind = \"release\"" + takes_time),
            likewise = let_go("kind = \"voltage\"" + takes_time);
  EXPECT_GT(slow.last("dissipated_energy"), 1e-5);
  for (const char* same : {"stretch_x", "electrical_work", "dissipated_energy"})
    EXPECT_NEAR(slow.last(same) / likewise.last(same), 1, 1e-9) << same;
  EXPECT_NEAR(slow.last("released") / -likewise.last("mechanical_work"), 1, 1e-9);
  EXPECT_EQ(slow.last("mechanical_work"), 0);
}

// Of a mass that a support takes hold of the motion is gone: that is no error of the works.
TEST_F(StepOrder, ASupportThatCatchesAMassReleasesItsKineticEnergy) {
  const Ran ran = run(R"(
[film]
thickness = "0.5 mm"
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
density = 0
[patch]
length = "20 mm"
width = "12 mm"
mode = "pure-shear"
[[point_mass]]
place = "right"
mass = "10 g"
[[load]]
place = "right"
force = [{ wave = "step", to = "0.1 N" }, 0, 0]
[[support]]
place = "right"
fix = ["x"]
from = "caught"
[[step]]
kind = "transient"
duration = "25 ms"
[[step]]
name = "caught"
kind = "hold"
duration = "0.1 s"
[[quantity]]
name = "released"
kind = "energy"
of = "released"
[[quantity]]
name = "kinetic"
kind = "energy"
of = "kinetic"
)");
  const std::vector<double>& kinetic = ran.values.at("kinetic");
  const double most = *std::ranges::max_element(kinetic);
  EXPECT_GT(most, 1e-4);
  EXPECT_NEAR(ran.last("released"), most, 1e-9 * most);
  EXPECT_NEAR(ran.last("released"), ran.last("mechanical_work") - ran.last("stored_energy"), 1e-4 * most);
  EXPECT_LT(ran.last("energy_error"), 1e-4 * most);
  EXPECT_TRUE(ran.events.contains("caught"));
}

} // namespace
} // namespace dielast::cases::step_order_test
