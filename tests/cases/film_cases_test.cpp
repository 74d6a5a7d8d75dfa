// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/film_cases.hpp"

#include <cmath>

// Chambers, slack and wrinkled films, through case files.

namespace dielast::cases::film_cases_test {
namespace {

const std::string plain = "[output]\nfields = false\nerror_estimate = false\n";

std::string tension_field(const std::string& law, const std::string& prestretch = "1") {
  return fmt::format("[film]\nthickness = \"1 mm\"\nprestretch = {}\nwrinkling = \"tension field\"\n"
                     "[film.material]\n{}permittivity = \"4e-11 F/m\"\n",
                     prestretch, law);
}

// The charges as drawn were asked for before there was a history of the branches.
TEST_F(FilmCases, a_tension_field_may_have_branches) {
  for (const std::string& law : laws(50))
    for (const std::string& branch : laws(20))
      for (const char* geometry :
           {"[patch]\nstretch_x = 1.4\n", "[disc]\nradius = \"20 mm\"\nelectrode_radius = \"9 mm\"\n"
                                          "[mesh]\nrings = 2\n[drive]\nvoltage = \"1 kV\"\n"}) {
        const Ran ran = run(tension_field(law, "1.2") + "[[film.material.branch]]\n" + branch +
                            "relaxation_time = \"1 s\"\n" + geometry + plain);
        EXPECT_GT(ran.last("capacitance"), 0);
      }
}

// Own integration of the ring of film beside an electrode that has gone slack: where film may leave its
// plane, too, the trace of compression that slack film keeps is no instability (runs ended at 9.98 kV).
TEST_F(FilmCases, a_film_goes_on_where_its_electrode_is_slack) {
  for (const char* model : {"axisymmetric", "planar", "3d"}) {
    const Ran ran =
        run(fmt::format("model = \"{}\"\n[film]\nthickness = \"0.5 mm\"\nprestretch = 1.06\n"
                        "wrinkling = \"tension field\"\n[film.material]\nshear_modulus = \"40 kPa\"\n"
                        "relative_permittivity = 4.7\n[disc]\nradius = \"60 mm\"\n"
                        "electrode_radius = \"30 mm\"\n[mesh]\nrings = 6\n[drive]\n"
                        "voltage = \"10.5 kV\"\n",
                        model) +
            plain);
    EXPECT_NEAR(ran.last("electrode_radius"), 32.1547e-3, 1e-4 * 32e-3) << model;
    EXPECT_NEAR(ran.last("capacitance"), 423.92e-12, 1e-3 * 423.92e-12) << model;
  }
}

// An inflated balloon whose poles a spring holds apart: in tension, however stiff the spring.
TEST_F(FilmCases, film_in_tension_is_not_slack_beside_a_stiff_spring) {
  for (const char* stiffness : {"1e3 N/m", "1e9 N/m"}) {
    write("film.toml",
          fmt::format("model = \"axisymmetric\"\n[film]\nthickness = \"10 um\"\n[film.material]\n"
                      "shear_modulus = \"40 kPa\"\nrelative_permittivity = 3\n[balloon]\nradius = \"10 "
                      "mm\"\n[chamber]\n"
                      "pressure = \"1 kPa\"\n[[spring]]\nbetween = [\"south\", \"north\"]\nalong = \"z\"\n"
                      "free_length = \"20 mm\"\nstiffness = \"{}\"\n[[step]]\nkind = \"pressure\"\n",
                      stiffness));
    const Case one = read_case(directory / "film.toml");
    EXPECT_EQ(Simulation(one, 1).run({}).kind, "limit point") << stiffness;
  }
}

// A side without stress is neither taut nor wrinkled: next to it the tangent of wrinkled film leads far off.
TEST_F(FilmCases, a_slack_patch_can_be_pulled) {
  const double stress = 20e3, mu = 50e3;
  for (const std::string& law : laws(50)) {
    const Ran ran = run(tension_field(law, "[1.5, 1.1]") +
                        "[patch]\nstress_x = \"20 kPa\"\n[drive]\nvoltage = \"1 kV\"\n"
                        "[[step]]\nkind = \"voltage\"\n[[step]]\nkind = \"force\"\n" +
                        plain);
    EXPECT_NEAR(ran.last("stress_x"), stress, 1e-6 * stress);
    EXPECT_NEAR(ran.last("stress_y"), 0, 1e-6 * stress);
  }
  // without a field in closed form: s = mu (l - 1/l^2)
  for (const char* prestretch : {"1", "1.2", "[1.3, 1.1]"}) {
    const Ran ran = run(
        tension_field(laws(50).front(), prestretch) + "[patch]\nstress_x = \"20 kPa\"\n" + plain +
        "[[quantity]]\nname = \"lost\"\nkind = \"extreme\"\nof = \"tension_state\"\nextreme = \"maximum\"\n");
    for (const double lost : ran.values.at("lost"))
      EXPECT_EQ(lost, 0) << prestretch; // by rounding, now and then
    const double l = ran.last("stretch_x");
    EXPECT_NEAR(mu * (l - 1 / (l * l)), stress, 1e-6 * stress) << prestretch;
    EXPECT_NEAR(ran.last("stretch_y"), 1 / std::sqrt(l), 1e-6) << prestretch;
  }
}

std::string disc(const std::string& chamber, const std::string& steps, const std::string& rest = "") {
  return "[film]\nthickness = \"1 mm\"\n[film.material]\nlaw = \"neo-hookean\"\nshear_modulus = \"40 kPa\"\n"
         "permittivity = \"4e-11 F/m\"\n[disc]\nradius = \"20 mm\"\nelectrode_radius = \"10 mm\"\n"
         "[chamber]\n" +
         chamber + steps + rest + plain +
         "[[quantity]]\nname = \"height\"\nkind = \"displacement\"\nof = \"centre\"\nalong = \"z\"\n"
         "[[quantity]]\nname = \"pumped\"\nkind = \"pumped volume\"\n";
}

// With the default liquid, hardly compressible, from flat, in any number of increments.
TEST_F(FilmCases, a_flat_disc_can_be_pumped_past_its_greatest_pressure) {
  double height = 0;
  for (const int increments : {40, 10, 3, 1}) {
    const Ran ran = run(disc("volume = \"50 ml\"\n",
                             fmt::format("[[step]]\nkind = \"inflate\"\nincrements = {}\n", increments),
                             "[mesh]\nrings = 24\n"));
    EXPECT_NEAR(ran.last("pumped"), 50e-6, 1e-15);
    EXPECT_NEAR(ran.last("volume"), 50e-6, 50e-6 * 4e3 / 2.2e9);
    if (increments == 40) {
      height = ran.last("height");
      const auto& pressure = ran.values.at("pressure");
      EXPECT_GT(*std::max_element(pressure.begin(), pressure.end()), 1.05 * pressure.back());
    }
    EXPECT_NEAR(ran.last("height"), height, 1e-7 * height) << increments;
  }
  EXPECT_GT(height, 35e-3);
}

// What is pumped in is the chamber's volume times 1 + p/K, and `volume` is the chamber's under any control.
TEST_F(FilmCases, a_soft_filling_gives_way_by_its_own_volume) {
  const std::string chamber = "bulk_modulus = \"100 kPa\"\nvolume = \"5 ml\"\n";
  const std::string steps = "[[step]]\nkind = \"inflate\"\n", rings = "[mesh]\nrings = 8\n";
  const Ran pumped = run(disc(chamber, steps, rings));
  const double p = pumped.last("pressure");
  EXPECT_GT(p, 500);
  EXPECT_NEAR(pumped.last("volume") * (1 + p / 100e3), 5e-6, 1e-14);
  const Ran pressed = run(disc(fmt::format("bulk_modulus = \"100 kPa\"\npressure = \"{:.17g} Pa\"\n", p),
                               "[[step]]\nkind = \"pressure\"\n", rings));
  EXPECT_NEAR(pressed.last("volume"), pumped.last("volume"), 1e-8 * 5e-6);
  EXPECT_NEAR(pressed.last("pumped"), 5e-6, 1e-8 * 5e-6);
  EXPECT_NEAR(pressed.last("height"), pumped.last("height"), 1e-9);
  const Ran space = run("model = \"3d\"\n" + disc(chamber, steps, rings));
  EXPECT_NEAR(space.last("height"), pumped.last("height"), 2e-3 * pumped.last("height"));
  EXPECT_NEAR(space.last("pressure"), p, 2e-3 * p);
}

// A pressure has no potential where a film's edge moves along x and z: it is refused, in space likewise.
// Edges in a plane of symmetry, those in the plane z = 0, and those of a plate are none of these.
TEST_F(FilmCases, a_free_edge_is_refused_under_pressure) {
  const auto pressed = [](const std::string& model, const std::string& geometry, const std::string& rest) {
    return "model = \"" + model +
           "\"\n[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = \"40 kPa\"\n"
           "permittivity = \"4e-11 F/m\"\n" +
           geometry + "[chamber]\npressure = \"100 Pa\"\n[[step]]\nkind = \"pressure\"\n" + rest;
  };
  const auto held = [](const std::string& place, const std::string& axes, const std::string& more = "") {
    return "[[support]]\nplace = \"" + place + "\"\nfix = [" + axes + "]\n" + more;
  };
  const std::string annulus = "[annulus]\ninner_radius = \"5 mm\"\nouter_radius = \"20 mm\"\n",
                    sheet = "[rectangle]\nlength = \"20 mm\"\nwidth = \"10 mm\"\n";
  const std::string ring = held("outer", "\"x\", \"y\", \"z\""),
                    ends = held("left", "\"x\", \"y\", \"z\"") + held("right", "\"x\", \"y\", \"z\"");
  for (const std::string& refused :
       {pressed("axisymmetric", annulus, held("outer", "\"x\", \"z\"")), pressed("3d", annulus, ring),
        pressed("3d", annulus, ring + held("inner", "\"x\"")), pressed("3d", sheet, ends),
        pressed("3d", sheet, ends + held("top", "\"x\"") + held("bottom", "\"x\"")),
        pressed("3d", sheet,
                ends + held("bottom", "\"y\"") +
                    held("top", "\"y\"", "displacement = { y = \"1 mm\" }\n[[step]]\nkind = \"move\"\n"))}) {
    write("film.toml", refused);
    const Case one = read_case(directory / "film.toml");
    try {
      build_device(one);
      ADD_FAILURE() << "accepted";
    } catch (const CaseError& error) {
      EXPECT_NE(std::string(error.what()).find("has an edge at"), std::string::npos) << error.what();
    }
  }
  for (const std::string& taken :
       {pressed("axisymmetric", annulus, held("outer", "\"x\", \"z\"") + held("inner", "\"x\"")),
        pressed("axisymmetric", annulus, held("outer", "\"x\", \"z\"") + held("inner", "\"z\"")),
        pressed("axisymmetric", annulus + "[plate]\nmass = \"1 g\"\n", held("outer", "\"x\", \"z\"")),
        pressed("3d", annulus, ring + held("inner", "\"z\"")),
        pressed("3d", annulus, ring + held("inner", "\"x\", \"y\"")),
        pressed("3d", sheet, ends + held("top", "\"y\"") + held("bottom", "\"z\""))}) {
    write("film.toml", taken);
    const Case one = read_case(directory / "film.toml");
    EXPECT_NO_THROW(build_device(one));
  }
}

// Curved triangles about the middle made its height converge with order 2 only.
TEST_F(FilmCases, the_height_of_a_disc_in_space_is_that_of_its_meridian) {
  const std::string pressed = "pressure = \"200 Pa\"\n", steps = "[[step]]\nkind = \"pressure\"\n";
  const double height = run(disc(pressed, steps, "[mesh]\nrings = 64\n")).last("height");
  for (const auto& [rings, error] : {std::pair{4, 3e-4}, {8, 3e-5}})
    EXPECT_NEAR(run("model = \"3d\"\n" + disc(pressed, steps, fmt::format("[mesh]\nrings = {}\n", rings)))
                    .last("height"),
                height, error * height)
        << rings;
}

} // namespace
} // namespace dielast::cases::film_cases_test
