// SPDX-License-Identifier: GPL-3.0-or-later
// Devices that can be computed and cannot be built, or do not what was meant: told, or refused with the
// reason.
#include "cases/devices/device.hpp"
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases::device_warnings_test {
namespace {

class DeviceWarnings : public Paths {
 protected:
  bool warns(const std::string& text, const std::string& of) {
    const Device device = build_device(read(text));
    return std::ranges::any_of(device.warnings,
                               [&](const std::string& warning) { return warning.find(of) != warning.npos; });
  }
  static std::string film(const std::string& more) {
    return "[film]\n" + more +
           "\n[film.material]\nshear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n";
  }
};

TEST_F(DeviceWarnings, LayersThatDoNotFit) {
  const auto slab = [&](double thickness, const std::string& cover) {
    return film(fmt::format("thickness = \"{} mm\"", thickness)) +
           "[slab]\nlength = \"10 mm\"\nheight = \"2 mm\"\n" + cover +
           "[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\n";
  };
  const std::string told = "film.thickness: a layer is";
  EXPECT_TRUE(warns(slab(2.1, ""), told));
  EXPECT_FALSE(warns(slab(2, ""), told));
  EXPECT_FALSE(warns(slab(0.2, ""), told));
  EXPECT_TRUE(warns(slab(0.3, ""), "6.667 layers"));
  EXPECT_TRUE(warns(slab(2, "cover_thickness = \"0.1 mm\"\n"), told));
  EXPECT_FALSE(warns(slab(1.8, "cover_thickness = \"0.1 mm\"\n"), told));
}

TEST_F(DeviceWarnings, AWallThatIsNotAsThickAsItsFilm) {
  const auto sphere = [&](const char* thickness) {
    return film(fmt::format("thickness = \"{}\"", thickness)) +
           "[hollow_sphere]\ninner_radius = \"10 mm\"\nouter_radius = \"12 mm\"\n[chamber]\nat = "
           "\"inner\"\npressure = \"4 kPa\"\n[[step]]\nkind = \"pressure\"\n";
  };
  EXPECT_TRUE(warns(sphere("5 mm"), "film.thickness: 5.000 mm has no effect here"));
  EXPECT_FALSE(warns(sphere("2 mm"), "film.thickness"));
}

TEST_F(DeviceWarnings, SupportsThatLetGoInNoStep) {
  const auto tells = [&](const char* between) {
    const Case one =
        read(film("thickness = \"1 mm\"\nprestretch = 1.2") +
             "[rectangle]\nlength = \"20 mm\"\nwidth = \"10 mm\"\n[[support]]\nplace = "
             "\"left\"\nfix = [\"x\", \"y\"]\n[[support]]\nplace = \"right\"\ndisplacement = { x "
             "= \"5 mm\" }\nuntil = \"move\"\n[[step]]\nkind = \"move\"\n" +
             std::string(between) + "[[step]]\nkind = \"modes\"\n");
    return std::ranges::any_of(one.warnings, [](const auto& warning) {
      return warning.text().find("support[2].until: has no effect here") != std::string::npos;
    });
  };
  EXPECT_TRUE(tells(""));
  EXPECT_FALSE(tells("[[step]]\nkind = \"relax\"\n"));
}

TEST_F(DeviceWarnings, VolumesWithoutTheirUnit) {
  const auto disc = [&](const char* volume) {
    return "model = \"axisymmetric\"\n" + film("thickness = \"1 mm\"\nprestretch = 3") +
           fmt::format("[disc]\nradius = \"90 mm\"\n[chamber]\nvolume = {}\n[[step]]\nkind = "
                       "\"inflate\"\n",
                       volume);
  };
  EXPECT_TRUE(warns(disc("20"), "a number without a unit is in m^3"));
  EXPECT_FALSE(warns(disc("\"20 ml\""), "a number without a unit"));
}

TEST_F(DeviceWarnings, FilmOfWhichPartsTakeAll) {
  const auto disc = [&](const char* place) {
    return film("thickness = \"1 mm\"\nprestretch = 3") +
           fmt::format("[disc]\nradius = \"90 mm\"\nelectrode_radius = \"30 mm\"\n[part.b]\nplace = \"{}\"\n"
                       "[part.b.film]\nthickness = \"2 mm\"\n[part.b.film.material]\nshear_modulus = "
                       "\"40 kPa\"\nrelative_permittivity = 3\n",
                       place);
  };
  EXPECT_TRUE(warns(disc("film"), "other parts take all of this film"));
  EXPECT_FALSE(warns(disc("electrode"), "other parts take all of this film"));
}

TEST_F(DeviceWarnings, NumbersThatWereMeantInAnotherUnit) {
  const auto doubts = [&](const char* volts, const char* modulus) {
    const Case one = read(fmt::format("[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = {}\n"
                                      "relative_permittivity = 3\n[patch]\n[drive]\nvoltage = {}\n",
                                      modulus, volts));
    return std::ranges::count_if(one.warnings, [](const Diagnostic& told) {
      return told.message.find("without a unit is") != std::string::npos;
    });
  };
  EXPECT_EQ(doubts("3", "4e4"), 1);
  EXPECT_EQ(
      doubts("{ wave = \"ramp\", to = 3, duration = 1 }\n[[step]]\nkind = \"transient\"\nduration = 1", "40"),
      2);
  EXPECT_EQ(doubts("\"3 V\"", "\"40 Pa\""), 0);
  EXPECT_EQ(doubts("0", "4e4"), 0);
  EXPECT_EQ(doubts("300", "4e4"), 0);
}

TEST_F(DeviceWarnings, PlacesBesideSurfacesWithoutAName) {
  write("square.msh",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"frame\"\n1 2 \"side\"\n2 3 "
        "\"film\"\n$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 10 0 0\n3 10 10 0\n4 0 10 0\n5 20 0 0\n6 20 10 "
        "0\n$EndNodes\n$Elements\n4\n1 2 2 3 1 1 2 3\n2 2 2 3 1 1 3 4\n3 1 2 1 1 5 6\n4 1 2 2 2 4 "
        "1\n$EndElements\n");
  const auto held_at = [&](const char* place) {
    return film("thickness = \"0.1 mm\"") +
           fmt::format("[mesh]\nfile = \"square.msh\"\nunit = \"1 mm\"\n[[support]]\nplace = \"{}\"\nfix = "
                       "[\"x\", \"y\"]\n",
                       place);
  };
  const std::string told = "support[1].place: none of the 2 nodes of \"frame\" is one of the film";
  EXPECT_TRUE(warns(held_at("frame"), told));
  EXPECT_FALSE(warns(held_at("side"), "none of the"));
}

TEST_F(DeviceWarnings, DisplacementsOfWhatIsHeld) {
  const auto strip = [&](const char* of, const char* along) {
    return "model = \"3d\"\n" + film("thickness = \"0.1 mm\"\nsection = \"shell\"") +
           fmt::format("[rectangle]\nlength = \"30 mm\"\nwidth = \"6 mm\"\n[mesh]\nacross = 1\n[[quantity]]\n"
                       "name = \"tip\"\nkind = \"displacement\"\nof = \"{}\"\nalong = \"{}\"\n[[support]]\n"
                       "place = \"left\"\nfix = [\"x\", \"y\", \"z\", \"turn_y\"]\n",
                       of, along);
  };
  EXPECT_TRUE(warns(strip("left", "z"), "quantity[1].of: all nodes of \"left\" are held along z"));
  EXPECT_FALSE(warns(strip("right", "z"), "is always 0"));
  EXPECT_TRUE(warns(strip("left", "gravity"), "all nodes of \"left\" are held along gravity"));
  const std::string hung =
      film("thickness = \"0.1 mm\"") +
      "[rectangle]\nlength = \"30 mm\"\nwidth = \"6 mm\"\n[gravity]\ndirection = [0, -1, "
      "0]\n[[quantity]]\nname = \"tip\"\nkind = \"displacement\"\nof = \"right\"\nalong = "
      "\"gravity\"\n[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\n";
  EXPECT_FALSE(warns(hung, "is always 0")); // a plane is held along z, along which nothing falls
  const std::string pinned =
      "model = \"3d\"\n" + film("thickness = \"1 mm\"\nprestretch = [4, 2.5]") +
      "[honeycomb]\nangle = \"150 deg\"\ncolumns = [1, 2, 1]\nwall_length = \"8 mm\"\n"
      "wall_width = \"0.8 mm\"\nwall_height = \"2 mm\"\nwall_material = \"TPU 78 MPa\"\n"
      "[[quantity]]\nname = \"l\"\nkind = \"displacement\"\nof = \"left_apex\"\nalong = "
      "\"z\"\n";
  EXPECT_FALSE(warns(pinned, "is always 0")); // it is told upright, wherever its pins are
}

TEST_F(DeviceWarnings, WallsAndStacksThatAreThickForWhatTheyAre) {
  const auto lattice = [&](const char* width) {
    return film("thickness = \"1 mm\"\nprestretch = [4, 2.5]") +
           fmt::format("[honeycomb]\nangle = \"150 deg\"\ncolumns = [1, 2, 1]\nwall_length = \"8 mm\"\n"
                       "wall_width = \"{}\"\nwall_height = \"2 mm\"\nwall_material = \"TPU 78 MPa\"\n",
                       width);
  };
  EXPECT_TRUE(warns(lattice("3 mm"), "honeycomb.wall_width: walls are 3.000 mm wide and 8.000 mm long"));
  EXPECT_FALSE(warns(lattice("2.6 mm"), "wall_width"));
  const auto strip = [&](int layers) {
    return film("thickness = \"0.5 mm\"") +
           fmt::format("[strip]\nlength = \"60 mm\"\nwidth = \"10 mm\"\nlayers = {}\n", layers);
  };
  EXPECT_TRUE(warns(strip(5), "the film is 2.500 mm thick and 10.00 mm wide"));
  EXPECT_FALSE(warns(strip(3), "thick and"));
}

TEST_F(DeviceWarnings, RollsThatCannotBeWound) {
  const auto roll = [&](int turns) {
    return film("thickness = \"1 mm\"\nprestretch = 2") +
           fmt::format("[roll]\nlength = \"20 mm\"\nradius = \"1 mm\"\nturns = {}\n", turns);
  };
  EXPECT_FALSE(warns(roll(8), "a roll cannot be wound like that"));
  EXPECT_TRUE(warns(roll(9), "a roll cannot be wound like that"));
}

TEST_F(DeviceWarnings, AnElectrodeCoversNoEdge) {
  write("case.toml", film("thickness = \"1 mm\"") +
                         "[disc]\nradius = \"24 mm\"\n[[electrode]]\nname = \"a\"\nplace = \"rim\"\n");
  try {
    build_device(read_case(directory / "case.toml"));
    ADD_FAILURE();
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("electrode[1].place: \"rim\" is no part of the film"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(DeviceWarnings, NothingCanMove) {
  const auto sheet = [&](const std::string& place) {
    return film("thickness = \"1 mm\"") +
           "[rectangle]\nlength = \"20 mm\"\nwidth = \"10 mm\"\n[[support]]\nplace = \"" + place +
           "\"\nfix = [\"x\", \"y\"]\n";
  };
  EXPECT_TRUE(warns(sheet("film"), "nothing can move"));
  EXPECT_FALSE(warns(sheet("left"), "nothing can move"));
  EXPECT_FALSE(warns(sheet("film") +
                         "until = \"a\"\n[[step]]\nkind = \"voltage\"\nname = \"a\"\n[drive]\nvoltage = 1\n",
                     "nothing can move"));
}

TEST_F(DeviceWarnings, APointIsNoElectrodeOfASolid) {
  write("square.msh",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n0 4 \"corner\"\n1 1 \"top\"\n1 3 "
        "\"bottom\"\n2 2 \"film\"\n$EndPhysicalNames\n$Nodes\n9\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 1 0 "
        "0\n6 2 1 0\n7 1 1 0\n8 1 2 0\n9 0 1 0\n"
        "$EndNodes\n$Elements\n5\n1 15 2 4 1 1\n2 8 2 1 1 3 4 8\n3 8 2 3 2 1 2 5\n4 9 2 2 5 1 2 3 5 6 7\n"
        "5 9 2 2 5 1 3 4 7 8 9\n$EndElements\n");
  const auto built = [&](const std::string& ground) {
    return build_device(
        read(film("thickness = \"2 mm\"\nsection = \"solid\"\nfield = \"potential\"") +
             "[mesh]\nfile = \"square.msh\"\nunit = \"1 mm\"\n[[support]]\nplace = \"bottom\"\nfix = "
             "[\"x\", \"y\"]\n[[electrode]]\nname = \"e\"\nplace = \"top\"\nground = \"" +
             ground + "\"\n[drive]\nvoltage = \"1 kV\"\n[[step]]\nkind = \"voltage\"\n"));
  };
  EXPECT_NO_THROW(built("bottom"));
  try {
    built("corner");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("\"corner\" is no surface of the solid"), std::string::npos)
        << error.what();
  }
}

// One sheet of film is drawn through another.
TEST_F(DeviceWarnings, WhatPassesThroughSomethingIsTold) {
  const auto told = [&](double way) {
    std::string text;
    for (const char* part : {"a", "b"})
      text +=
          fmt::format("[part.{0}]\nat = [\"{1} mm\", 0, 0]\n[part.{0}.film]\nthickness = \"1 mm\"\n"
                      "[part.{0}.film.material]\nshear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n"
                      "[part.{0}.rectangle]\nlength = \"10 mm\"\nwidth = \"10 mm\"\n"
                      "[part.{0}.mesh]\nacross = 2\n",
                      part, part[0] == 'a' ? 0 : 15);
    text +=
        fmt::format("[[support]]\nplace = \"b.film\"\nfix = [\"x\", \"y\"]\n[[support]]\nplace = \"a.left\"\n"
                    "fix = [\"y\"]\ndisplacement = {{ x = \"{} mm\" }}\n[[step]]\nkind = \"move\"\n",
                    way);
    return std::ranges::count(run(text, "a_areal_strain").events, "passes through itself",
                              &post::Event::kind);
  };
  EXPECT_EQ(told(4.9), 0);
  EXPECT_EQ(told(5.1), 1);
}

// Two rods in a row, without tension: their joint has no stiffness across.
TEST_F(DeviceWarnings, AJointThatNothingHoldsAcrossIsNoLimitPoint) {
  std::string text = "model = \"planar\"\n";
  for (const char* part : {"a", "b"})
    text += fmt::format("[part.{0}.film]\nthickness = \"0.1 mm\"\n[part.{0}.film.material]\nshear_modulus = "
                        "\"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[part.{0}.rod]\nwidth = \"10 mm\"\n"
                        "[part.{0}.line]\nfrom = [\"{1} mm\", 0, 0]\nto = [\"{2} mm\", 0, 0]\n",
                        part, part[0] == 'a' ? 0 : 20, part[0] == 'a' ? 20 : 40);
  const Outcome ended =
      run(text + "[[tie]]\nbetween = [\"a.end\", \"b.start\"]\n[[support]]\nplace = \"a.start\"\nfix = "
                 "[\"x\", \"y\"]\n[[support]]\nplace = \"b.end\"\nfix = [\"x\", \"y\"]\n[[load]]\nplace = "
                 "\"a.end\"\nforce = [\"1 mN\", 0, 0]\n[[step]]\nkind = \"force\"\n"
                 "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\nof = \"a.end\"\nalong = \"x\"\n",
          "u")
          .outcome;
  EXPECT_EQ(ended.kind, "singular tangent") << ended.message;
}

TEST_F(DeviceWarnings, WavesThatBeginAnew) {
  const auto begins_anew = [&](const std::string& wave, const std::string& steps) {
    const Case one =
        read(film("thickness = \"1 mm\"") + "[patch]\n[drive]\nvoltage = { wave = " + wave + " }\n" + steps);
    return std::ranges::any_of(one.warnings, [](const Diagnostic& warning) {
      return warning.key == "drive.voltage" && warning.message.find("begins anew") != std::string::npos;
    });
  };
  const auto step = [](const std::string& kind) { return "[[step]]\nkind = \"" + kind + "\"\n"; };
  const std::string transient = step("transient") + "duration = \"3 s\"\nincrements = 200\ninertia = false\n",
                    again = transient + "name = \"again\"\n", hold = step("hold") + "duration = \"1 s\"\n";
  const std::string sine = "\"sine\", amplitude = \"1 kV\", frequency = \"0.25 Hz\"",
                    ramp = "\"ramp\", to = \"1 kV\", duration = \"2 s\"",
                    whole = "\"sine\", amplitude = \"1 kV\", frequency = \"1 Hz\"",
                    at_once = "\"step\", to = \"1 kV\"";
  for (const std::string& wave : {sine, ramp}) {
    EXPECT_FALSE(begins_anew(wave, transient)) << wave;
    EXPECT_TRUE(begins_anew(wave, transient + again)) << wave;
    EXPECT_TRUE(begins_anew(wave, transient + hold + again)) << wave;
    EXPECT_FALSE(begins_anew(wave, transient + step("voltage") + again)) << wave;
  }
  EXPECT_FALSE(begins_anew(whole, transient + again));
  EXPECT_FALSE(begins_anew(at_once, transient + again)); // stays where it is
}

} // namespace
} // namespace dielast::cases::device_warnings_test
