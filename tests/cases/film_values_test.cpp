// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/film_cases.hpp"

#include <cmath>
#include <numbers>

// Fields of the film at a point or at a place, as quantities.

namespace dielast::cases::film_values_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A quantity of kind "value"; `where`: its place or point as written.
std::string value(const std::string& name, const std::string& field, const std::string& where) {
  return fmt::format("[[quantity]]\nname = \"{}\"\nkind = \"value\"\nof = \"{}\"\n{}\n", name, field, where);
}

std::string point(double x, double y, double z) {
  return fmt::format("point = [\"{:.17g} m\", \"{:.17g} m\", \"{:.17g} m\"]", x, y, z);
}

std::string film(const std::string& model) {
  return "model = \"" + model +
         "\"\n[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nlaw = \"neo-hookean\"\n"
         "shear_modulus = \"40 kPa\"\nrelative_permittivity = 4.7\n[output]\nerror_estimate = false\n"
         "fields = false\n";
}

const double inner = 12.7e-3;

/// A plate of 100 g lifted by film at 3 kV.
std::string diaphragm(const std::string& model) {
  return film(model) +
         "[annulus]\ninner_radius = \"12.7 mm\"\nouter_radius = \"68.58 mm\"\n[plate]\nmass = \"100 g\"\n"
         "[drive]\nvoltage = \"3 kV\"\n[[step]]\nkind = \"weight\"\n[[step]]\nkind = \"voltage\"\n";
}

