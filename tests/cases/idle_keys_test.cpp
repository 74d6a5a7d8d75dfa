// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/reader.hpp"
#include "cases/readers/resolved.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace dielast::cases::idle_keys_test {
namespace {

const std::string film = R"(
[film]
thickness = "1 mm"
prestretch = 1.5
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
)";
const std::string disc = "[disc]\nradius = \"20 mm\"\nelectrode_radius = \"10 mm\"\n";
const std::string balloon =
    "[balloon]\nradius = \"20 mm\"\n[chamber]\npressure = \"500 Pa\"\nvolume = \"50 ml\"\n";
const std::string diaphragm =
    "[annulus]\ninner_radius = \"12 mm\"\nouter_radius = \"68 mm\"\n[plate]\nmass = \"100 g\"\n";
const std::string massless = diaphragm.substr(0, diaphragm.find("100 g")) + "0 g\"\n";
const std::string strip = "[strip]\nlength = \"20 mm\"\nwidth = \"10 mm\"\n[weight]\nmass = \"50 g\"\n";
const std::string ramp = "[[step]]\nkind = \"voltage\"\n";
const std::string transient = "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\n";

/// Keys that a case is warned of, in the order of the warnings.
class IdleKeys : public test::ScratchTest {
 protected:
  std::vector<std::string> keys(const std::string& text, const std::vector<std::string>& overrides = {}) {
    write("case.toml", text);
    std::vector<std::string> found;
    for (const Diagnostic& warning : read_case(directory / "case.toml", overrides).warnings) {
      EXPECT_EQ(warning.severity, Severity::warning);
      EXPECT_NE(warning.message.find("here"), std::string::npos) << warning.message;
      EXPECT_NE(warning.text().find(": warning: "), std::string::npos) << warning.text();
      found.push_back(warning.key);
    }
    return found;
  }
};

using Keys = std::vector<std::string>;

