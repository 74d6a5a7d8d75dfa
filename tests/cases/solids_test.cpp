// SPDX-License-Identifier: GPL-3.0-or-later
// Solids as a user writes them: [slab] and [hollow_sphere].
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dielast::cases::solids_test {
namespace {

constexpr double mu = 40e3, eps = 4e-11;

class Solids : public Paths {
 protected:
  std::map<std::string, double> values(const std::string& text) {
    return CaseTest::values(text + "\n[output]\nerror_estimate = false\n");
  }
};

std::string film(const std::string& rest = "") {
  return fmt::format(
      "[film]\nthickness = \"2 mm\"\n{}\n[film.material]\nshear_modulus = \"{} Pa\"\npermittivity "
      "= \"{} F/m\"\n",
      rest, mu, eps);
}

// Held along z: p/mu = ln(la/lb) + (1/lb^2 - 1/la^2)/2, of the hoop stretches within and without. Its wall is
// a slab higher than long.
TEST_F(Solids, thick_tube_has_the_exact_radius_on_the_mesh_that_it_gets) {
  const double A = 0.5e-3, B = 2e-3, pressure = 0.4 * mu;
  double low = A, high = 2 * A;
  for (int i = 0; i < 60; ++i) {
    const double a = (low + high) / 2, la = a / A, lb = std::sqrt(B * B - A * A + a * a) / B;
    (mu * (std::log(la / lb) + (1 / (lb * lb) - 1 / (la * la)) / 2) < pressure ? low : high) = a;
  }
  const auto found = values(
      "model = \"axisymmetric\"\n" + film() +
      fmt::format("[slab]\ninner_radius = \"0.5 mm\"\nlength = \"1.5 mm\"\nheight = \"20 mm\"\n[chamber]\n"
                  "at = \"left\"\npressure = \"{} Pa\"\n[[support]]\nplace = \"bottom\"\nfix = [\"z\"]\n"
                  "[[support]]\nplace = \"top\"\nfix = [\"z\"]\n[[step]]\nkind = \"pressure\"\n[[quantity]]\n"
                  "name = \"u\"\nkind = \"displacement\"\nof = \"left\"\nalong = \"x\"\n",
                  pressure));
  EXPECT_NEAR(found.at("u"), low - A, 1e-4 * (low - A));
}

// Radii by quadrature of the radial equilibrium.
TEST_F(Solids, thick_sphere_has_the_exact_radii_and_capacitance) {
  struct Exact {
    double voltage, a, b, capacitance;
  };
  for (const auto& [voltage, a, b, capacitance] :
       {Exact{0, 10.757042837572977e-3, 12.54170632119474e-3, 3.799820163387723e-11},
        Exact{20e3, 11.224103931699284e-3, 12.890637452975843e-3, 4.363971194858246e-11}}) {
    const auto found = values(
        film() + fmt::format("[hollow_sphere]\ninner_radius = \"10 mm\"\nouter_radius = \"12 mm\"\n"
                             "[chamber]\nat = \"inner\"\npressure = \"4 kPa\"\n[drive]\nvoltage = \"{} V\"\n"
                             "[[step]]\nkind = \"pressure\"\nincrements = 3\n"
                             "[[step]]\nkind = \"voltage\"\nincrements = 3\n",
                             voltage));
    EXPECT_NEAR(found.at("inner_radius"), a, 1e-5 * a);
    EXPECT_NEAR(found.at("outer_radius"), b, 1e-5 * b);
    EXPECT_NEAR(found.at("capacitance"), capacitance, 1e-5 * capacitance);
    EXPECT_NEAR(found.at("electrical_work") + found.at("mechanical_work"), found.at("stored_energy"),
                1e-9 * found.at("stored_energy"));
  }
}

std::string tube(double voltage, int across) {
  return "model = \"axisymmetric\"\n" + film("field = \"potential\"") +
         fmt::format(
             "[slab]\nlength = \"2 mm\"\nheight = \"1 mm\"\ninner_radius = \"10 mm\"\n[mesh]\nacross = {}\n"
             "[[electrode]]\nname = \"film\"\nplace = \"right\"\nground = \"left\"\n"
             "[[support]]\nplace = \"top\"\nfix = [\"z\"]\n[[support]]\nplace = \"bottom\"\nfix = [\"z\"]\n"
             "[drive]\nvoltage = \"{} V\"\n[[step]]\nkind = \"voltage\"\nincrements = 4\n"
             "[[quantity]]\nname = \"a\"\nkind = \"radius\"\nof = \"left\"\n"
             "[[quantity]]\nname = \"b\"\nkind = \"radius\"\nof = \"right\"\n",
             across, voltage);
}

TEST_F(Solids, thick_tube_has_the_exact_radii_and_capacitance) {
  struct Exact {
    double voltage, a, b, capacitance;
  };
  for (const auto& [voltage, a, b, capacitance] :
       {Exact{0, 10e-3, 12e-3, 1.3784843476913363e-12},
        Exact{20e3, 10.320432158666927e-3, 12.268305504088431e-3, 1.45365437535419e-12},
        Exact{40e3, 11.621405402812561e-3, 13.381220554811918e-3, 1.7824186374763955e-12}}) {
    const auto found = values(tube(voltage, 3));
    EXPECT_NEAR(found.at("a"), a, 1e-5 * a);
    EXPECT_NEAR(found.at("b"), b, 1e-5 * b);
    EXPECT_NEAR(found.at("capacitance"), capacitance, 1e-5 * capacitance);
  }
}

std::string pressed_slab(const std::string& slab, const std::string& at, const std::string& rest,
                         const std::string& goal = "pressure = \"20 kPa\"") {
  return "model = \"axisymmetric\"\n" + film() +
         fmt::format("[slab]\n{}\n[mesh]\nacross = 8\n[chamber]\nat = \"{}\"\n{}\n[[step]]\nkind = \"{}\"\n"
                     "name = \"press\"\n[[quantity]]\nname = \"a\"\nkind = \"radius\"\nof = \"left\"\n"
                     "[[quantity]]\nname = \"b\"\nkind = \"radius\"\nof = \"right\"\n"
                     "[[quantity]]\nname = \"top\"\nkind = \"displacement\"\nof = \"top\"\nalong = \"z\"\n",
                     slab, at, goal, goal.starts_with("volume") ? "inflate" : "pressure") +
         rest;
}
std::string held(const std::string& place, const std::string& axes, const std::string& rest = "") {
  return fmt::format("[[support]]\nplace = \"{}\"\nfix = [{}]\n{}", place, axes, rest);
}
const std::string thick_tube = "inner_radius = \"5 mm\"\nlength = \"5 mm\"\nheight = \"2 mm\"",
                  disc = "length = \"10 mm\"\nheight = \"4 mm\"";

// The bore's ends rest along z and move outwards. In plane strain the stress across grows by mu (k^2 - 1/k^2)
// dr/r with the hoop stretch k = r/R: p = mu [ln k - 1/(2 k^2)] between the two surfaces.
TEST_F(Solids, a_pressure_in_a_tube_held_along_z_widens_it_as_in_plane_strain) {
  constexpr double A = 5e-3, B = 10e-3, p = 20e3, height = 2e-3;
  double low = A, high = 4 * A; // of the inner radius
  for (int i = 0; i < 200; ++i) {
    const double a = (low + high) / 2, grown = a * a - A * A;
    const double ka = a / A, kb = std::sqrt(B * B + grown) / B;
    const double held = mu * (std::log(ka / kb) + (1 / (kb * kb) - 1 / (ka * ka)) / 2);
    (held < p ? low : high) = a;
  }
  const double outer = std::sqrt(B * B + low * low - A * A), bore = std::numbers::pi * low * low * height;
  const std::string ends = held("bottom", "\"z\"") + held("top", "\"z\"");
  const auto pressed = values(pressed_slab(thick_tube, "left", ends));
  const auto pumped = values(pressed_slab(thick_tube, "left", ends,
                                          fmt::format("volume = \"{:.17g} m^3\"", bore * (1 + p / 2.2e9))));
  for (const auto& found : {pressed, pumped}) {
    EXPECT_NEAR(found.at("a"), low, 3e-5 * low);
    EXPECT_NEAR(found.at("b"), outer, 1e-5 * outer);
    EXPECT_NEAR(found.at("volume"), bore, 1e-4 * bore);
    EXPECT_NEAR(found.at("pressure"), p, 1e-4 * p);
    EXPECT_NEAR(found.at("mechanical_work"), found.at("stored_energy"), 1e-9 * found.at("stored_energy"));
  }
}

// Bonded ends do not move: that they rest along z may be known or not.
TEST_F(Solids, a_pressure_acts_alike_whatever_form_its_edges_take) {
  const std::string bottom = held("bottom", "\"x\", \"z\""), top = held("top", "\"x\", \"z\"");
  const auto bonded = values(pressed_slab(thick_tube, "left", bottom + top));
  const auto moved = values(pressed_slab(
      thick_tube, "left", bottom + top + "displacement = { z = \"0 mm\" }\n[[step]]\nkind = \"move\"\n"));
  EXPECT_NEAR(moved.at("a"), bonded.at("a"), 1e-12);
  EXPECT_NEAR(moved.at("mechanical_work"), bonded.at("mechanical_work"), 1e-9 * bonded.at("mechanical_work"));
  EXPECT_GT(bonded.at("a"), 5e-3 + 1e-5);
}

// On its axis and in a sleeve a disc's top moves along z alone.
TEST_F(Solids, a_pressure_on_a_disc_in_a_sleeve_compresses_it_uniformly) {
  constexpr double p = 20e3, bulk = 400e3;
  double low = 0.5, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double l = (low + high) / 2;
    const double stress = mu * std::pow(l, -5.0 / 3) * (l * l - (l * l + 2) / 3) + bulk * (l - 1);
    (stress < -p ? low : high) = l;
  }
  std::string soft = pressed_slab(disc, "top", held("bottom", "\"z\"") + held("right", "\"x\""));
  soft.replace(soft.find("thickness"), 0, fmt::format("bulk_modulus = {}\n", bulk));
  const auto found = values(soft);
  EXPECT_NEAR(found.at("top"), 4e-3 * (low - 1), 1e-8 * 4e-3);
  EXPECT_NEAR(-found.at("volume"), std::numbers::pi * 1e-4 * 4e-3 * low, 1e-8 * 1e-6); // the chamber is above
}

TEST_F(Solids, an_edge_that_may_move_across_itself_is_refused_under_pressure) {
  const std::string bottom = held("bottom", "\"z\"");
  for (const std::string& text :
       {pressed_slab(thick_tube, "left", bottom), pressed_slab(disc, "top", bottom),
        pressed_slab(disc, "right", bottom), pressed_slab(thick_tube, "left", ""),
        pressed_slab(
            thick_tube, "left",
            bottom + held("top", "\"z\"", "displacement = { z = \"1 mm\" }\n[[step]]\nkind = \"move\"\n")),
        pressed_slab(thick_tube, "left", bottom + held("top", "\"z\"", "until = \"press\"\n"))}) {
    const Case open = read(text);
    try {
      build_device(open);
      ADD_FAILURE() << "accepted";
    } catch (const CaseError& error) {
      EXPECT_NE(std::string(error.what()).find("has an edge at"), std::string::npos) << error.what();
    }
  }
}

/// Isolated at the voltage that it has, the tube stays as it is: the border of the charge knows the
/// potential.
TEST_F(Solids, tube_under_given_charge_is_that_under_voltage) {
  const auto driven =
      values(tube(20e3, 2) + "[[quantity]]\nname = \"Q\"\nkind = \"charge\"\nof = \"film\"\n");
  std::string text = tube(20e3, 2);
  text.replace(text.find("kind = \"voltage\""), 16, "kind = \"charge\"");
  text.replace(text.find("voltage = \"20000 V\""), 19, fmt::format("charge = \"{:.17g} C\"", driven.at("Q")));
  const auto isolated = values(text);
  EXPECT_NEAR(isolated.at("a"), driven.at("a"), 1e-9 * driven.at("a"));
  EXPECT_NEAR(isolated.at("electrical_work"), driven.at("electrical_work"),
              1e-8 * driven.at("electrical_work"));
}

/// Layers of two materials in series between straight sides, stretched by a tenth and charged: the field is
/// uniform in each, and the capacitance l^2 times that of the drawing. The force is the derivative of the
/// energy sum_i H_i (mu_i/2 (l^2 + 1/l^2) - eps_i/2 E_i^2 l^2) in l at the nominal fields E_i.
TEST_F(Solids, two_layers_have_the_force_and_capacitance_of_the_closed_form) {
  constexpr double mu2 = 100e3, eps2 = 8e-11, H = 0.5e-3, voltage = 10e3, l = 1.1;
  const auto found = values(
      film("field = \"potential\"") +
      fmt::format(
          "[part.core]\nplace = \"electrode\"\n[part.core.film]\nthickness = \"2 mm\"\nfield = "
          "\"potential\"\n[part.core.film.material]\nshear_modulus = \"{} Pa\"\npermittivity = \"{} "
          "F/m\"\n"
          "[slab]\nlength = \"5 mm\"\nheight = \"1 mm\"\ncover_thickness = \"0.25 mm\"\n[mesh]\nacross "
          "= 4\n"
          "[[electrode]]\nname = \"film\"\nplace = \"top\"\nground = \"bottom\"\n"
          "[[support]]\nplace = \"left\"\nfix = [\"x\"]\n[[support]]\nplace = \"bottom\"\nfix = "
          "[\"y\"]\n"
          "[[support]]\nplace = \"right\"\ndisplacement = {{ x = \"0.5 mm\" }}\n"
          "[drive]\nvoltage = \"{} V\"\n[[step]]\nkind = \"move\"\n[[step]]\nkind = "
          "\"voltage\"\nincrements = 4\n[[quantity]]\n"
          "name = \"pull\"\nkind = \"force\"\nof = \"right\"\nalong = \"x\"\n",
          mu2, eps2, voltage));
  const double per_area = 1 / (H / eps + H / eps2); // F/m^2 as drawn
  EXPECT_NEAR(found.at("capacitance"), per_area * l * l * 5e-3, 1e-8 * found.at("capacitance"));
  const double charge = per_area * voltage; // per area as drawn, over l^2: eps_i E_i
  const double force =
      H * (mu + mu2) * (l - 1 / (l * l * l)) - H * l * charge * charge * (1 / eps + 1 / eps2);
  EXPECT_NEAR(found.at("pull"), force, 1e-8 * std::abs(force));
}

// An independent solution with another program.
TEST_F(Solids, stack_on_a_table_swells_beside_its_electrode) {
  std::string text = R"(
[film]
thickness = "50 um"
[film.material]
shear_modulus = "0.40 MPa"
relative_permittivity = 2.8
[slab]
length = "24 mm"
height = "0.6 mm"
electrode = ["4 mm", "20 mm"]
cover_thickness = "50 um"
[[support]]
place = "bottom"
fix = ["x", "y"]
[drive]
voltage = "750 V"
[[step]]
kind = "voltage"
increments = 2
)";
  const std::map<std::string, double> expected{{"2", 0.054},    {"3", 0.194},  {"3.5", 0.409},
                                               {"4.5", -0.408}, {"5", -0.193}, {"6", -0.053}};
  for (const auto& [x, rise] : expected)
    text += fmt::format(
        "[[quantity]]\nname = \"at_{}\"\nkind = \"displacement\"\npoint = [\"{} mm\", \"0.6 mm\", "
        "\"0 mm\"]\nalong = \"y\"\n",
        x == "3.5"   ? "near"
        : x == "4.5" ? "far"
                     : x,
        x);
  const auto found =
      values(text + "[[quantity]]\nname = \"middle\"\nkind = \"displacement\"\npoint = [\"12 mm\", "
                    "\"0.6 mm\", \"0 mm\"]\nalong = \"y\"\n");
  for (const auto& [x, rise] : expected)
    EXPECT_NEAR(found.at("at_" + (x == "3.5"   ? "near"
                                  : x == "4.5" ? "far"
                                               : x)) *
                    1e6,
                rise, 0.02 * std::abs(rise) + 0.0005) // it has three digits
        << x;
  EXPECT_LT(std::abs(found.at("middle")), 0.005e-6);
}

