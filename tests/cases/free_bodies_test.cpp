// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies that may turn freely, on film that resists nothing, and devices that nothing holds at all.
#include "cases/runs/linearise.hpp"
#include "tests/cases/film_cases.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

namespace dielast::cases::free_bodies_test {
namespace {

class FreeBodies : public FilmCases {};

const std::string square = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 1 "film"
$EndPhysicalNames
$Nodes
9
1 0 0 0
2 10 0 0
3 10 10 0
4 5 0 0
5 10 5 0
6 5 5 0
7 0 10 0
8 5 10 0
9 0 5 0
$EndNodes
$Elements
2
1 9 2 1 1 1 2 3 4 5 6
2 9 2 1 1 1 3 7 6 8 9
$EndElements
)";

/// All of a square film on a body with a pivot, its centre 10 mm below.
std::string pendulum(const std::string& rest) {
  return "model = \"planar\"\n[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"1 MPa\"\n"
         "permittivity = \"4e-11 F/m\"\ndensity = \"0 kg/m^3\"\n"
         "[mesh]\nfile = \"square.msh\"\nunit = \"1 mm\"\n"
         "[[body]]\nname = \"hub\"\nplaces = [\"film\"]\nmass = \"10 g\"\n"
         "centre = [\"0 mm\", \"-10 mm\", \"0 mm\"]\npivot = [\"0 mm\", \"0 mm\", \"0 mm\"]\n"
         "[gravity]\ndirection = [0, -1, 0]\n[[load]]\nplace = \"hub\"\n"
         "moment = [\"0 N m\", \"0 N m\", \"0.5e-3 N m\"]\n"
         "[output]\nfields = false\nerror_estimate = false\n"
         "[[step]]\nkind = \"weight\"\n[[step]]\nkind = \"force\"\n" +
         rest;
}

// A mass turns in no time by nothing, however soft what else holds it: it turned by 0.01 rad at the jump.
TEST_F(FreeBodies, stay_where_they_are_as_a_moment_jumps) {
  const std::string jump = "moment = [0, 0, { wave = \"step\", to = \"0.3 mN m\", at = \"0.1 s\" }]\n";
  const Ran ran =
      run("[film]\nthickness = \"1 um\"\n[film.material]\nshear_modulus = \"1 Pa\"\npermittivity = \"4e-11 "
          "F/m\"\n"
          "[rectangle]\nlength = \"10 mm\"\nwidth = \"10 mm\"\n[mesh]\nacross = 2\norder = 1\n"
          "[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\n"
          "[[body]]\nname = \"b\"\nplaces = [\"right\"]\nmass = \"50 g\"\ninertia = [0, 0, \"30 g.mm^2\"]\n"
          "centre = [\"5 mm\", \"-40 mm\", 0]\npivot = [\"5 mm\", 0, 0]\n[[load]]\nplace = \"b\"\n" +
          jump +
          "[[step]]\nkind = \"transient\"\nduration = \"0.2 s\"\nincrements = 40\n[output]\nerror_estimate = "
          "false\n"
          "[[quantity]]\nname = \"angle\"\nkind = \"angle\"\nof = \"b\"\nalong = \"z\"\n");
  EXPECT_EQ(ran.outcome.ending, Ending::complete) << ran.outcome.message;
  const double inertia = 50e-3 * 1.6e-3 + 30e-9; // about the pivot, kg m^2
  for (std::size_t r = 0; r < ran.time.size(); ++r) {
    const double since = std::max(0.0, ran.time[r] - 0.1);
    EXPECT_NEAR(ran.values.at("angle")[r], 0.3e-3 / inertia * since * since / 2, 1e-5) << ran.time[r];
  }
}

// The film resists nothing and pulls at nothing: its rounding was taken for tension that is let go.
TEST_F(FreeBodies, film_on_a_body_alone_is_a_pendulum) {
  write("square.msh", square);
  const Ran ran =
      run(pendulum("[[quantity]]\nname = \"angle\"\nkind = \"angle\"\nof = \"hub\"\nalong = \"z\"\n"));
  EXPECT_NEAR(ran.last("angle"), std::asin(0.5e-3 / (10e-3 * 9.81 * 10e-3)), 1e-4);
}

// In space nothing keeps a pendulum from turning about the vertical, which is no instability.
TEST_F(FreeBodies, what_may_turn_freely_is_told) {
  write("square.msh", square);
  write("film.toml", R"(model = "3d"
[part.far]
at = ["50 mm", "0 mm", "0 mm"]
[part.far.film]
thickness = "1 mm"
[part.far.film.material]
shear_modulus = "1 MPa"
permittivity = "4e-11 F/m"
density = "0 kg/m^3"
[part.far.mesh]
file = "square.msh"
unit = "1 mm"
[[support]]
place = "far"
fix = ["x", "y", "z"]
[part.bob]
[part.bob.line]
from = ["0 mm", "-10 mm", "0 mm"]
to = ["0 mm", "-12 mm", "0 mm"]
[part.bob.beam]
width = "1 mm"
height = "1 mm"
[part.bob.beam.material]
youngs_modulus = "1 MPa"
poisson_ratio = 0.3
density = "1e-6 kg/m^3"
[[body]]
name = "hub"
places = ["bob"]
mass = "10 g"
centre = ["0 mm", "-10 mm", "0 mm"]
pivot = ["0 mm", "0 mm", "0 mm"]
[gravity]
direction = [0, -1, 0]
[[step]]
kind = "weight"
)");
  const Case one = read_case(directory / "film.toml");
  const Outcome stopped = Simulation(one, 1).run({});
  EXPECT_EQ(stopped.kind, "singular tangent") << stopped.message;
  EXPECT_NE(stopped.message.find("can move freely"), std::string::npos) << stopped.message;
}

/// A strip of `cells` times 2 squares of triangles with 6 nodes each, of a length of 1 and `width`.
std::string strip_mesh(int cells, double width) {
  std::ostringstream nodes, elements;
  const int columns = 2 * cells + 1, rows = 5;
  const auto node = [&](int i, int j) { return j * columns + i + 1; };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      nodes << node(i, j) << ' ' << i / (columns - 1.0) << ' ' << width * j / (rows - 1.0) << " 0\n";
  int count = 0;
  const auto triangle = [&](std::array<std::pair<int, int>, 3> corners) {
    elements << ++count << " 9 2 1 1";
    for (const auto& [i, j] : corners) elements << ' ' << node(i, j);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& [i, j] = corners[c];
      const auto& [k, l] = corners[(c + 1) % 3];
      elements << ' ' << node((i + k) / 2, (j + l) / 2);
    }
    elements << '\n';
  };
  for (int j = 0; j < rows - 1; j += 2)
    for (int i = 0; i < columns - 1; i += 2) {
      triangle({{{i, j}, {i + 2, j}, {i + 2, j + 2}}});
      triangle({{{i, j}, {i + 2, j + 2}, {i, j + 2}}});
    }
  return fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"film\"\n$EndPhysicalNames\n"
      "$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
      columns * rows, nodes.str(), count, elements.str());
}