// A pair of cases for each condition: the key does nothing in the first and something in the second.
TEST_F(IdleKeys, AreToldWhereTheyDoNothingAndOnlyThere) {
  struct Pair {
    std::string key, idle, acting;
  };
  const std::string branch =
      "[[film.material.branch]]\nshear_modulus = \"1 kPa\"\nrelaxation_time = \"1 s\"\n";
  const std::string instantaneous = "[[step]]\nkind = \"voltage\"\nresponse = \"instantaneous\"\n";
  const std::string drive = "[drive]\nvoltage = \"1 kV\"\n";
  const auto patch = [](const std::string& name) {
    return fmt::format(
        "[part.{0}.film]\nthickness = \"1 mm\"\n[part.{0}.film.material]\nshear_modulus = 1e4\n"
        "relative_permittivity = 3\nbreakdown_field = 5e7\n[part.{0}.patch]\n",
        name);
  };
  const std::string two_patches = patch("a") + patch("b");
  const std::string sectors = "[disc]\nradius = \"20 mm\"\n[sectors]\ncount = 2\n";
  const std::string weight = "[[step]]\nkind = \"weight\"\n";
  const std::string point_mass = "[[point_mass]]\nplace = \"electrode\"\nmass = \"1 g\"\n";
  const std::string inflate = "[[step]]\nkind = \"inflate\"\n", pressure = "[[step]]\nkind = \"pressure\"\n";
  const std::string charged_hold = "[[step]]\nkind = \"hold\"\nduration = \"1 s\"\ncontrol = \"charge\"\n";
  const std::string breathes = // from 0
      "[chamber]\nvolume = { wave = \"unipolar sine\", amplitude = \"1 ml\", frequency = \"1 Hz\" }\n";
  const auto slab = [](const std::string& keys, const std::string& law) {
    return "model = \"planar\"\n[film]\nthickness = \"0.1 mm\"\n" + keys +
           "[film.material]\npermittivity = \"4e-11 F/m\"\n" + law +
           "[slab]\nlength = \"4 mm\"\nheight = \"1 mm\"\n";
  };
  const std::string neo_hookean = "shear_modulus = \"40 kPa\"\n", bulk = "bulk_modulus = \"10 kPa\"\n",
                    stacked = "stacked_along = \"x\"\n";
  const std::string honeycomb =
      "[honeycomb]\nangle = \"150 deg\"\nwall_length = \"8 mm\"\nwall_width = \"1 mm\"\nwall_height = \"2 "
      "mm\"\n"
      "[honeycomb.wall_material]\nyoungs_modulus = \"80 MPa\"\npoisson_ratio = 0.4\ndensity = 1000\n";
  const std::string plate_on_slab =
      "model = \"axisymmetric\"\n" + film.substr(0, film.find("prestretch")) +
      film.substr(film.find("[film.m")) +
      "[slab]\nlength = \"5 mm\"\nheight = \"2 mm\"\n[plate]\nmass = \"50 g\"\nat = \"top\"\n"
      "[[support]]\nplace = \"bottom\"\nfix = [\"z\"]\n";
  const auto layered = [](const std::string& charged, const std::string& of_film,
                          const std::string& of_layer) {
    return "model = \"3d\"\n" + film.substr(0, film.find("[film.m")) + "section = \"shell\"\n" +
           film.substr(film.find("[film.m")) + of_film +
           "[[film.layer]]\nname = \"above\"\nthickness = \"1 mm\"\n[film.layer.material]\nshear_modulus = "
           "\"40 kPa\"\npermittivity = \"4e-11 F/m\"\n" +
           of_layer + "[rectangle]\nlength = \"20 mm\"\nwidth = \"10 mm\"\n[[electrode]]\nname = \"e\"\n" +
           "place = \"film\"\n" + charged;
  };
  const std::string above = "layer = \"above\"\n", breaks = "breakdown_field = \"60 MV/m\"\n";
  const std::vector<Pair> pairs{
      {"film.material.breakdown_field", layered(above, breaks, ""), layered("", breaks, "")},
      {"film.layer[1].material.breakdown_field", layered("", "", breaks), layered(above, "", breaks)},
      {"gravity.film",
       "model = \"3d\"\n" + film + "density = 0\n" + disc + "[gravity]\nfilm = true\n" + weight,
       "model = \"3d\"\n" + film + disc + "[gravity]\nfilm = true\n" + weight},
      {"output.margins_up_to", film + balloon + "[output]\nmargins_up_to = 2\n" + inflate,
       film + disc + "[output]\nmargins_up_to = 2\n" + ramp},
      {"output.margins_up_to", film + disc + "[output]\nmargins_up_to = 2\n" + ramp + "duration = \"1 s\"\n",
       film + disc + "[output]\nmargins_up_to = 2\n" + ramp},
      {"film.bulk_modulus",
       slab(bulk, "law = \"st-venant-kirchhoff\"\nyoungs_modulus = \"120 kPa\"\npoisson_ratio = 0.4\n"),
       slab(bulk, neo_hookean)},
      {"film.stacked_along",
       slab("field = \"potential\"\n" + stacked, neo_hookean) +
           "[[electrode]]\nname = \"e\"\nplace = \"top\"\nground = \"bottom\"\n",
       slab(stacked, neo_hookean)},
      {"film.material.branch[1]", film + branch + disc, film + branch + disc + instantaneous},
      {"film.material.branch[1]", film + branch + disc + ramp, film + branch + disc + transient},
      {"step[1].response", film + disc + instantaneous, film + branch + disc + instantaneous},
      {"point_mass[1]", film + disc + point_mass, film + disc + point_mass + "[[step]]\nkind = \"modes\"\n"},
      {"point_mass[1]", film + disc + point_mass + transient + "inertia = false\n",
       film + disc + point_mass + transient},
      {"plate.mass", plate_on_slab + ramp, plate_on_slab + weight + ramp},
      {"weight.mass", film + strip + ramp, film + strip + weight + ramp},
      {"film.material.density", film + "density = \"1000 kg/m^3\"\n" + disc,
       film + "density = \"1000 kg/m^3\"\n" + disc + transient + "inertia = true\n"},
      {"honeycomb.wall_material.density", film + honeycomb,
       film + honeycomb + "[[step]]\nkind = \"modes\"\n"},
      {"quantity[1]",
       film + honeycomb +
           "[[quantity]]\nname = \"k\"\nkind = \"stiffness\"\nof = \"left_apex\"\nalong = \"x\"\n",
       film + disc + "[[quantity]]\nname = \"k\"\nkind = \"stiffness\"\nof = \"centre\"\nalong = \"x\"\n"},
      {"film.material.electrostriction",
       film + "electrostriction = 0.1\n" + balloon + inflate + "[[step]]\nkind = \"pressure\"\n",
       film + "electrostriction = 0.1\n" + disc},
      {"mesh.quadrature", film + disc + "[mesh]\norder = 1\nquadrature = 3\n",
       film + disc + "[mesh]\nquadrature = 3\n"},
      {"electrode[1].sheet_resistance",
       film + disc +
           "[[electrode]]\nname = \"e\"\nplace = \"electrode\"\nsheet_resistance = 1e5\nterminal = "
           "\"electrode_edge\"\n",
       film + disc + transient +
           "[[electrode]]\nname = \"e\"\nplace = \"electrode\"\nsheet_resistance = 1e5\nterminal = "
           "\"electrode_edge\"\n"},
      {"electrode[1].sheet_resistance",
       film + disc +
           "[[electrode]]\nname = \"e\"\nplace = \"electrode\"\nsheet_resistance = 1e5\nterminal = "
           "\"electrode_edge\"\n[circuit]\nresistance = 1e6\n",
       film + disc +
           "[[electrode]]\nname = \"e\"\nplace = \"electrode\"\nsheet_resistance = 1e5\nterminal = "
           "\"electrode_edge\"\n[circuit]\nresistance = 1e6\nleakage_resistance = 1e9\n"},
      {"gravity.direction", "model = \"3d\"\n" + film + disc + "[gravity]\ndirection = [1, 0, 0]\n" + ramp,
       "model = \"3d\"\n" + film + disc + "[gravity]\ndirection = [1, 0, 0]\n" + ramp +
           "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\nof = \"centre\"\nalong = \"gravity\"\n"},
      {"circuit", film + disc + drive + "[circuit]\nresistance = 1e6\n",
       film + disc + drive + "[circuit]\nresistance = 1e6\nleakage_resistance = 1e9\n"},
      {"circuit.current_limit",
       film + disc + drive + "[circuit]\nresistance = 1e6\ncurrent_limit = 1e-3\n" + ramp +
           "[[step]]\nkind = \"harmonic\"\n",
       film + disc + drive + "[circuit]\nresistance = 1e6\ncurrent_limit = 1e-3\n" + transient},
      {"step[1]",
       film + disc + "[drive]\ncharge = 1e-9\n[circuit]\nresistance = 1e6\nleakage_resistance = 1e9\n" +
           transient + "control = \"charge\"\n",
       film + disc + "[drive]\ncharge = 1e-9\n[circuit]\nresistance = 1e6\n" + transient +
           "control = \"charge\"\n"},
      {"plate.damping", film + diaphragm + "damping = 1\n" + weight,
       film + diaphragm + "damping = 1\n" + weight + transient},
      {"plate.damping", film + "density = 0\n" + massless + "damping = 1\n" + transient + "inertia = true\n",
       film + diaphragm + "damping = 1\n" + transient + "inertia = true\n"},
      {"gravity.acceleration", "model = \"3d\"\n" + film + disc + "[gravity]\nacceleration = 1.6\n" + ramp,
       "model = \"3d\"\n" + film + disc + "[gravity]\nacceleration = 1.6\nfilm = true\n" + weight},
      {"chamber.pressure", film + balloon + inflate,
       film + balloon + "[[step]]\nkind = \"pressure\"\n" + inflate},
      {"chamber.volume", film + balloon + "[[step]]\nkind = \"pressure\"\n",
       film + balloon + "[[step]]\nkind = \"pressure\"\n" + inflate},
      {"chamber.volume", film + diaphragm + breathes + weight + transient,
       film + diaphragm + breathes + weight + inflate + transient},
      {"chamber.volume",
       film + diaphragm + breathes + weight + transient + "[[step]]\nkind = \"inflate\"\nto = 0\n",
       film + diaphragm + breathes + weight + "[[step]]\nkind = \"inflate\"\nto = 0\n" + transient},
      {"chamber.bulk_modulus",
       film +
           "[balloon]\nradius = \"20 mm\"\n[chamber]\npressure = 500\nbulk_modulus = 1e6\n[[step]]\nkind = "
           "\"pressure\"\n",
       film + "[balloon]\nradius = \"20 mm\"\n[chamber]\nvolume = \"50 ml\"\nbulk_modulus = 1e6\n" + inflate},
      {"chamber.bulk_modulus",
       film + "[balloon]\nradius = \"20 mm\"\n[chamber]\npressure = 500\nbulk_modulus = 1e6\n" + pressure,
       film + "[balloon]\nradius = \"20 mm\"\n[chamber]\npressure = 500\nbulk_modulus = 1e6\n" + pressure +
           "[[quantity]]\nname = \"Q\"\nkind = \"pumped volume\"\n"},
      {"chamber.volume",
       film + balloon + "[[step]]\nkind = \"inflate\"\nto = \"50 ml\"\n" + pressure + transient,
       film + balloon + "[[step]]\nkind = \"inflate\"\nto = \"50 ml\"\n" + transient},
      {"chamber.pressure", film + balloon + pressure + "to = \"500 Pa\"\n" + inflate + transient,
       film + balloon + inflate + pressure + "to = \"500 Pa\"\n" + transient},
      {"drive.voltage", film + disc + drive + ramp + "to = \"1 kV\"\n",
       film + disc + drive + ramp + "to = \"1 kV\"\n[[step]]\nkind = \"harmonic\"\n"},
      {"drive.a.voltage",
       film + sectors + "[drive.a]\nvoltage = 1000\n[drive.b]\nvoltage = 900\n" + ramp +
           "electrode = \"b\"\n",
       film + sectors + "[drive.a]\nvoltage = 1000\n[drive.b]\nvoltage = 900\n" + ramp},
      {"part.b.film.material.breakdown_field",
       two_patches + "[[electrode]]\nname = \"e\"\nplace = \"a.film\"\n",
       two_patches + "[[electrode]]\nname = \"e\"\nplace = \"b.film\"\n"},
      {"drive.b.charge",
       film + sectors + "[drive.b]\ncharge = 1e-9\n[[step]]\nkind = \"charge\"\nto = 2e-9\n",
       film + sectors + "[drive.b]\ncharge = 1e-9\n[[step]]\nkind = \"charge\"\nelectrode = \"b\"\n"},
      {"quantity[1].along",
       "model = \"axisymmetric\"\n" + film + disc +
           "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\npoint = [0.01, 0, 0]\nalong = \"y\"\n",
       "model = \"axisymmetric\"\n" + film + disc +
           "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\npoint = [0, 0.01, 0]\nalong = \"y\"\n"},
      {"drive.voltage", "model = \"3d\"\n" + film + disc + drive + weight + "[gravity]\nfilm = true\n",
       film + disc + drive},
      {"step[1].control",
       film + balloon +
           "[[step]]\nkind = \"inflate\"\ncontrol = \"charge\"\n[[step]]\nkind = "
           "\"pressure\"\n",
       film + disc + charged_hold},
      {"step[1].inertia", film + "density = 0\n" + disc + transient + "inertia = true\n",
       film + disc + transient + "inertia = true\n"},
      {"step[1].on_bifurcation", film + disc + transient + "on_bifurcation = \"switch\"\n",
       film + disc + ramp + "on_bifurcation = \"switch\"\n"},
      {"solver.time_tolerance", film + disc + ramp + "[solver]\ntime_tolerance = 1e-8\n",
       film + branch + disc + transient + "[solver]\ntime_tolerance = 1e-8\n"},
      {"quantity[1].along",
       film + disc + "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\nof = \"centre\"\nalong = \"z\"\n",
       film + disc + "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\nof = \"centre\"\nalong = \"y\"\n"},
      {"quantity[1]", film + disc + "[[quantity]]\nname = \"i\"\nkind = \"current\"\nof = \"film\"\n",
       film + disc + transient +
           "[circuit]\nresistance = 1e6\n[[quantity]]\nname = \"i\"\nkind = \"current\"\nof = "
           "\"film\"\n"},
      {"drive.voltage",
       film + disc + transient + "[drive]\nvoltage = { wave = \"step\", to = \"1 kV\", at = \"2 s\" }\n",
       film + disc + transient + "[drive]\nvoltage = { wave = \"step\", to = \"1 kV\", at = \"0.5 s\" }\n"},
  };
  for (const Pair& pair : pairs) {
    const auto contains = [&](const Keys& all) { return std::ranges::find(all, pair.key) != all.end(); };
    try {
      const Keys idle = keys(pair.idle);
      EXPECT_TRUE(contains(idle)) << pair.key << " of\n" << pair.idle << testing::PrintToString(idle);
      EXPECT_FALSE(contains(keys(pair.acting))) << pair.key << " of\n" << pair.acting;
    } catch (const CaseError& error) {
      ADD_FAILURE() << pair.key << ": " << error.what();
    }
  }
}