/// A thin clamped disc with an electrode in the middle, by its upper half, against the membrane: the
/// difference is that of the field's edge, and goes with the thickness.
TEST_F(Solids, thin_disc_is_the_membrane) {
  constexpr double radius = 10e-3, electrode = 4e-3;
  const auto membrane = values(fmt::format(
      "model = \"axisymmetric\"\n[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"{} Pa\"\n"
      "permittivity = \"{} F/m\"\n[disc]\nradius = \"{} m\"\nelectrode_radius = \"{} m\"\n[mesh]\nrings = "
      "100\n"
      "[[support]]\nplace = \"film\"\nfix = [\"z\"]\n[[support]]\nplace = \"rim\"\nfix = [\"x\", \"z\"]\n"
      "[drive]\nvoltage = \"10 kV\"\n[[step]]\nkind = \"voltage\"\nincrements = 4\n",
      mu, eps, radius, electrode));
  const double expected = membrane.at("electrode_radius") - electrode;
  ASSERT_GT(expected, 0.01 * electrode);
  double difference = 1;
  for (const int part : {10, 20, 40}) { // thickness over radius
    const double H = radius / part;
    const auto solid = values(fmt::format(
        "model = \"axisymmetric\"\n[film]\nthickness = \"{0} m\"\n[film.material]\nshear_modulus = \"{1} "
        "Pa\"\n"
        "permittivity = \"{2} F/m\"\n[slab]\nlength = \"{3} m\"\nheight = \"{4} m\"\nelectrode = [\"0 m\", "
        "\"{5} "
        "m\"]\n[mesh]\nacross = 3\n[[support]]\nplace = \"bottom\"\nfix = [\"z\"]\n[[support]]\nplace = "
        "\"right\"\nfix = [\"x\"]\n[drive]\nvoltage = \"{6} V\"\n[[step]]\nkind = \"voltage\"\nincrements = "
        "4\n[[quantity]]\nname = \"edge\"\nkind = \"displacement\"\npoint = [\"{5} m\", \"0 m\", \"0 "
        "m\"]\nalong = "
        "\"x\"\n",
        H, mu, eps, radius, H / 2, electrode, 10e3 * H / 1e-3));
    const double now = std::abs(solid.at("edge") / expected - 1);
    EXPECT_LT(now, 0.8 * difference) << part;
    difference = now;
  }
  EXPECT_LT(difference, 0.01);
}