// Neither its six rigid motions nor what would hold these take part: omega = b^2 sqrt(EI/(rho A))/L^2 of a
// beam with free ends, b L = 4.73004, 7.85320; the strip is wide beside its thickness, 0.1 and 0.4 % stiffer.
TEST_F(FreeBodies, a_strip_of_shell_vibrates_as_a_beam_with_free_ends) {
  write("strip.msh", strip_mesh(20, 0.1));
  const Ran found =
      run("model = \"3d\"\n[film]\nthickness = \"0.5 mm\"\nsection = \"shell\"\n[film.material]\n"
          "shear_modulus = \"40 kPa\"\nrelative_permittivity = 4.7\ndensity = \"960 kg/m^3\"\n"
          "[mesh]\nfile = \"strip.msh\"\nunit = \"40 mm\"\n[output]\nerror_estimate = false\n"
          "[[step]]\nkind = \"modes\"\ncount = 2\n");
  const double wave_speed = std::sqrt(3 * 40e3 * std::pow(0.5e-3, 2) / 12 / 960), L = 40e-3;
  EXPECT_NEAR(found.analyses.at(0).rows.at(0)[2], std::pow(4.73004 / L, 2) * wave_speed, 2e-3 * 22.6);
  EXPECT_NEAR(found.analyses.at(0).rows.at(1)[2], std::pow(7.85320 / L, 2) * wave_speed, 5e-3 * 62.2);
}