// Gravity that is written pulls at film and bars only where it says so.
TEST_F(IdleKeys, WeightThatIsLeftOutIsTold) {
  const std::string weighed =
      film + diaphragm + "[[step]]\nkind = \"weight\"\n[gravity]\nacceleration = 1.6\n";
  EXPECT_EQ(keys(weighed), Keys{"gravity"});
  EXPECT_EQ(keys(weighed + "film = true\n"), Keys{});
  EXPECT_EQ(keys(weighed + "film = false\n"), Keys{});
  EXPECT_EQ(keys(weighed, {"film.material.density=0"}), Keys{});
}

// Stresses hold no prestretch, which branches would remember.
TEST_F(IdleKeys, PrestretchThatIsLetGoIsTold) {
  const std::string flows =
      "[[film.material.branch]]\nshear_modulus = \"50 kPa\"\nrelaxation_time = \"2 s\"\n";
  const std::string patch = "[patch]\nlength = \"10 mm\"\nmode = \"equal-biaxial\"\nstress_x = \"55 kPa\"\n";
  const std::string at_once = "[[step]]\nkind = \"force\"\nresponse = \"instantaneous\"\n";
  EXPECT_EQ(keys(film + flows + patch + at_once), Keys{"patch.stress_x"});
  EXPECT_EQ(keys(film + flows + patch + "[[step]]\nkind = \"release\"\n" + at_once), Keys{});
  EXPECT_EQ(keys(film + flows + patch), Keys{"film.material.branch[1]"}); // relaxed: all the same
  EXPECT_EQ(keys(film + flows + patch + at_once, {"film.prestretch=1"}), Keys{});
  const std::string flows_behind = "[[step]]\nkind = \"hold\"\nduration = \"1 s\"\n";
  EXPECT_EQ(keys(film + flows + patch + "[[step]]\nkind = \"force\"\n" + flows_behind), Keys{}); // as advised
}

