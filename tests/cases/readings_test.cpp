// SPDX-License-Identifier: GPL-3.0-or-later
// What is read of a film's points where a device has several films, covers or supports of one place.
#include "tests/cases/film_cases.hpp"

#include <cmath>

namespace dielast::cases::readings_test {
namespace {

class Readings : public FilmCases {};

const std::string material = "[film.material]\nshear_modulus = \"50 kPa\"\nrelative_permittivity = 4\n";

// Points of film under an electrode are in one block, those of what is beside it in another.
TEST_F(Readings, OfARollAreOfItsOwnFilm) {
  const auto fields = [&](const char* upper, const char* lower) {
    std::string text = fmt::format(
        "[film]\nthickness = \"100 um\"\nprestretch = 1.05\n{}[antagonistic_rolls]\nlength = \"21 mm\"\n"
        "width = \"141 mm\"\nlayers = 2\nelectrode_length = \"15 mm\"\nelectrode_width = \"125.83 mm\"\narm "
        "= "
        "\"0.4 mm\"\n[hinge]\nlength = \"1 mm\"\nwidth = \"5 mm\"\nthickness = \"50 um\"\nmaterial = {{ "
        "youngs_modulus = \"3.3 GPa\", poisson_ratio = 0.34 }}\n[ribbon]\nlength = \"2 mm\"\nwidth = \"5 "
        "mm\"\n"
        "thickness = \"25 um\"\nmaterial = {{ youngs_modulus = \"2.675 GPa\", poisson_ratio = 0.4 }}\n"
        "[drive.upper]\nvoltage = \"{}\"\n[drive.lower]\nvoltage = \"{}\"\n[output]\nerror_estimate = false\n"
        "[[quantity]]\nname = \"largest\"\nkind = \"extreme\"\nof = \"electric_field\"\nextreme = "
        "\"maximum\"\n",
        material, upper, lower);
    for (const char* place : {"upper", "lower"})
      text += fmt::format(
          "[[quantity]]\nname = \"{0}\"\nkind = \"value\"\nof = \"electric_field\"\nplace = \"{0}\"\n",
          place);
    return run(text);
  };
  const Ran up = fields("1200 V", "0 V"), down = fields("0 V", "1200 V");
  EXPECT_NEAR(up.last("upper"), up.last("largest"), 1e-9 * up.last("largest")); // under the electrode
  EXPECT_EQ(up.last("lower"), 0);
  EXPECT_NEAR(down.last("lower"), up.last("upper"), 1e-7 * up.last("upper"));
  EXPECT_EQ(down.last("upper"), 0);
}

// Every direction leads away from the middle of a disc.
TEST_F(Readings, StretchAlongTheRadiusInTheMiddleIsThatInEveryDirection) {
  for (const char* model : {"3d", "axisymmetric"}) {
    const Ran ran = run(fmt::format(
        "model = \"{}\"\n[film]\nthickness = \"1 mm\"\nprestretch = 2\n{}[disc]\nradius = \"30 mm\"\n"
        "electrode_radius = \"10 mm\"\n[mesh]\nrings = 6\n[drive]\nvoltage = \"2 kV\"\n[output]\n"
        "error_estimate = false\n[[quantity]]\nname = \"radial\"\nkind = \"radial stretch\"\nof = "
        "\"centre\"\n"
        "[[quantity]]\nname = \"larger\"\nkind = \"value\"\nof = \"principal_stretches.lambda1\"\nplace = "
        "\"centre\"\n",
        model, material));
    EXPECT_GT(ran.last("radial"), 2) << model;
    EXPECT_NEAR(ran.last("radial"), ran.last("larger"), 1e-4) << model;
  }
}

TEST_F(Readings, FilmThatIsRolledHasNoStretchAlongARadius) {
  const std::string quantity = "[[quantity]]\nname = \"r\"\nkind = \"radial stretch\"\nof = ";
  write("film.toml", "[film]\nthickness = \"1 mm\"\n" + material +
                         "[line]\nto = [\"40 mm\", 0, 0]\n[rod]\nwidth = \"10 mm\"\nlayers = "
                         "3\n[[support]]\nplace = \"start\"\nfix = [\"x\", \"y\"]\n[[support]]\nplace = "
                         "\"end\"\nfix = [\"x\", \"y\"]\n[[step]]\nkind = \"relax\"\n[[quantity]]\nname = "
                         "\"r\"\nkind = \"radial stretch\"\nof = \"end\"\n");
  const Case one = read_case(directory / "film.toml");
  try {
    Simulation simulation(one, 1);
    ADD_FAILURE() << "not refused";
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("no stretch along a radius"), std::string::npos) << error.what();
  }
}

// Film under the electrode of a rod and beside it is in one element: the field is that under it.
TEST_F(Readings, TheFieldOfARodIsThatUnderItsElectrode) {
  const Ran ran = run(
      "model = \"planar\"\n[film]\nthickness = \"0.1 mm\"\nprestretch = 1.3\n[film.material]\nshear_modulus "
      "= \"50 "
      "kPa\"\npermittivity = \"4e-11 F/m\"\n[line]\nto = [\"40 mm\", 0, 0]\n[rod]\nwidth = \"10 mm\"\n"
      "electrode_width = \"4 mm\"\n[[support]]\nplace = \"start\"\nfix = [\"x\", \"y\"]\n[[support]]\nplace "
      "= "
      "\"end\"\nfix = [\"x\", \"y\"]\n[drive]\nvoltage = \"1 kV\"\n[[step]]\nkind = "
      "\"voltage\"\n[[quantity]]\n"
      "name = \"field\"\nkind = \"value\"\nof = \"electric_field\"\nplace = \"film\"\n[[quantity]]\nname = "
      "\"most\"\nkind = \"extreme\"\nof = \"electric_field\"\nextreme = \"maximum\"\n[output]\n"
      "error_estimate = false\n");
  EXPECT_GT(ran.last("most"), 4e6);
  EXPECT_NEAR(ran.last("field"), ran.last("most"), 1e-9 * ran.last("most"));
}

// Covers of a strip are layers that [[film.layer]] does not know.
TEST_F(Readings, AStripWithCoversEndsAtItsLimitPoint) {
  const Outcome outcome = outcome_of(
      "model = \"3d\"\n[film]\nsection = \"shell\"\nthickness = \"1 mm\"\nprestretch = 1\n" + material +
      "[strip]\nlength = \"60 mm\"\nwidth = \"30 mm\"\nlayers = 2\ncover_thickness = \"0.5 mm\"\n"
      "[mesh]\nacross = 2\n[weight]\nmass = \"10 g\"\n[[step]]\nkind = \"weight\"\n[[step]]\nkind = "
      "\"voltage\"\nto = \"40 kV\"\n[output]\nerror_estimate = false\n");
  EXPECT_EQ(outcome.kind, "limit point") << outcome.message;
}

// Two supports hold one place, one after the other; the controller, which adds nothing, holds the wave of
// that which holds then as it was when it was last measured.
TEST_F(Readings, AControllerAddsToTheSupportThatHolds) {
  const std::string first = "[[support]]\nplace = \"right\"\nfix = [\"x\", \"y\"]\nuntil = \"hold\"\n";
  const std::string second =
      "[[support]]\nplace = \"right\"\nfix = [\"x\", \"y\"]\nfrom = \"move\"\ndisplacement = {x = {wave = "
      "\"ramp\", from = \"0 mm\", to = \"2 mm\", duration = \"1 s\"}}\n";
  for (const std::string& supports : {first + second, second + first}) {
    const Ran ran = run(
        "[film]\nthickness = \"1 mm\"\nprestretch = 1.2\n" + material +
        "[rectangle]\nlength = \"20 mm\"\nwidth = \"20 mm\"\n[mesh]\nacross = 1\n[[support]]\nplace = "
        "\"left\"\n"
        "fix = [\"x\", \"y\"]\n" +
        supports +
        "[[step]]\nkind = \"hold\"\nduration = \"1 s\"\n[[step]]\nname = \"move\"\nkind = \"transient\"\n"
        "duration = \"1 s\"\nincrements = 4\n[[quantity]]\nname = \"f\"\nkind = \"force\"\nof = \"right\"\n"
        "along = \"x\"\n[[quantity]]\nname = \"u\"\nkind = \"displacement\"\nof = \"right\"\nalong = \"x\"\n"
        "[[controller]]\nquantity = \"f\"\ntarget = \"0 N\"\ngain = 0\nevery = \"0.25 s\"\ndrives = "
        "\"displacement\"\nplace = \"right\"\nalong = \"x\"\nlowest = \"-3 mm\"\nhighest = \"3 "
        "mm\"\n[output]\n"
        "error_estimate = false\n");
    EXPECT_NEAR(ran.last("u"), 1.5e-3, 1e-12) << supports;
  }
}

// Walls of a lattice in a part keep apart as those of one at the top of the file.
TEST_F(Readings, ContactIsBetweenTheWallsOfEveryLattice) {
  const auto lattice = [](const std::string& prefix, int angle) {
    return fmt::format(
        "[{0}film]\nmaterial = \"VHB 4910 (honeycomb)\"\nthickness = \"1 mm\"\nprestretch = [4.0, 2.5]\n"
        "[{0}honeycomb]\nangle = \"{1} deg\"\ncolumns = [2, 1]\nwall_length = \"8 mm\"\nwall_width = \"0.8 "
        "mm\"\n"
        "wall_height = \"2 mm\"\nwall_material = \"TPU 78 MPa\"\n[{0}mesh]\nwall_elements = 4\n",
        prefix, angle);
  };
  const auto length = [&](bool first) { // of the lattice whose walls meet
    std::string text = "[contact]\nthickness = \"0.1 mm\"\n" + lattice("", first ? 70 : 110) +
                       lattice("part.b.", first ? 110 : 70) +
                       "[part.b]\nat = [\"100 mm\", \"0 mm\", \"0 mm\"]\n[[step]]\nkind = \"release\"\n";
    for (const char* of : {"", "b."})
      text += fmt::format("[[support]]\nplace = \"{0}left_apex\"\nfix = [\"x\", \"y\"]\n[[support]]\nplace = "
                          "\"{0}right_apex\"\nfix = [\"y\"]\n",
                          of);
    return run(text +
               fmt::format("[[quantity]]\nname = \"length\"\nkind = \"distance\"\nbetween = "
                           "[\"{0}left_apex\", \"{0}right_apex\"]\nalong = \"x\"\n[output]\nerror_estimate = "
                           "false\n",
                           first ? "" : "b."))
        .last("length");
  };
  const double top = length(true);
  EXPECT_NEAR(length(false), top, 1e-6 * top);
}

// Nodes are close together where the electrode ends and strains are small: the mean was 11 % off.
TEST_F(Readings, AMeanOverNodesIsThatAlongTheEdge) {
  const Ran ran = run(
      "model = \"planar\"\n[film]\nthickness = \"50 um\"\nwidth = \"13 mm\"\n[film.material]\nshear_modulus "
      "= "
      "\"0.4 MPa\"\nrelative_permittivity = 2.8\n[slab]\nlength = \"24 mm\"\nheight = \"0.6 mm\"\nelectrode "
      "= "
      "[\"4 mm\", \"14 mm\"]\ncover_thickness = \"50 um\"\n[mesh]\nacross = 2\n[[support]]\nplace = "
      "\"top\"\nfix = [\"y\"]\n[[support]]\nplace = \"left\"\nfix = [\"x\"]\n[drive]\nvoltage = \"1 kV\"\n"
      "[output]\nerror_estimate = false\n[[quantity]]\nname = \"strain\"\nkind = \"value\"\nof = "
      "\"log_strain.xx\"\nplace = \"bottom\"\n[[quantity]]\nname = \"longer\"\nkind = \"displacement\"\nof = "
      "\"right\"\nalong = \"x\"\n");
  const double longer = ran.last("longer") / 0.024;
  EXPECT_NEAR(ran.last("strain"), longer, 5e-3 * longer);
}

// Film that a lift of its edge turns by 45 degrees has the stress of flat film that is stretched as much
// (along an axis in space it had 0.71 of it).
TEST_F(Readings, NominalStressesTurnWithTheFilm) {
  const auto stretched = [&](const char* along) {
    return run("model = \"3d\"\n[film]\nthickness = \"1 mm\"\nprestretch = 2\n" + material +
               "[rectangle]\nlength = \"20 mm\"\nwidth = \"10 mm\"\n[mesh]\nacross = 3\n[[support]]\nplace = "
               "\"left\"\nfix = [\"x\", \"y\", \"z\"]\n[[support]]\nplace = \"right\"\nfix = [\"x\", \"y\", "
               "\"z\"]\n"
               "displacement = { " +
               along +
               " }\n[[support]]\nplace = \"bottom\"\nfix = [\"y\"]\n[[support]]\nplace = \"top\"\nfix = "
               "[\"y\"]\n"
               "[[step]]\nkind = \"move\"\n[output]\nerror_estimate = false\n[[quantity]]\nname = "
               "\"stress\"\nkind "
               "= \"nominal stress\"\nof = \"film\"\nalong = \"x\"\n")
        .last("stress");
  };
  const double flat = stretched("x = \"8.28427124746190 mm\"");
  EXPECT_NEAR(stretched("z = \"20 mm\""), flat, 1e-6 * flat);
}

} // namespace
} // namespace dielast::cases::readings_test