/// A lattice whose centre is no centre of symmetry, cut free; its mirror image has columns = [2, 1].
std::string lattice(const std::string& columns, const std::string& rest) {
  return "model = \"planar\"\n[film]\nthickness = \"1 mm\"\nprestretch = 3\n[film.material]\n"
         "shear_modulus = \"45 kPa\"\nrelative_permittivity = 4.5\ndensity = \"960 kg/m^3\"\n"
         "[honeycomb]\nangle = \"130 deg\"\nwall_length = \"8 mm\"\nwall_width = \"0.8 mm\"\n"
         "wall_height = \"2 mm\"\ncolumns = " +
         columns +
         "\n[honeycomb.wall_material]\nyoungs_modulus = \"78 MPa\"\npoisson_ratio = 0.4\n"
         "density = \"1200 kg/m^3\"\n[mesh]\nwall_elements = 3\n[output]\nerror_estimate = false\n"
         "[[step]]\nkind = \"release\"\n" +
         rest;
}

TEST_F(FreeBodies, a_lattice_and_its_mirror_image_vibrate_alike) {
  const std::string modes = "[[step]]\nkind = \"modes\"\ncount = 3\n[[quantity]]\nname = \"omega\"\n"
                            "kind = \"natural frequency\"\nmode = 2\n";
  const Ran one = run(lattice("[1, 2]", modes)), other = run(lattice("[2, 1]", modes));
  for (std::size_t mode = 0; mode < 3; ++mode)
    EXPECT_NEAR(one.analyses.at(0).rows.at(mode)[1], other.analyses.at(0).rows.at(mode)[1],
                1e-3); // two meshes
  EXPECT_NEAR(one.last("omega"), one.analyses.at(0).rows.at(1)[2], 1e-6);
}

std::string displacements() {
  std::string all;
  for (const char* place : {"film", "walls", "left_apex", "right_apex"})
    all += fmt::format("[[quantity]]\nname = \"{0}\"\nkind = \"displacement\"\nof = \"{0}\"\nalong = \"x\"\n"
                       "since = \"release\"\n",
                       place);
  return all;
}

// Walls and film push each other: what the one gains in momentum the other loses.
TEST_F(FreeBodies, voltage_moves_no_centre_of_mass) {
  const Ran moved = run(
      lattice("[1, 2]", displacements() + "[drive]\nvoltage = { wave = \"ramp\", to = \"5 kV\", duration = "
                                          "\"2 ms\" }\n[[step]]\nkind = \"transient\"\nduration = \"4 ms\"\n"
                                          "inertia = true\nrecord = \"1 ms\"\n"));
  const double cell = std::sin(50 * std::numbers::pi / 180) * 8e-3; // half of its height
  const double area = 3 * 2 * cell * (8e-3 + std::sqrt(64e-6 - cell * cell));
  const double film = 960 * 1e-3 * area / 9, walls = 1200 * 0.8e-3 * 2e-3 * (3 * 6 - 3) * 8e-3;
  for (std::size_t row = 2; row < moved.time.size(); ++row) {
    const double of_film = moved.values.at("film")[row], of_walls = moved.values.at("walls")[row];
    EXPECT_GT(std::abs(of_film), 1e-7);
    EXPECT_NEAR(film * of_film, -walls * of_walls, 1e-8 * std::abs(film * of_film)) << row;
  }
  EXPECT_GT(moved.last("left_apex") - moved.last("right_apex"), 3e-4);
}