TEST_F(IdleKeys, SayingTheDefaultIsNoMistake) {
  EXPECT_EQ(keys(film + disc + ramp + "response = \"relaxed\"\n[solver]\ntime_tolerance = 1e-6\n"), Keys{});
  EXPECT_EQ(keys(film + disc + "[gravity]\nfilm = false\n"), Keys{});
  EXPECT_EQ(
      keys(film +
           "[patch]\nmode = \"equal-biaxial\"\nlength = \"10 mm\"\nwidth = \"0.3937007874015748 inch\"\n" +
           ramp),
      Keys{});
}

TEST_F(IdleKeys, AreToldAfterSetAsWell) {
  EXPECT_EQ(keys(film + disc, {"solver.time_tolerance=1e-8"}), Keys{"solver.time_tolerance"});
}

// What a resolved case repeats, defaults included, is no other case.
TEST_F(IdleKeys, OfAResolvedCaseAreThoseOfTheCase) {
  const std::string text = film + disc + ramp + "[solver]\ntime_tolerance = 1e-8\n";
  EXPECT_EQ(keys(text), Keys{"solver.time_tolerance"});
  EXPECT_EQ(keys(resolved_text(read_case(directory / "case.toml"))), Keys{"solver.time_tolerance"});
}

// A standard stroke counts since the weight: with the weight behind the voltage it is 0 at the end.
TEST_F(IdleKeys, QuantitiesThatCountFromTheLastStepAreTold) {
  const std::string strip = film + "[strip]\nlength = \"60 mm\"\nwidth = \"60 mm\"\n[weight]\nmass = \"20 "
                                   "g\"\n[drive]\nvoltage = \"2 kV\"\n";
  const std::string weight = "[[step]]\nkind = \"weight\"\n", modes = "[[step]]\nkind = \"modes\"\n";
  EXPECT_EQ(keys(strip + ramp + weight), Keys{"step[2]"});
  EXPECT_EQ(keys(strip + ramp + weight + modes), Keys{"step[2]"});
  EXPECT_EQ(keys(strip + weight + ramp), Keys{});
  EXPECT_EQ(keys(strip + weight), Keys{"drive.voltage"});
}