/// A solid of a nearly incompressible material swells a little; one that is resumed, or solved in other
/// increments, ends in the same state.
TEST_F(Solids, path_does_not_depend_on_increments) {
  const auto slab = [&](int increments) {
    return values(
        film("bulk_modulus = \"1 MPa\"") +
        fmt::format("[[film.material.branch]]\nshear_modulus = \"20 kPa\"\nrelaxation_time = \"1 s\"\n"
                    "[slab]\nlength = \"20 mm\"\nheight = \"4 mm\"\nelectrode = [\"5 mm\", \"15 mm\"]\n"
                    "[mesh]\nacross = 4\n[[support]]\nplace = \"bottom\"\nfix = [\"x\", \"y\"]\n"
                    "[drive]\nvoltage = \"40 kV\"\n[[step]]\nkind = \"voltage\"\nresponse = "
                    "\"instantaneous\"\nincrements = {}\n[[step]]\nkind = \"hold\"\nduration = \"20 s\"\n"
                    "[[quantity]]\nname = \"swelling\"\nkind = \"swelling\"\nof = \"top\"\nalong = \"y\"\n",
                    increments));
  };
  const auto few = slab(2), many = slab(9);
  EXPECT_GT(few.at("swelling"), 1e-5);
  EXPECT_NEAR(few.at("swelling"), many.at("swelling"), 1e-4 * few.at("swelling"));
  EXPECT_GT(few.at("dissipated_energy"), 0);
  EXPECT_LT(std::abs(few.at("energy_error")), 1e-3 * few.at("electrical_work"));
}