// Pins hold it again where inertia no longer does, with all of its motion told as heat.
TEST_F(FreeBodies, what_has_moved_freely_comes_to_rest) {
  const std::string drive = "[drive]\nvoltage = { wave = \"ramp\", to = \"5 kV\", duration = \"1 ms\" }\n";
  const std::string moving = "[[step]]\nkind = \"transient\"\nduration = \"2 ms\"\ninertia = true\n";
  const std::string standing = "[[step]]\nkind = \"voltage\"\nname = \"standing\"\nto = \"5 kV\"\n";
  const std::string length =
      "[[quantity]]\nname = \"length\"\nkind = \"distance\"\nbetween = [\"left_apex\", "
      "\"right_apex\"]\n[[quantity]]\nname = \"error\"\nkind = \"energy\"\nof = "
      "\"error\"\n";
  const Ran moved = run(lattice("[1, 2]", length + drive + moving + standing));
  const Ran still = run(lattice("[1, 2]", length + "[drive]\nvoltage = \"5 kV\"\n" + standing));
  EXPECT_NEAR(moved.last("length"), still.last("length"), 1e-9);
  EXPECT_LT(std::abs(moved.last("error")), 1e-7);
  EXPECT_EQ(moved.events.count("came to rest"), 1u);
  EXPECT_EQ(moved.events.count("caught"), 0u);
}

// Slow sines are what static voltages lead to, however slow: rounding is not taken for a drift.
TEST_F(FreeBodies, slow_sines_are_static_but_for_the_drift) {
  const std::string driven = displacements() + "[drive]\nvoltage = \"3 kV\"\n[[step]]\nkind = \"voltage\"\n";
  const auto per_volt = [&](const std::string& from, const std::string& of) {
    const Ran found =
        run(lattice("[1, 2]", driven + "[[step]]\nkind = \"harmonic\"\nfrom = \"" + from +
                                  "\"\nto = \"1 Hz\"\npoints = 2\nresponse_of = \"" + of + "\"\n"));
    const double sign = std::abs(found.analyses.at(0).rows.at(0)[2]) > 90 ? -1 : 1;
    return sign * found.analyses.at(0).rows.at(0)[1];
  };
  const auto apart = [&](const std::string& voltage) {
    const Ran ran = run(lattice("[1, 2]", displacements() + "[drive]\nvoltage = \"" + voltage +
                                              "\"\n[[step]]\nkind = \"voltage\"\n"));
    return ran.last("left_apex") - ran.last("right_apex");
  };
  const double slope = (apart("3001 V") - apart("2999 V")) / 2;
  for (const char* from : {"1e-9 Hz", "1e-3 Hz", "0.5 Hz"})
    EXPECT_NEAR(per_volt(from, "left_apex") - per_volt(from, "right_apex"), slope, 1e-4 * std::abs(slope))
        << from;
  EXPECT_NEAR(per_volt("1e-9 Hz", "film"), per_volt("0.01 Hz", "film"),
              1e-6 * std::abs(per_volt("1e-9 Hz", "film")));
}

// Rigid motions have no part in its linear model either, which has no poles at rest.
TEST_F(FreeBodies, a_linear_model_of_it_answers_as_it_does) {
  write("film.toml",
        lattice("[1, 2]",
                displacements() +
                    "[drive]\nvoltage = \"3 kV\"\n[[step]]\nkind = \"voltage\"\n[linearise]\norder = 20\n"
                    "output = \"left_apex\"\nfrom = \"1 Hz\"\nto = \"200 Hz\"\npoints = 20\n"));
  const Case one = read_case_to_linearise(directory / "film.toml", {});
  EXPECT_EQ(linearise_case(one, {directory / "linear", 1}), ExitCode::ok);
  const auto model = nlohmann::json::parse(content("linear/linear_model.json"));
  EXPECT_LT(model.at("largest_relative_error").get<double>(), 0.01);
  for (const auto& pole : model.at("poles_1_per_s"))
    EXPECT_GT(std::hypot(pole[0].get<double>(), pole[1].get<double>()), 1000) << pole;
}