TEST_F(IdleKeys, AToleranceBeyondTheValue) {
  const auto check = [&](const std::string& value, const std::string& tolerance) {
    return keys(film + disc + ramp + "[[check]]\nquantity = \"electrical_work\"\nvalue = " + value +
                "\ntolerance = " + tolerance + "\nsource = \"a paper\"\n");
  };
  EXPECT_EQ(check("97e-9", "0.01"), Keys{"check[1].tolerance"});
  EXPECT_EQ(check("97e-9", "\"1 %\""), Keys{});
  EXPECT_EQ(check("0", "0.01"), Keys{});
}

TEST_F(IdleKeys, RowsThatAStepLeavesBehindAreTold) {
  const std::string drive = "[drive]\nvoltage = { wave = \"file\", file = \"w.csv\" }\n";
  write("w.csv", "time_s,voltage_kV\n0,0\n0.5,4\n1,1\n");
  EXPECT_EQ(keys(film + disc + drive + transient), Keys{});
  write("w.csv", "time_s,voltage_kV\n0,0\n0.5,4\n");
  EXPECT_EQ(keys(film + disc + drive + transient), Keys{"drive.voltage"});
  write("w.csv", "time_s,voltage_kV\n0.1,0\n0.5,4\n");
  EXPECT_EQ(keys(film + disc + drive + transient), (Keys{"drive.voltage", "drive.voltage"}));
}