class FilmValues : public FilmCases {
 protected:
  /// What is told instead of a run.
  std::string refusal(const std::string& text) {
    write("film.toml", text);
    try {
      const Case one = read_case(directory / "film.toml");
      Simulation(one, 1);
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  }
  std::string at(int line, int column) const {
    return fmt::format("{}:{}:{}: error: ", (directory / "film.toml").string(), line, column);
  }
};

TEST_F(FilmValues, AreThoseOfUniformFilmEverywhere) {
  const Ran ran = run(
      film("planar") +
      "[patch]\nlength = \"10 mm\"\nwidth = \"20 mm\"\nstretch_x = 3\nstretch_y = 2.5\n[[step]]\nkind = "
      "\"move\"\n" +
      value("point", "principal_stretches.lambda1", point(1e-3, 7e-3, 0)) +
      value("corner", "principal_stretches.lambda2", point(0, 0, 0)) +
      value("mean", "principal_stretches.lambda3", "place = \"film\"") +
      value("edge", "cauchy_stress.xx", "place = \"left\"") + value("slope", "slope", "place = \"film\""));
  EXPECT_NEAR(ran.last("point"), 3, 1e-12);
  EXPECT_NEAR(ran.last("corner"), 2.5, 1e-12);
  EXPECT_NEAR(ran.last("mean"), 1 / 7.5, 1e-13);
  EXPECT_NEAR(ran.last("edge"), 40e3 * (9 - std::pow(7.5, -2)), 1e-6);
  EXPECT_EQ(ran.last("slope"), 0);
}

TEST_F(FilmValues, AtAnEdgeCarryThePlate) {
  const std::string edge = "place = \"inner\"";
  const std::string fields = value("stress", "max_principal_stress", edge) +
                             value("thickness", "thickness", edge) + value("slope", "slope", edge);
  for (const auto& [model, bound] : {std::pair{"axisymmetric", 2e-4}, {"3d", 5e-3}}) {
    const Ran ran = run(diaphragm(model) + fields +
                        value("there", "slope", point(inner * std::cos(0.7), inner * std::sin(0.7), 0)) +
                        value("stretch", "principal_stretches.lambda1", edge));
    // What the film pulls along the radius has the plate's weight as its part along z.
    const double lift =
        2 * pi * inner * ran.last("stress") * ran.last("thickness") * std::sin(ran.last("slope"));
    EXPECT_NEAR(lift, 0.1 * 9.81, bound * 0.981) << model;
    EXPECT_NEAR(ran.last("there"), ran.last("slope"), bound * ran.last("slope")) << model;
    EXPECT_NEAR(ran.last("stretch"), ran.last("stretch_inner"), bound) << model;
  }
}

TEST_F(FilmValues, OnASphereItsSlopeIsTheAngleFromThePole) {
  std::string quantities;
  for (int i = 0; i < 5; ++i)
    quantities += value(
        fmt::format("slope_{}", i), "slope",
        point(0.6 * 20e-3 * std::sin(0.7 * i), 0.8 * 20e-3 * std::sin(0.7 * i), 20e-3 * std::cos(0.7 * i)));
  const Ran ran = run(film("axisymmetric") +
                      "[balloon]\nradius = \"20 mm\"\n[chamber]\npressure = \"0.5 kPa\"\n[[step]]\nkind = "
                      "\"pressure\"\n" +
                      quantities);
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(ran.last(fmt::format("slope_{}", i)), std::min(0.7 * i, pi - 0.7 * i), 2e-3) << i;
}

// The film ends there, or its fields do.
TEST_F(FilmValues, BesideTheFilmOrOnAnEdgeOfAnElectrodeThereAreNone) {
  const std::string disc = film("3d") + "[disc]\nradius = \"30 mm\"\nelectrode_radius = \"10 mm\"\n[drive]\n"
                                        "voltage = \"1 kV\"\n[[step]]\nkind = \"voltage\"\n";
  const int line = static_cast<int>(std::count(disc.begin(), disc.end(), '\n')) + 5;
  const std::string nothing = "there is no film; coordinates are those of the film as drawn";
  EXPECT_EQ(refusal(disc + value("far", "thickness", point(31e-3, 0, 0))),
            at(line, 9) + "quantity[1].point: " + nothing);
  EXPECT_EQ(refusal(disc + value("high", "thickness", point(1e-3, 0, 5e-3))),
            at(line, 9) + "quantity[1].point: " + nothing);
  const std::string two =
      "the edge of an electrode or of a film is there, where a field has two values; give a point beside it, "
      "or a part of the film";
  EXPECT_EQ(refusal(disc + value("edge", "thickness", point(6e-3, 8e-3, 0))),
            at(line, 9) + "quantity[1].point: " + two);
  EXPECT_EQ(refusal(disc + value("beside", "thickness", point(6.1e-3, 8e-3, 0))), "");
  EXPECT_EQ(refusal(disc + value("edge", "thickness", "place = \"electrode_edge\"")),
            at(line, 9) + "quantity[1].place: " + two);
}

// A relative change needs something to compare with: 0/0 would be any number.
TEST_F(FilmValues, ElongationsAcrossAnAxisAreRefused) {
  const std::string disc = film("3d") + "[disc]\nradius = \"30 mm\"\nelectrode_radius = \"10 mm\"\n[drive]\n"
                                        "voltage = \"1 kV\"\n[[step]]\nkind = \"voltage\"\n";
  const auto of = [&](const std::string& between, const std::string& along) {
    return refusal(disc + "[[quantity]]\nname = \"e\"\nkind = \"elongation\"\nbetween = " + between + along);
  };
  EXPECT_NE(of("[\"rim\", \"centre\"]", "").find("as drawn the two have one centroid"), std::string::npos);
  EXPECT_NE(of("[\"rim\", \"electrode_edge\"]", "\nalong = \"z\"").find("as drawn the two"),
            std::string::npos);
}

// A roll's end feels the film's tension; the node of the cap on which it ends has no film.
TEST_F(FilmValues, FilmPullsWhereItEnds) {
  const auto roll = [](const std::string& place) {
    return "[film]\nthickness = \"1 mm\"\nprestretch = [2, 1]\n[film.material]\nshear_modulus = \"40 "
           "kPa\"\nrelative_permittivity = 3\n"
           "[roll]\nlength = \"20 mm\"\nradius = \"5 mm\"\n[[body]]\nname = \"caps\"\n"
           "places = [\"lower_end\", \"upper_end\"]\nfix = [\"z\"]\n[[quantity]]\nname = \"pull\"\n"
           "kind = \"film force\"\nalong = \"z\"\nof = \"" +
           place + "\"\n[[step]]\nkind = \"release\"\n";
  };
  const double force = 2 * pi * 5e-3 * 1e-3 * 40e3 * (2 - std::pow(2, -3)); // over the unstretched section
  EXPECT_NEAR(run(roll("lower_end")).last("pull"), force, 1e-9 * force);
  EXPECT_NEAR(run(roll("upper_end")).last("pull"), -force, 1e-9 * force);
  EXPECT_EQ(refusal(roll("caps")),
            at(18, 6) + "quantity[1].of: no film meets this place, so none pulls on it");
}

// A diaphragm brings a quantity "drop"; who writes the same has it once, and may call the edge by its plate.
TEST_F(FilmValues, AStandardQuantityGivesWayToTheUsersOfItsNameAndKind) {
  const auto drop = [](const std::string& kind) {
    return "[[quantity]]\nname = \"drop\"\nkind = \"" + kind + "\"\nof = \"plate\"\n";
  };
  const Ran own = run(diaphragm("axisymmetric") + drop("displacement") + "along = \"gravity\"\n");
  const Ran standard = run(diaphragm("axisymmetric"));
  EXPECT_EQ(own.last("drop"), standard.last("drop"));
  EXPECT_EQ(own.values.at("drop").size(), own.time.size());
  EXPECT_NE(refusal(diaphragm("axisymmetric") + drop("radius")).find("\"drop\" is taken"), std::string::npos);
}

// A meridian may be drawn from outside to inside, or upright.
TEST_F(FilmValues, NominalStressIsAlongTheMeridian) {
  const auto stress = [](const std::string& place) {
    return fmt::format("[[quantity]]\nname = \"along\"\nkind = \"nominal stress\"\nof = \"{0}\"\nalong = "
                       "\"x\"\n[[quantity]]\nname = \"around\"\nkind = \"nominal stress\"\nof = \"{0}\"\n"
                       "along = \"y\"\n",
                       place);
  };
  for (const std::string model : {"axisymmetric", "planar", "3d"}) {
    const Ran ran = run(film(model) + "[disc]\nradius = \"30 mm\"\n" + stress("film"));
    for (const char* name : {"along", "around"})
      EXPECT_NEAR(ran.last(name), 40e3 * (2 - std::pow(2.0, -5)), 1e-6) << model << name;
  }
  const std::string roll =
      "[film]\nthickness = \"1 mm\"\nprestretch = [2, 1]\n[film.material]\nshear_modulus = "
      "\"40 kPa\"\nrelative_permittivity = 3\n[roll]\nlength = \"20 mm\"\nradius = \"5 "
      "mm\"\n[[body]]\nname = \"caps\"\nplaces = [\"lower_end\", \"upper_end\"]\nfix = "
      "[\"z\"]\n[[step]]\nkind = \"release\"\n";
  EXPECT_NEAR(run(roll + stress("upper_end")).last("along"), 40e3 * (2 - std::pow(2, -3)), 1e-6);
}

// A weight hangs on it: whatever the voltage does to the charged part, the section carries the weight.
TEST_F(FilmValues, NominalStressIsForceOverTheWholeSection) {
  const std::string material = "[film.material]\nshear_modulus = \"40 kPa\"\nrelative_permittivity = 3\n"
                               "density = 0\n";
  const std::string stack =
      "[film]\nthickness = \"0.1 mm\"\n" + material +
      "[strip]\nlength = \"20 mm\"\nwidth = \"10 mm\"\nlayers = 4\ncover_thickness = "
      "\"80 um\"\n[weight]\nmass = \"10 g\"\n[drive]\nvoltage = \"2 kV\"\n"
      "[output]\nfields = false\n"
      "[[quantity]]\nname = \"stress\"\nkind = \"nominal stress\"\nof = \"film\"\nalong = "
      "\"y\"\n";
  const double hung = 0.01 * 9.81 / (10e-3 * 0.56e-3);
  EXPECT_NEAR(run(stack).last("stress"), hung, 1e-6 * hung);
  const auto rod = [&](const std::string& to, const std::string& along, const std::string& force) {
    return "model = \"planar\"\n[film]\nthickness = \"0.1 mm\"\nprestretch = 1.2\n" + material +
           "[line]\nto = " + to +
           "\n[rod]\nwidth = \"100 mm\"\nlayers = 2\nelectrode_width = \"60 mm\"\n[[support]]\nplace = "
           "\"start\"\nfix = [\"x\", \"y\"]\n[[support]]\nplace = \"end\"\nfix = [\"" +
           (along == "x" ? "y" : "x") + "\"]\n[[load]]\nplace = \"end\"\nforce = " + force +
           "\n[drive]\nvoltage = \"1 kV\"\n[[step]]\nkind = \"force\"\n[[step]]\nkind = \"voltage\"\n"
           "[[quantity]]\nname = \"stress\"\nkind = \"nominal stress\"\nof = \"film\"\nalong = \"" +
           along + "\"\n";
  };
  const double pulled = 0.3 / (0.1e-3 * 100e-3 * 2);
  EXPECT_NEAR(run(rod("[\"24 mm\", 0, 0]", "x", "[\"0.3 N\", 0, 0]")).last("stress"), pulled, 1e-6 * pulled);
  EXPECT_NEAR(run(rod("[\"-24 mm\", 0, 0]", "x", "[\"-0.3 N\", 0, 0]")).last("stress"), pulled,
              1e-6 * pulled);
  const std::string upright = rod("[0, \"24 mm\", 0]", "y", "[0, \"0.3 N\", 0]");
  EXPECT_NEAR(run(upright).last("stress"), pulled, 1e-6 * pulled);
  std::string across = upright;
  across.replace(across.rfind("\"y\""), 3, "\"x\"");
  EXPECT_NE(refusal(across).find("found \"x\": a rod pulls along itself"), std::string::npos)
      << refusal(across);
}

// Two rods in series, tied: each end tells of the rod that it is named after.
TEST_F(FilmValues, AtATieCountTheFilmThatThePlaceIsNamedAfter) {
  std::string text = "model = \"planar\"\n[[tie]]\nbetween = [\"a.end\", \"b.start\"]\n";
  const auto part = [](const char* name, int from, int to, int modulus) {
    return fmt::format("[part.{0}.film]\nthickness = \"0.1 mm\"\nprestretch = 1.5\n[part.{0}.film.material]\n"
                       "shear_modulus = \"{3} kPa\"\nrelative_permittivity = 3\n[part.{0}.line]\nfrom = "
                       "[\"{1} mm\", 0, 0]\nto = [\"{2} mm\", 0, 0]\n[part.{0}.rod]\nwidth = \"10 mm\"\n",
                       name, from, to, modulus);
  };
  text += part("a", 0, 40, 50) + part("b", 40, 70, 30);
  for (const char* place : {"a.start", "b.end"})
    text += fmt::format("[[support]]\nplace = \"{}\"\nfix = [\"x\", \"y\"]\n", place);
  text +=
      "[[support]]\nplace = \"a.end\"\nfix = [\"y\"]\n[[load]]\nplace = \"a.end\"\nforce = [\"1 mN\", 0, 0]\n"
      "[[electrode]]\nname = \"b\"\nplace = \"b.film\"\n[drive.b]\nvoltage = \"1 kV\"\n[[step]]\nkind = "
      "\"voltage\"\n[[step]]\nkind = \"force\"\n";
  for (const std::string part_name : {"a", "b"})
    for (const std::string end : {"start", "end"})
      text += fmt::format(
          "[[quantity]]\nname = \"force_{0}_{1}\"\nkind = \"film force\"\nof = \"{0}.{1}\"\n"
          "along = \"x\"\n[[quantity]]\nname = \"stress_{0}_{1}\"\nkind = \"nominal stress\"\nof = "
          "\"{0}.{1}\"\nalong = \"x\"\n",
          part_name, end);
  const Ran ran = run(text);
  constexpr double section = 1e-6;
  for (const std::string part_name : {"a", "b"}) {
    const double force = ran.last("force_" + part_name + "_start");
    EXPECT_GT(force, 0);
    EXPECT_NEAR(ran.last("force_" + part_name + "_end"), -force, 1e-9 * force);
    for (const char* end : {"_start", "_end"})
      EXPECT_NEAR(ran.last("stress_" + part_name + end), force / section, 1e-6 * force / section);
  }
  EXPECT_NEAR(ran.last("force_a_start") - ran.last("force_b_start"), 1e-3, 1e-9); // the load between them
}

std::string free_ring(const std::string& part, const std::string& at) {
  const std::string head = part.empty() ? "" : "part." + part + ".", place = part.empty() ? "" : part + ".";
  std::string text = "model = \"planar\"\n";
  if (!part.empty()) text += fmt::format("[part.{}]\nat = {}\nturned = \"40 deg\"\n", part, at);
  text += fmt::format(
      "[{0}film]\nthickness = \"1 mm\"\nprestretch = 3\n[{0}film.material]\nshear_modulus = \"45 "
      "kPa\"\nrelative_permittivity = 4.5\n[{0}annulus]\ninner_radius = \"10 mm\"\nouter_radius = "
      "\"40 mm\"\n[{0}mesh]\nrings = 24\n[[support]]\nplace = \"{1}outer\"\nfix = [\"x\", \"y\"]\n"
      "[[step]]\nkind = \"release\"\n",
      head, place);
  for (const char* edge : {"inner", "outer"})
    text += fmt::format("[[quantity]]\nname = \"{0}\"\nkind = \"radial stretch\"\nof = \"{1}{0}\"\n", edge,
                        place);
  return text;
}

TEST_F(FilmValues, StretchesAlongTheRadiusAreAboutTheMiddleOfTheirPart) {
  const Ran one = run(free_ring("", "")), part = run(free_ring("a", "[\"100 mm\", \"-20 mm\", 0]"));
  EXPECT_NEAR(one.last("inner"), 0.4225,
              0.011); // free of stress along the radius: the root of its growth around
  for (const char* edge : {"inner", "outer"})
    EXPECT_NEAR(part.last(edge), one.last(edge), 1e-7 * one.last(edge)) << edge;
}

TEST_F(FilmValues, WhereTheStretchAlongTheRadiusJumpsThereIsNone) {
  for (const std::string model : {"axisymmetric", "planar"}) {
    const std::string disc = film(model) +
                             "[disc]\nradius = \"30 mm\"\nelectrode_radius = \"10 mm\"\n[drive]\n"
                             "voltage = \"1 kV\"\n[[step]]\nkind = \"voltage\"\n";
    const auto stretch = [&](const std::string& place) {
      return disc + "[[quantity]]\nname = \"s\"\nkind = \"radial stretch\"\nof = \"" + place + "\"\n";
    };
    EXPECT_NE(refusal(stretch("electrode_edge")).find("the edge of an electrode"), std::string::npos)
        << model;
    EXPECT_EQ(refusal(stretch("rim")), "") << model;
  }
}

// All solids are elements of one block, whatever their parts.
TEST_F(FilmValues, PullsOfSolidsAreThoseOfThePlacesOwnPart) {
  std::string text = "model = \"planar\"\n";
  for (const auto& [name, y] : {std::pair{"a", 0}, {"b", 4}})
    text += fmt::format(
        "[part.{0}]\nat = [0, \"{1} mm\", 0]\n[part.{0}.film]\nthickness = \"1 mm\"\nwidth = \"20 "
        "mm\"\n[part.{0}.film.material]\nshear_modulus = \"100 kPa\"\nrelative_permittivity = 3\n"
        "[part.{0}.slab]\nlength = \"10 mm\"\nheight = \"4 mm\"\n[part.{0}.mesh]\nacross = 3\n"
        "[[support]]\nplace = \"{0}.left\"\nfix = [\"x\"]\n",
        name, y);
  text += "[[tie]]\nbetween = [\"a.top\", \"b.bottom\"]\n[[support]]\nplace = \"a.bottom\"\nfix = [\"y\"]\n"
          "[[support]]\nplace = \"b.top\"\ndisplacement = { y = \"1 mm\" }\n[[step]]\nkind = \"move\"\n";
  for (const std::string place : {"a.bottom", "a.top", "b.bottom", "b.top"})
    text += fmt::format("[[quantity]]\nname = \"{}\"\nkind = \"film force\"\nof = \"{}\"\nalong = \"y\"\n",
                        place.substr(0, 1) + "_" + place.substr(2), place);
  const Ran ran = run(text);
  const double l = 1.125,
               pull = 100e3 * (l - std::pow(l, -3)) * 10e-3 * 20e-3; // free across, in plane strain
  EXPECT_NEAR(ran.last("a_bottom"), pull, 1e-6 * pull);
  EXPECT_NEAR(ran.last("a_top"), -pull, 1e-6 * pull);
  EXPECT_NEAR(ran.last("b_bottom"), pull, 1e-6 * pull);
  EXPECT_NEAR(ran.last("b_top"), -pull, 1e-6 * pull);
}

TEST_F(FilmValues, WhereTwoFilmsLieOnOneAnotherAPointTellsNoDisplacement) {
  const auto two = [](const std::string& at) {
    std::string text = "model = \"planar\"\n[part.a]\nat = " + at + "\n";
    for (const char* name : {"a", "b"})
      text += fmt::format(
          "[part.{0}.film]\nthickness = \"1 mm\"\nprestretch = 2\n[part.{0}.film.material]\nshear_modulus "
          "= \"45 kPa\"\nrelative_permittivity = 4.5\n[part.{0}.rectangle]\nlength = \"20 mm\"\n[part.{0}."
          "mesh]\nacross = 4\n[[support]]\nplace = \"{0}.frame\"\nfix = [\"x\", \"y\"]\n",
          name);
    return text + "[[step]]\nkind = \"release\"\n[[quantity]]\nname = \"u\"\nkind = \"displacement\"\n" +
           point(1e-3, 1e-3, 0) + "\n";
  };
  EXPECT_NE(refusal(two("[0, 0, 0]")).find("films of two parts lie on one another there"), std::string::npos);
  EXPECT_EQ(refusal(two("[0, 0, \"1 mm\"]")), "");
  EXPECT_EQ(refusal(two("[\"20 mm\", 0, 0]")), "");
}

// Films of different prestretch that are tied side by side: what a side of one has at its ends is of both,
// its prestretch its own part's. The forces balance: neo-Hookean, with the widths held.
TEST_F(FilmValues, StretchesOfTiedPartsAreThoseOfTheirOwnFilm) {
  const auto part = [](const std::string& name, const std::string& where, const std::string& prestretch,
                       const std::string& size) {
    return "[part." + name + "]\n" + where + "[part." + name +
           ".film]\nthickness = \"1 mm\"\nprestretch = " + prestretch + "\n[part." + name +
           ".film.material]\nshear_modulus = \"45 kPa\"\npermittivity = " + "\"4e-11 F/m\"\n[part." + name +
           ".patch]\n" + size + "mode = \"pure-shear\"\n";
  };
  const Ran ran = run(part("a", "", "[1.5, 2]", "length = \"10 mm\"\nwidth = \"6 mm\"\n") +
                      part("b", "at = [\"27 mm\", \"12 mm\", 0]\nturned = \"180 deg\"\n", "[2, 1.2]",
                           "length = \"6 mm\"\nwidth = \"10 mm\"\n") +
                      "[[tie]]\nbetween = [\"a.right\", \"b.right\"]\n[[step]]\nkind = \"release\"\n"
                      "[output]\nerror_estimate = false\nfields = false\n");
  EXPECT_NEAR(ran.last("a_stretch_y"), 2, 1e-9);
  EXPECT_NEAR(ran.last("b_stretch_y"), 1.2, 1e-9);
  const double a = ran.last("a_stretch_x"), b = ran.last("b_stretch_x");
  EXPECT_NEAR(10 * a + 6 * b, 27, 1e-8);
  const auto pull = [](double along, double across) {
    return along - 1 / (std::pow(along, 3) * across * across);
  };
  EXPECT_NEAR(6 * pull(a, 2), 10 * pull(b, 1.2), 1e-7);
}

// Clamped film that is all under voltage has nowhere to go: its tension falls everywhere alike.
TEST_F(FilmValues, ADiscWithoutARadiusOfItsElectrodeIsAllElectrode) {
  for (const std::string model : {"axisymmetric", "planar", "3d"}) {
    const std::string disc = film(model) + "[disc]\nradius = \"30 mm\"\n[drive]\nvoltage = \"2 kV\"\n";
    const Ran ran = run(disc + value("field", "electric_field", "place = \"rim\"") +
                        value("centre", "max_principal_stress", point(0, 0, 0)));
    const double permittivity = 4.7 * 8.8541878128e-12, field = 2e3 / (1e-3 / 4);
    EXPECT_NEAR(ran.last("field"), field, 1e-9 * field) << model;
    EXPECT_NEAR(ran.last("centre"), 40e3 * (4 - std::pow(4.0, -2)) - permittivity * field * field, 1e-3)
        << model;
    EXPECT_NEAR(ran.last("capacitance"), permittivity * pi * 9e-4 / (1e-3 / 4),
                1e-4 * ran.last("capacitance"));
    EXPECT_NEAR(ran.last("electrode_radius"), 30e-3, 1e-6) << model;
    EXPECT_NE(refusal(disc + value("outside", "slope", "place = \"passive\"")), "") << model;
  }
}

// A film of revolution moves, and is stressed, alike at every angle: along what its point says.
TEST_F(FilmValues, OfRevolutionTurnWithTheirPoint) {
  const auto off_the_half_plane = [&](const std::string& model) {
    return run(
        film(model) +
        "[disc]\nradius = \"90 mm\"\nelectrode_radius = \"30 mm\"\n[mesh]\nrings = 12\n"
        "[drive]\nvoltage = \"3 kV\"\n" +
        value("hoop", "cauchy_stress.xx", point(0, 40e-3, 0)) +
        "[[quantity]]\nname = \"beside\"\nkind = \"displacement\"\nalong = \"x\"\n" + point(0, 40e-3, 0) +
        "\n[[quantity]]\nname = \"back\"\nkind = \"displacement\"\nalong = \"x\"\n" + point(-40e-3, 0, 0));
  };
  const Ran turned = off_the_half_plane("axisymmetric"), flat = off_the_half_plane("planar");
  EXPECT_NEAR(turned.last("hoop"), flat.last("hoop"), 2e-3 * flat.last("hoop"));
  EXPECT_NEAR(turned.last("beside"), 0, 1e-12);
  EXPECT_LT(turned.last("back"), 0);
  EXPECT_NEAR(turned.last("back"), flat.last("back"), -2e-3 * flat.last("back"));
}

} // namespace
} // namespace dielast::cases::film_values_test