// A damper to the ground is something that slow sines push against: it all but holds what it is at.
TEST_F(FreeBodies, dampers_take_part_in_slow_sines) {
  const auto at = [&](const std::string& place) {
    const Ran found = run(lattice(
        "[1, 2]", displacements() +
                      "[drive]\nvoltage = \"3 kV\"\n[[point_mass]]\nplace = \"left_apex\"\nmass = \"1 mg\"\n"
                      "damping = \"1 N.s/m\"\n[[step]]\nkind = \"voltage\"\n[[step]]\nkind = \"harmonic\"\n"
                      "from = \"0.1 Hz\"\nto = \"1 Hz\"\npoints = 2\nresponse_of = \"" +
                      place + "\"\n"));
    return found.analyses.at(0).rows.at(0)[1];
  };
  EXPECT_LT(at("left_apex"), 1e-3 * at("right_apex"));
}

// What stays where it is over time is at rest, though nothing holds it; a force would take it along.
TEST_F(FreeBodies, a_device_that_stands_is_at_rest_and_resists_no_force) {
  const std::string standing = "[[step]]\nkind = \"transient\"\nduration = \"1 ms\"\ninertia = true\n";
  const std::string modes = "[[step]]\nkind = \"modes\"\ncount = 1\n";
  const std::string stiffness =
      "[[quantity]]\nname = \"k\"\nkind = \"stiffness\"\nof = \"left_apex\"\nalong = "
      "\"x\"\n";
  const Ran stood = run(lattice("[1, 2]", standing + modes)),
            still = run(lattice("[1, 2]", modes + stiffness));
  EXPECT_NEAR(stood.analyses.at(0).rows.at(0)[1], still.analyses.at(0).rows.at(0)[1], 1e-6);
  EXPECT_TRUE(std::isnan(still.last("k")));
}

TEST_F(FreeBodies, forces_that_would_turn_it_are_refused) {
  const std::string pair = "[[load]]\nplace = \"left_apex\"\nforce = [\"0 N\", \"1 mN\", \"0 N\"]\n"
                           "[[load]]\nplace = \"right_apex\"\nforce = [\"0 N\", \"-1 mN\", \"0 N\"]\n"
                           "[[step]]\nkind = \"force\"\n";
  write("film.toml", lattice("[2, 1, 2]", pair));
  EXPECT_THROW(build_device(read_case(directory / "film.toml")), CaseError);
}

// Where nothing has a mass, the pins hold it in small sines, too.
TEST_F(FreeBodies, without_mass_it_follows_its_voltage_slowly) {
  const Ran found =
      run("model = \"planar\"\n[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 "
          "kPa\"\nrelative_permittivity = 4.7\ndensity = 0\nviscosity = \"1e4 Pa.s\"\n[line]\n"
          "from = [0, 0, 0]\nto = [\"10 mm\", 0, 0]\n[rod]\nwidth = \"5 mm\"\n[drive]\nvoltage = \"1 "
          "kV\"\n[output]\nerror_estimate = false\n[[step]]\nkind = \"voltage\"\n[[step]]\nkind = "
          "\"harmonic\"\nfrom = \"1e-3 Hz\"\nto = \"10 Hz\"\npoints = 2\nresponse_of = \"u\"\n"
          "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\nof = \"end\"\nalong = \"x\"\n");
  EXPECT_GT(found.analyses.at(0).rows.at(0)[1], 0);
  EXPECT_LT(found.analyses.at(0).rows.at(1)[1], 0.1 * found.analyses.at(0).rows.at(0)[1]);
}