TEST_F(IdleKeys, AMeanOverNoTimeHasNoEffect) {
  const auto mean = [](const char* since) {
    return std::string("[[quantity]]\nname = \"m\"\nkind = \"mean\"\nof = \"capacitance\"\n") + since;
  };
  const std::string drive = "[drive]\nvoltage = \"1 kV\"\n";
  const std::string hold = "[[step]]\nkind = \"hold\"\nduration = \"1 s\"\n";
  write("mean.toml", film + disc + drive + ramp + mean(""));
  const auto warnings = read_case(directory / "mean.toml").warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].key, "quantity[1]");
  EXPECT_NE(warnings[0].message.find("no time passes"), std::string::npos) << warnings[0].message;
  for (const auto& [steps, since] : {std::pair{ramp + hold, ""}, {ramp + hold, "since = \"voltage\"\n"}}) {
    write("mean.toml", film + disc + drive + steps + mean(since));
    for (const Diagnostic& warning : read_case(directory / "mean.toml").warnings)
      EXPECT_EQ(warning.message.find("no time passes"), std::string::npos) << warning.message;
  }
  write("mean.toml", film + disc + drive + ramp + hold + mean("since = \"hold\"\n"));
  EXPECT_NE(read_case(directory / "mean.toml").warnings.at(0).message.find("behind step \"hold\""),
            std::string::npos);
}

// Nothing creeps, but the support's forces go.
TEST_F(IdleKeys, AStepThatLetsASupportGoHasAnEffect) {
  const std::string relax = "[[step]]\nkind = \"relax\"\n";
  const auto held = [](const char* until) {
    return std::string("[[support]]\nplace = \"rim\"\nfix = [\"x\", \"y\", \"z\"]\n[[support]]\nplace = "
                       "\"electrode\"\nfix = [\"x\", \"y\"]\n") +
           until;
  };
  EXPECT_EQ(keys(film + disc + ramp + relax + held("")), Keys{"step[2]"});
  EXPECT_EQ(keys(film + disc + ramp + relax + held("until = \"voltage\"\n")), Keys{});
}

TEST_F(IdleKeys, AVoltageThatIsThereAlready) {
  const std::string to = "[[step]]\nkind = \"voltage\"\nto = \"2 kV\"\n";
  const std::string back = "[[step]]\nname = \"back\"\nkind = \"voltage\"\nto = \"0 V\"\n";
  const std::string shorted =
      "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\n[drive]\nvoltage = { wave = \"sine\", amplitude = "
      "\"1 kV\", frequency = \"1 Hz\" }\n";
  const auto named = [](std::string step, const std::string& name) {
    return step + "name = \"" + name + "\"\n";
  };
  EXPECT_EQ(keys(film + disc + to + named(to, "again")), Keys{"step[2]"});
  EXPECT_EQ(keys(film + disc + to + back + named(to, "again")), Keys{});
  EXPECT_EQ(keys(film + disc + to + "[[step]]\nkind = \"release\"\n" + named(to, "again")), Keys{"step[3]"});
  EXPECT_EQ(keys(film + disc + to + shorted + named(to, "again")), Keys{});
}

TEST_F(IdleKeys, TheGalleryHasNone) {
  int cases = 0;
  for (const char* folder : {"cases/gallery", "tests/cases/valid"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_folder / folder)) {
      if (entry.path().extension() != ".toml") continue;
      const std::string text = test::text_of(entry.path());
      if (text.find("[fit]") != std::string::npos || text.find("[study]") != std::string::npos ||
          text.find("[identify]") != std::string::npos || text.find("[[rational]]") != std::string::npos)
        continue;
      ++cases;
      for (const Diagnostic& warning : read_case(entry.path()).warnings) ADD_FAILURE() << warning.text();
    }
  EXPECT_GT(cases, 50);
}

} // namespace
} // namespace dielast::cases::idle_keys_test
