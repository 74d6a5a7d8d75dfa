// SPDX-License-Identifier: GPL-3.0-or-later
// Solids in space as a user writes them.
#include "meshing/gmsh/gmsh_text.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/solids/slab.hpp"
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::cases::tetrahedra_test {
namespace {

constexpr double mu = 40e3, eps = 4e-11;

class Tetrahedra : public Paths {
 protected:
  Case read(const std::string& text) { return CaseTest::read(text + "\n[output]\nerror_estimate = false\n"); }
  std::map<std::string, double> values(const std::string& text) { return test::values_at_end(read(text)); }
};

std::string film(const std::string& thickness, const std::string& rest = "") {
  return fmt::format(
      "[film]\nthickness = \"{}\"\n{}\n[film.material]\nshear_modulus = \"{} Pa\"\npermittivity "
      "= \"{} F/m\"\n",
      thickness, rest, mu, eps);
}

// Of the sphere of solids_test.cpp.
TEST_F(Tetrahedra, eighth_of_a_thick_sphere_has_the_exact_radii_and_capacitance) {
  const Case one =
      read("model = \"3d\"\n" + film("2 mm") +
           "[hollow_sphere]\ninner_radius = \"10 mm\"\nouter_radius = \"12 mm\"\n[mesh]\nacross = "
           "2\n[chamber]\nat = \"inner\"\npressure = \"4 kPa\"\n[drive]\nvoltage = \"20 kV\"\n"
           "[[step]]\nkind = \"pressure\"\nincrements = 2\n[[step]]\nkind = "
           "\"voltage\"\nincrements = 2\n");
  const auto found = test::values_at_end(one);
  EXPECT_NEAR(found.at("inner_radius"), 11.224103931699284e-3, 1e-4 * 11.2e-3);
  EXPECT_NEAR(found.at("outer_radius"), 12.890637452975843e-3, 1e-4 * 12.9e-3);
  EXPECT_NEAR(8 * found.at("capacitance"), 4.363971194858246e-11, 1e-4 * 4.36e-11);
  EXPECT_NEAR(found.at("electrical_work") + found.at("mechanical_work"), found.at("stored_energy"),
              1e-8 * found.at("stored_energy"));
}

std::string stack(const std::string& more) {
  std::string text = film("50 um") +
                     "[slab]\nlength = \"6 mm\"\nheight = \"0.6 mm\"\nelectrode = [\"1.5 mm\", \"4.5 mm\"]\n"
                     "cover_thickness = \"50 um\"\n" +
                     more + "[drive]\nvoltage = \"300 V\"\n[[step]]\nkind = \"voltage\"\nincrements = 1\n";
  for (const auto& [name, x] : {std::pair{"swells", 1.0}, {"sinks", 2.0}})
    text +=
        fmt::format("[[quantity]]\nname = \"{}\"\nkind = \"displacement\"\npoint = [\"{} mm\", \"0.6 mm\", "
                    "\"0 mm\"]\nalong = \"y\"\n",
                    name, x);
  return text;
}

/// Its sides held it is the stack in plane strain, and free its middle nearly so.
TEST_F(Tetrahedra, middle_of_a_stack_is_in_plane_strain) {
  const auto plane =
      values(stack("[mesh]\nacross = 3\n[[support]]\nplace = \"bottom\"\nfix = [\"x\", \"y\"]\n"));
  ASSERT_GT(plane.at("swells"), 1e-7);
  ASSERT_LT(plane.at("sinks"), -1e-7);
  const std::string block = "width = \"9 mm\"\n[mesh]\nacross = 3\n[[support]]\nplace = \"bottom\"\nfix = "
                            "[\"x\", \"y\", \"z\"]\n";
  const auto free = values(stack(block));
  const auto held =
      values(stack(block + "[[support]]\nplace = \"front\"\nfix = [\"z\"]\n[[support]]\nplace = "
                           "\"back\"\nfix = [\"z\"]\n"));
  for (const char* name : {"swells", "sinks"}) {
    EXPECT_NEAR(held.at(name), plane.at(name), 0.01 * std::abs(plane.at(name))) << name;
    EXPECT_NEAR(free.at(name), plane.at(name), 0.05 * std::abs(plane.at(name))) << name;
  }
  EXPECT_NEAR(held.at("capacitance"), plane.at("capacitance") * 9e-3, 1e-5 * held.at("capacitance"));
}

/// See two_layers_have_the_force_and_capacitance_of_the_closed_form of plane strain.
TEST_F(Tetrahedra, two_layers_have_the_force_and_capacitance_of_the_closed_form) {
  constexpr double mu2 = 100e3, eps2 = 8e-11, H = 0.5e-3, voltage = 10e3, l = 1.1, W = 2e-3;
  const auto found = values(
      film("2 mm", "field = \"potential\"") +
      fmt::format(
          "[part.core]\nplace = \"electrode\"\n[part.core.film]\nthickness = \"2 mm\"\nfield = "
          "\"potential\"\n[part.core.film.material]\nshear_modulus = \"{} Pa\"\npermittivity = \"{} "
          "F/m\"\n[slab]\nlength = \"5 mm\"\nheight = \"1 mm\"\nwidth = \"2 mm\"\ncover_thickness = \"0.25 "
          "mm\"\n[mesh]\nacross = 2\n"
          "[[electrode]]\nname = \"film\"\nplace = \"top\"\nground = \"bottom\"\n"
          "[[support]]\nplace = \"left\"\nfix = [\"x\"]\n[[support]]\nplace = \"bottom\"\nfix = "
          "[\"y\"]\n[[support]]\nplace = \"front\"\nfix = [\"z\"]\n[[support]]\nplace = \"back\"\nfix = "
          "[\"z\"]\n"
          "[[support]]\nplace = \"right\"\ndisplacement = {{ x = \"0.5 mm\" }}\n"
          "[drive]\nvoltage = \"{} V\"\n[[step]]\nkind = \"move\"\n[[step]]\nkind = "
          "\"voltage\"\nincrements = 4\n[[quantity]]\n"
          "name = \"pull\"\nkind = \"force\"\nof = \"right\"\nalong = \"x\"\n",
          mu2, eps2, voltage));
  const double per_area = 1 / (H / eps + H / eps2); // F/m^2 as drawn
  EXPECT_NEAR(found.at("capacitance"), per_area * l * l * 5e-3 * W, 1e-8 * found.at("capacitance"));
  const double charge = per_area * voltage;
  const double force =
      W * (H * (mu + mu2) * (l - 1 / (l * l * l)) - H * l * charge * charge * (1 / eps + 1 / eps2));
  EXPECT_NEAR(found.at("pull"), force, 1e-8 * std::abs(force));
}

std::string own_mesh(const std::string& rest) {
  return "model = \"3d\"\n" + film("0.1 mm", "section = \"solid\"\n" + rest) +
         "[mesh]\nfile = \"own.msh\"\nunit = \"1 m\"\n[[electrode]]\nname = \"film\"\nplace = \"electrode\"\n"
         "[[support]]\nplace = \"bottom\"\nfix = [\"x\", \"y\", \"z\"]\n[drive]\nvoltage = \"500 V\"\n"
         "[[step]]\nkind = \"voltage\"\nincrements = 1\n[[quantity]]\nname = \"swelling\"\nkind = "
         "\"swelling\"\nof = \"top\"\nalong = \"y\"\n";
}

/// A mesh of one's own, and the direction in which its layers are stacked.
TEST_F(Tetrahedra, own_mesh_is_as_good_as_a_slab) {
  write("own.msh",
        meshing::gmsh_text(meshing::block_mesh({{4e-3, 0.6e-3, 0, {1e-3, 3e-3}, 0.1e-3}, 3e-3, 2e-3}, 3, 6)));
  const auto slab = values(
      film("0.1 mm") + "[slab]\nlength = \"4 mm\"\nheight = \"0.6 mm\"\nwidth = \"3 mm\"\nelectrode = [\"1 "
                       "mm\", \"3 mm\"]\nelectrode_width = \"2 mm\"\ncover_thickness = \"0.1 "
                       "mm\"\n[mesh]\nacross = 3\n[[support]]\nplace = \"bottom\"\nfix = [\"x\", \"y\", "
                       "\"z\"]\n[drive]\nvoltage = \"500 V\"\n[[step]]\nkind = \"voltage\"\nincrements = "
                       "1\n[[quantity]]\nname = \"swelling\"\nkind = \"swelling\"\nof = \"top\"\nalong = "
                       "\"y\"\n");
  ASSERT_GT(slab.at("swelling"), 1e-8);
  const auto own = values(own_mesh("stacked_along = \"y\""));
  EXPECT_NEAR(own.at("swelling"), slab.at("swelling"), 1e-6 * slab.at("swelling"));
  EXPECT_NEAR(own.at("capacitance"), slab.at("capacitance"), 1e-6 * slab.at("capacitance"));
  const auto across = values(own_mesh("")); // along z: the layers stand on their edges
  EXPECT_GT(std::abs(across.at("swelling") / slab.at("swelling") - 1), 0.1);
}

/// Beside a slab, whose layers are stacked along y, too.
TEST_F(Tetrahedra, layers_of_an_own_mesh_are_stacked_along_z_whatever_stands_beside_it) {
  write("own.msh",
        meshing::gmsh_text(meshing::block_mesh({{4e-3, 0.6e-3, 0, {1e-3, 3e-3}, 0.1e-3}, 3e-3, 2e-3}, 3, 6)));
  const auto as_part = [](std::string text, const std::string& name) {
    for (const std::string word : {"[film", "[mesh", "[slab", "\"bottom", "\"top", "\"electrode\""}) {
      const std::string named =
          word.substr(0, 1) + (word[0] == '[' ? "part." : "") + name + "." + word.substr(1);
      for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += named.size())
        text.replace(at, word.size(), named);
    }
    return text;
  };
  const auto together = values(
      as_part(own_mesh(""), "own") +
      as_part(film("0.1 mm", "section = \"solid\"") +
                  "[slab]\nlength = \"1 mm\"\nheight = \"1 mm\"\nwidth = \"1 mm\"\n[mesh]\nacross = 1\n"
                  "[[support]]\nplace = \"bottom\"\nfix = [\"x\", \"y\", \"z\"]\n",
              "beside"));
  const double alone = values(own_mesh("")).at("swelling");
  EXPECT_NEAR(together.at("swelling"), alone, 1e-6 * std::abs(alone));
}

void expect_error(const std::function<void()>& act, const std::string& part) {
  try {
    act();
    ADD_FAILURE() << "accepted; expected: " << part;
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

/// A layer whose underside is shaken, free to move along x only: a wave of shear goes up with sqrt(mu/rho)
/// and is thrown back by the free top, which moves twice as far; nothing is pressed.
TEST_F(Tetrahedra, waves_of_shear_travel_through_solids) {
  constexpr double height = 1e-3, density = 1000, amplitude = 1e-6;
  const double way = height / std::sqrt(mu / density), period = 3 * way, end = 1.9 * way;
  const double expected = amplitude * (1 - std::cos(2 * std::numbers::pi * (end - way) / period));
  for (const char* film_keys : {"section = \"solid\"", "field = \"potential\""})
    for (const bool in_space : {false, true}) {
      SCOPED_TRACE(fmt::format("{} {}", film_keys, in_space));
      const std::string potential =
          std::string(film_keys).starts_with("field")
              ? "[[electrode]]\nname = \"film\"\nplace = \"top\"\nground = \"bottom\"\n"
              : "";
      const auto found =
          values(film("1 mm", film_keys) +
                 "density = \"1000 kg/m3\"\n[slab]\nlength = \"0.5 mm\"\nheight = \"1 mm\"\n" +
                 (in_space ? "width = \"0.2 mm\"\n" : "") + potential +
                 fmt::format(
                     "[mesh]\nacross = 8\n[drive]\nvoltage = \"0 V\"\n"
                     "[[support]]\nplace = \"film\"\nfix = [\"y\"{}]\n"
                     "[[support]]\nplace = \"bottom\"\nfix = [\"x\"]\ndisplacement.x = {{ wave = "
                     "\"unipolar sine\", amplitude = \"{} m\", frequency = \"{} Hz\" }}\n"
                     "[[step]]\nkind = \"transient\"\nduration = \"{} s\"\ninertia = true\nincrements = 200\n"
                     "[[quantity]]\nname = \"top\"\nkind = \"displacement\"\nof = \"top\"\nalong = \"x\"\n",
                     in_space ? ", \"z\"" : "", amplitude, 1 / period, end));
      EXPECT_NEAR(found.at("top"), expected, 2e-3 * expected);
      EXPECT_NEAR(found.at("mechanical_work"), found.at("stored_energy"), 1e-3 * found.at("stored_energy"));
    }
}

TEST_F(Tetrahedra, refuse_what_solids_do_not_do) {
  const std::string slab = "[slab]\nlength = \"4 mm\"\nheight = \"1 mm\"\n";
  const std::string drive = "[drive]\nvoltage = \"500 V\"\n";
  expect_error([&] { read("model = \"3d\"\n" + film("1 mm") + slab + drive); }, "slab.width");
  expect_error([&] { read(film("1 mm") + slab + "width = \"2 mm\"\nelectrode_width = \"3 mm\"\n" + drive); },
               "electrode_width");
  expect_error([&] { read(film("1 mm", "stacked_along = \"z\"") + slab + drive); }, "stacked in the plane");
  const std::string block = slab + "width = \"2 mm\"\n";
  const std::string branch =
      "[[film.material.branch]]\nshear_modulus = \"1 kPa\"\nrelaxation_time = \"1 s\"\n";
  const auto vibrates = [&](const std::string& branches, const std::string& step) {
    return film("1 mm") + "density = \"1000 kg/m3\"\n" + branches + block + drive +
           "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\nof = \"right\"\nalong = \"x\"\n"
           "[[step]]\nkind = \"voltage\"\n[[step]]\n" +
           step + "\n";
  };
  const std::string harmonic = "kind = \"harmonic\"\nfrom = \"1 Hz\"\nto = \"10 Hz\"";
  EXPECT_NO_THROW(read(vibrates(branch, harmonic)));
  EXPECT_NO_THROW(read(vibrates("", harmonic) + "[linearise]\norder = 2\n"));
  expect_error(
      [&] {
        std::string solved = vibrates("", harmonic) +
                             "[linearise]\norder = 2\n"
                             "[[electrode]]\nname = \"film\"\nplace = \"top\"\nground = \"bottom\"\n";
        solved.replace(solved.find("[film]"), 6, "[film]\nfield = \"potential\"");
        read(solved);
      },
      "has no linear model");
  EXPECT_NO_THROW(read(vibrates(branch, "kind = \"modes\"")));
  expect_error(
      [&] {
        read(film("1 mm") + block + drive + "[[step]]\nkind = \"voltage\"\non_instability = \"jump\"\n");
      },
      "solids do not jump");
  const Case open = read(film("1 mm") + block +
                         "[[support]]\nplace = \"bottom\"\nfix = [\"x\", \"y\", \"z\"]\n"
                         "[chamber]\nat = \"top\"\npressure = \"1 kPa\"\n" +
                         drive + "[[step]]\nkind = \"pressure\"\n");
  expect_error([&] { build_device(open); }, "has an edge");
  write("own.msh",
        meshing::gmsh_text(meshing::block_mesh({{4e-3, 1e-3, 0, {0, 4e-3}, 0}, 3e-3, 3e-3}, 1, 6)));
  std::string membrane = own_mesh("");
  membrane.replace(membrane.find("section = \"solid\""), 17, "");
  const Case tetrahedral_film = read(membrane);
  EXPECT_THROW(build_device(tetrahedral_film), meshing::MeshError);
}

/// A thin clamped disc whose electrode ends inside, with the potential as unknown, against the membrane. Its
/// difference is that of the fringe, and goes with the thickness.
TEST_F(Tetrahedra, thin_disc_with_fringes_is_the_membrane) {
  constexpr double radius = 10e-3, electrode = 4e-3;
  const auto membrane = values(fmt::format(
      "model = \"axisymmetric\"\n{}[disc]\nradius = \"{} m\"\nelectrode_radius = \"{} m\"\n[mesh]\nrings = "
      "100\n[[support]]\nplace = \"film\"\nfix = [\"z\"]\n[[support]]\nplace = \"rim\"\nfix = [\"x\", "
      "\"z\"]\n[drive]\nvoltage = \"10 kV\"\n[[step]]\nkind = \"voltage\"\nincrements = 4\n",
      film("1 mm"), radius, electrode));
  const double expected = membrane.at("electrode_radius") - electrode;
  ASSERT_GT(expected, 0.01 * electrode);
  double difference = 1;
  for (const int part : {20, 40, 80}) { // thickness over radius
    const double H = radius / part;
    // Its upper half: the middle is the ground.
    const auto solid = values(fmt::format(
        "model = \"axisymmetric\"\n{}[slab]\nlength = \"{} m\"\nheight = \"{} m\"\nelectrode = [\"0 m\", "
        "\"{} m\"]\n[mesh]\nacross = 3\n[[electrode]]\nname = \"film\"\nplace = \"upper_electrode\"\nground "
        "= \"bottom\"\n[[support]]\nplace = \"bottom\"\nfix = [\"z\"]\n[[support]]\nplace = "
        "\"right\"\nfix = [\"x\"]\n[drive]\nvoltage = \"{} V\"\n[[step]]\nkind = \"voltage\"\nincrements = "
        "4\n[[quantity]]\nname = \"edge\"\nkind = \"displacement\"\npoint = [\"{} m\", \"0 m\", \"0 "
        "m\"]\nalong = \"x\"\n",
        film(fmt::format("{} m", H), "field = \"potential\""), radius, H / 2, electrode, 10e3 * H / 1e-3 / 2,
        electrode));
    const double now = std::abs(solid.at("edge") / expected - 1);
    EXPECT_LT(now, 0.8 * difference) << part;
    difference = now;
  }
  EXPECT_LT(difference, 0.01);
}

std::string block_off(const std::string& triangles) {
  return fmt::format("OFF\n8 {} 0\n0 0 0\n2 0 0\n2 1 0\n0 1 0\n0 0 1\n2 0 1\n2 1 1\n0 1 1\n{}",
                     std::ranges::count(triangles, '\n'), triangles);
}

const std::string sides_of_block =
    "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 2 3 7\n3 2 7 6\n3 1 2 6\n3 1 6 5\n3 0 4 7\n3 0 "
    "7 3\n";

std::string filled_block(const std::string& unit) {
  return "model = \"3d\"\n" + film("1 mm", "section = \"solid\"") +
         "[mesh]\nfile = \"block.off\"\nunit = \"" + unit +
         "\"\nsize = \"0.5 mm\"\n[[support]]\nplace = \"x_min\"\nfix = [\"x\"]\n[[support]]\nplace = "
         "\"y_min\"\nfix = [\"y\"]\n[[support]]\nplace = \"z_min\"\nfix = [\"z\"]\n[[support]]\nplace = "
         "\"x_max\"\ndisplacement = { x = \"0.2 mm\" }\n[[step]]\nkind = \"move\"\n[[quantity]]\nname = "
         "\"pull\"\nkind = \"force\"\nof = \"x_max\"\nalong = \"x\"\n";
}

/// Of millimetres, pulled by a tenth.
TEST_F(Tetrahedra, filled_surface_pulls_as_the_closed_form) {
  write("block.off", block_off(sides_of_block));
  constexpr double l = 1.1, area = 1e-6;
  const double force = mu * area * (l - 1 / (l * l));
  EXPECT_NEAR(values(filled_block("1 mm")).at("pull"), force, 1e-8 * force);
}

} // namespace
} // namespace dielast::cases::tetrahedra_test