// A prestretched rod that is cut free shrinks to 20 mm. Pins that hold it across x strain it where it lies
// elsewhere.
TEST_F(FreeBodies, that_their_pins_would_strain_are_refused) {
  const auto rod = [](double x, double y, const std::string& rest) {
    return fmt::format(
        "[film]\nthickness = \"0.1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = \"50 kPa\"\n"
        "permittivity = \"3e-11 F/m\"\n[line]\nto = [{}, {}, 0]\n[rod]\nwidth = \"10 mm\"\n{}"
        "[[quantity]]\nname = \"length\"\nkind = \"distance\"\nbetween = [\"start\", \"end\"]\n"
        "[output]\nerror_estimate = false\n",
        x, y, rest);
  };
  const std::string release = "[[step]]\nkind = \"release\"\n";
  EXPECT_NEAR(run(rod(30e-3, 0, release)).last("length"), 20e-3, 1e-9);
  EXPECT_NEAR(run(rod(0, 30e-3, release)).last("length"), 20e-3, 1e-9);
  const auto outcome = [&](const std::string& text) {
    write("rod.toml", text);
    const Case one = read_case(directory / "rod.toml");
    return Simulation(one, 1).run({});
  };
  const double slope = 30e-3 / std::sqrt(2);
  const std::string turned = // by a quarter
      fmt::format("[[support]]\nplace = \"start\"\nfix = [\"x\", \"y\"]\nuntil = "
                  "\"turn\"\n[[support]]\nplace = \"end\"\n"
                  "displacement = {{ x = {}, y = {} }}\nuntil = \"turn\"\n[[step]]\nkind = \"move\"\nname = "
                  "\"turn\"\n"
                  "[[step]]\nkind = \"voltage\"\n[drive]\nvoltage = 0\n",
                  -30e-3, 30e-3);
  for (const Outcome& refused : {outcome(rod(slope, slope, release)), outcome(rod(30e-3, 0, turned))}) {
    EXPECT_EQ(refused.ending, Ending::gave_up);
    EXPECT_NE(refused.message.find("what keeps it from turning"), std::string::npos) << refused.message;
  }
}

// Two columns have no symmetry: what keeps them from turning turns them by their strain, and turned columns
// likewise.
TEST_F(FreeBodies, are_measured_alike_however_they_are_turned) {
  const auto turned = [&](int degrees) {
    const Ran ran = run(fmt::format(
        "[part.h]\nturned = \"{} deg\"\n[part.h.film]\nthickness = \"1 mm\"\nprestretch = "
        "3\n[part.h.film.material]\n"
        "shear_modulus = \"45 kPa\"\npermittivity = \"4e-11 F/m\"\n[part.h.honeycomb]\nangle = \"120 deg\"\n"
        "columns = [1, 2]\nwall_length = \"8 mm\"\nwall_width = \"0.8 mm\"\nwall_height = \"1 mm\"\n"
        "[part.h.honeycomb.wall_material]\nyoungs_modulus = \"78 MPa\"\npoisson_ratio = 0.45\n[part.h.mesh]\n"
        "wall_elements = 2\n[drive]\nvoltage = \"5.5 kV\"\n[[step]]\nkind = \"release\"\n[[step]]\nkind = "
        "\"voltage\"\n"
        "[output]\nerror_estimate = false\n",
        degrees));
    return std::array{ran.last("h_eps_x"), ran.last("h_released_length_x")};
  };
  const auto drawn = turned(0);
  for (const int degrees : {90, 180, 270}) {
    const auto now = turned(degrees);
    EXPECT_NEAR(now[0], drawn[0], 1e-6 * drawn[0]) << degrees;
    EXPECT_NEAR(now[1], drawn[1], 1e-6 * drawn[1]) << degrees;
  }
}

} // namespace
} // namespace dielast::cases::free_bodies_test