// A block that is free in its plane pulls in at 0.687 sqrt(mu / eps), 21.736 kV over 1 mm. Solids do not
// jump.
TEST_F(Solids, that_pull_in_are_not_told_to_jump) {
  const Run stopped = run(
      "model = \"3d\"\n" + film("field = \"potential\"") +
          "[slab]\nlength = \"1 mm\"\nheight = \"1 mm\"\nwidth = \"1 mm\"\n[mesh]\nacross = 1\ngrading = 1\n"
          "[[support]]\nplace = \"bottom\"\nfix = [\"y\"]\n[[support]]\nplace = \"left\"\nfix = [\"x\"]\n"
          "[[support]]\nplace = \"back\"\nfix = [\"z\"]\n"
          "[[electrode]]\nname = \"film\"\nplace = \"top\"\nground = \"bottom\"\n"
          "[drive]\nvoltage = \"25 kV\"\n[[step]]\nkind = \"voltage\"\nincrements = 8\n"
          "[[quantity]]\nname = \"up\"\nkind = \"displacement\"\nof = \"top\"\nalong = \"y\"\n"
          "[output]\nerror_estimate = false\n",
      "up");
  EXPECT_EQ(stopped.outcome.kind, "limit point");
  EXPECT_NEAR(stopped.rows.back().voltage, 21.736e3, 1);
  EXPECT_TRUE(stopped.outcome.message.ends_with("on_instability = \"follow\"")) << stopped.outcome.message;
}

// The layers of a stack lie in their part: one that is turned shrinks and swells along its own axes, where
// `stacked_along` names the axis, too.
TEST_F(Solids, layers_turn_with_their_part) {
  const auto stack = [&](const char* turned, const char* along, const char* supports) {
    return values(std::string("[part.a]\nturned = \"") + turned +
                  "\"\n[part.a.film]\nthickness = \"1 mm\"\nwidth = \"10 mm\"\n" + // of solid, as a part, too
                  along +
                  "[part.a.film.material]\nshear_modulus = \"30 kPa\"\npermittivity = \"4e-11 F/m\"\n"
                  "[part.a.slab]\nlength = \"10 mm\"\nheight = \"5 mm\"\n[part.a.mesh]\nacross = 2\n"
                  "[[electrode]]\nname = \"e\"\nplace = \"a.film\"\n[drive]\nvoltage = \"8 kV\"\n"
                  "[[step]]\nkind = \"voltage\"\n" +
                  supports +
                  "[[quantity]]\nname = \"gx\"\nkind = \"growth\"\nof = \"a.film\"\nalong = \"x\"\n"
                  "[[quantity]]\nname = \"gy\"\nkind = \"growth\"\nof = \"a.film\"\nalong = \"y\"\n"
                  "[[quantity]]\nname = \"C\"\nkind = \"capacitance\"\nof = \"e\"\n");
  };
  const auto drawn = stack("0 deg", "",
                           "[[support]]\nplace = \"a.bottom\"\nfix = [\"y\"]\n"
                           "[[support]]\nplace = \"a.left\"\nfix = [\"x\"]\n");
  EXPECT_GT(drawn.at("gx"), 0.02);
  for (const char* along : {"", "stacked_along = \"y\"\n"}) {
    const auto turned = stack("90 deg", along,
                              "[[support]]\nplace = \"a.bottom\"\nfix = [\"x\"]\n"
                              "[[support]]\nplace = \"a.left\"\nfix = [\"y\"]\n");
    EXPECT_NEAR(turned.at("gx"), drawn.at("gy"), 1e-9) << along;
    EXPECT_NEAR(turned.at("gy"), drawn.at("gx"), 1e-9) << along;
  }
  const char* clamped = "[[support]]\nplace = \"a.bottom\"\nfix = [\"x\", \"y\"]\n";
  const double straight = stack("0 deg", "", clamped).at("C");
  EXPECT_NEAR(stack("30 deg", "", clamped).at("C"), straight, 1e-9 * straight);
}

TEST_F(Solids, what_is_held_everywhere_is_told_to_have_no_pressures) {
  const std::string block = "[slab]\nlength = \"4 mm\"\nheight = \"2 mm\"\n" + held("film", "\"x\", \"y\"");
  const auto told = [](const Device& device) {
    return std::ranges::count_if(device.warnings, [](const std::string& warning) {
      return warning.find("film.bulk_modulus: is missing: this solid is held everywhere") !=
             std::string::npos;
    });
  };
  EXPECT_EQ(told(build_device(read(film() + block))), 1);
  EXPECT_EQ(told(build_device(read(film("bulk_modulus = \"1 MPa\"") + block))), 0);
}

} // namespace
} // namespace dielast::cases::solids_test
