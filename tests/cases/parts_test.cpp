// SPDX-License-Identifier: GPL-3.0-or-later
// Cases of several parts: films of their own, places of one mesh, bars along lines.
#include "cases/readers/resolved.hpp"
#include "cases/runs/simulation.hpp"
#include "meshing/gmsh/gmsh_text.hpp"
#include "meshing/honeycomb_mesh.hpp"
#include "meshing/middle_nodes.hpp"
#include "tests/cases/case_test.hpp"

#include <boost/math/tools/roots.hpp>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

namespace dielast::cases::parts_test {
namespace {

class Parts : public test::CaseTest {
 protected:
  std::string mesh_error(const std::string& text) const {
    try {
      build_device(read(text));
    } catch (const std::exception& error) {
      return std::filesystem::path(error.what()).filename(); // without the case's folder
    }
    return "";
  }
};

double root(const std::function<double(double)>& f, double low, double high) {
  boost::uintmax_t iterations = 200;
  const auto found = boost::math::tools::toms748_solve(
      f, low, high, boost::math::tools::eps_tolerance<double>(50), iterations);
  return (found.first + found.second) / 2;
}

struct Patch {
  double modulus, thickness, length, width; ///< Pa, m
  double permittivity = 8.8541878128e-12 * 4;

  /// Force along x of a neo-Hookean patch that is free along y, at the stretch x, under a voltage. The
  /// stretch y makes the nominal stress mu (y - 1/(x^2 y^3)) - eps (phi/H)^2 x^2 y vanish, that along x is mu
  /// (x - 1/(x^3 y^2)) - eps (phi/H)^2 x y^2.
  double force(double x, double voltage) const {
    const double k = permittivity * voltage * voltage / (thickness * thickness);
    const double y =
        root([&](double l) { return modulus * (l - 1 / (x * x * l * l * l)) - k * x * x * l; }, 0.05, 5);
    return thickness * width * (modulus * (x - 1 / (x * x * x * y * y)) - k * x * y * y);
  }
};

const std::string antagonists = R"toml(
[part.left.film]
thickness = "1 mm"
prestretch = [2, 1]
[part.left.film.material]
shear_modulus = "50 kPa"
relative_permittivity = 4
[part.left.patch]
length = "20 mm"
width = "10 mm"
[part.right]
at = ["100 mm", 0, 0]
turned = "180 deg"
[part.right.film]
thickness = "0.5 mm"
prestretch = [1.5, 1]
[part.right.film.material]
shear_modulus = "80 kPa"
relative_permittivity = 4
[part.right.patch]
length = "25 mm"
width = "12 mm"
[[spring]]
between = ["left.right", "right.right"]
along = "x"
stiffness = "30 N/m"
free_length = "5 mm"
[drive.left]
voltage = "6 kV"
[drive.right]
voltage = "3 kV"
[[step]]
kind = "release"
[[step]]
kind = "voltage"
electrode = "left"
increments = 3
)toml";

// Both patches pull with the force of the spring between them; one of them is charged, then the other.
TEST_F(Parts, AntagonisticPatchesAreInTheBalanceOfTheirClosedForms) {
  const Patch left{50e3, 1e-3, 20e-3, 10e-3}, right{80e3, 0.5e-3, 25e-3, 12e-3};
  const auto expect = [&](const std::map<std::string, double>& found, double on_left, double on_right) {
    const auto spring = [&](double x, double z) { return 30 * (100e-3 - 20e-3 * x - 25e-3 * z - 5e-3); };
    const auto stretch_of_right = [&](double x) {
      return root([&](double z) { return right.force(z, on_right) - spring(x, z); }, 0.9, 3.5);
    };
    const double x =
        root([&](double l) { return left.force(l, on_left) - spring(l, stretch_of_right(l)); }, 0.9, 3.5);
    EXPECT_NEAR(found.at("left_stretch_x"), x, 1e-8 * x);
    EXPECT_NEAR(found.at("right_stretch_x"), stretch_of_right(x), 1e-8 * x);
    EXPECT_NEAR(found.at("left_stress_x") * 1e-3 * 10e-3, found.at("right_stress_x") * 0.5e-3 * 12e-3, 1e-9);
  };
  expect(values(antagonists), 6e3, 0);
  expect(values(antagonists +
                "[[step]]\nname = \"other\"\nkind = \"voltage\"\nelectrode = \"right\"\nincrements = 3\n"),
         6e3, 3e3);
}

// A step that names its electrode leaves the other one isolated, as the step before has charged it.
TEST_F(Parts, AStepOfOneElectrodeLeavesTheOthersIsolated) {
  const std::string isolated =
      std::string(antagonists) +
      "[[quantity]]\nname = \"kept\"\nkind = \"charge\"\nof = \"left\"\n"
      "[[step]]\nname = \"other\"\nkind = \"{}\"\nelectrode = \"right\"\nincrements = 3\n{}";
  const std::vector<std::string> charged{"drive.left={charge='80 nC', voltage='1 kV'}",
                                         "step[2].kind='charge'"};
  const auto by_voltage = values(fmt::format(fmt::runtime(isolated), "voltage", ""), charged);
  EXPECT_NEAR(by_voltage.at("kept"), 80e-9, 1e-12 * 80e-9);
  std::vector<std::string> both = charged;
  both.push_back("drive.right={charge='20 nC'}");
  EXPECT_NEAR(values(fmt::format(fmt::runtime(isolated), "charge", ""), both).at("kept"), 80e-9,
              1e-12 * 80e-9);
  const std::string all = "[[step]]\nname = \"all\"\nkind = \"voltage\"\n"; // takes hold of it again
  EXPECT_GT(std::abs(values(fmt::format(fmt::runtime(isolated), "voltage", all), charged).at("kept") - 80e-9),
            1e-3 * 80e-9);
}

TEST_F(Parts, TheirResolvedTextGivesThemAgain) {
  const Case one = read(antagonists);
  write("again.toml", resolved_text(one));
  const Case again = read_case(directory / "again.toml");
  EXPECT_EQ(resolved_text(again), resolved_text(one));
  ASSERT_EQ(again.parts.size(), 2u);
  EXPECT_EQ(again.parts[1].name, "right");
  EXPECT_DOUBLE_EQ(again.parts[1].turned, std::numbers::pi);
  EXPECT_EQ(again.electrodes.at(1).place, "right.film");
}

/// A strip along x of two pieces of film, 10 mm and 20 mm long and 8 mm wide, each of 2 x 2 squares.
meshing::Mesh strip() {
  meshing::Mesh mesh;
  const std::array x{0.0, 5e-3, 10e-3, 20e-3, 30e-3};
  for (int j = 0; j < 3; ++j)
    for (const double at : x) mesh.nodes.emplace_back(at, 4e-3 * j, 0);
  mesh.blocks = {{meshing::CellType::triangle3, {}}};
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 4; ++i) {
      const int a = 5 * j + i, cell = mesh.blocks[0].size();
      auto& nodes = mesh.blocks[0].nodes;
      nodes.insert(nodes.end(), {a, a + 1, a + 6, a, a + 6, a + 5});
      for (const char* place : {"film", i < 2 ? "thin" : "thick"})
        for (const int c : {cell, cell + 1}) mesh.cell_sets[place].cells.push_back(c);
    }
  meshing::add_middle_nodes(mesh);
  meshing::add_node_sets(mesh);
  for (int n = 0; n < mesh.node_count(); ++n) {
    if (mesh.nodes[static_cast<std::size_t>(n)].x() == 0) mesh.node_sets["left"].push_back(n);
    if (mesh.nodes[static_cast<std::size_t>(n)].x() == 30e-3) mesh.node_sets["right"].push_back(n);
  }
  return mesh;
}

const std::string two_thicknesses = R"toml(
[mesh]
file = "strip.msh"
unit = "1 m"
[part.a]
place = "thin"
[part.a.film]
thickness = "0.5 mm"
[part.a.film.material]
shear_modulus = "40 kPa"
relative_permittivity = 4
[part.b]
place = "thick"
[part.b.film]
thickness = "1 mm"
[part.b.film.material]
law = "gent"
shear_modulus = "60 kPa"
stretch_limit = 20
relative_permittivity = 3
[[support]]
place = "film"
fix = ["y"]
[[support]]
place = "left"
fix = ["x"]
[[support]]
place = "right"
displacement = { x = "15 mm" }
[[step]]
kind = "move"
[[quantity]]
name = "pull"
kind = "force"
of = "right"
along = "x"
[[quantity]]
name = "hold"
kind = "force"
of = "left"
along = "x"
[[quantity]]
name = "end"
kind = "displacement"
of = "thin"
along = "x"
)toml";

// Held along y both pieces are in pure shear: one nominal force goes through them, and their lengths add up.
TEST_F(Parts, TwoThicknessesInOneStripCarryOneForce) {
  write("strip.msh", meshing::gmsh_text(strip()));
  const auto at = [](const std::string& name, const std::string& x) {
    return fmt::format(
        "[[quantity]]\nname = \"{}\"\nkind = \"value\"\nof = \"principal_stretches.lambda1\"\npoint = "
        "[\"{} mm\", \"3 mm\", \"0 mm\"]\n",
        name, x);
  };
  const auto found = values(two_thicknesses + at("thin", "7") + at("thick", "22"));
  const auto thin = [](double l) { return 0.5e-3 * 8e-3 * 40e3 * (l - std::pow(l, -3)); };
  const auto thick = [](double l) {
    return 1e-3 * 8e-3 * 60e3 * (l - std::pow(l, -3)) / (1 - (l * l + 1 / (l * l) - 2) / 20);
  };
  const double l = root([&](double a) { return thin(a) - thick((45e-3 - 10e-3 * a) / 20e-3); }, 1, 3);
  EXPECT_NEAR(found.at("pull"), thin(l), 1e-8 * thin(l));
  EXPECT_NEAR(found.at("pull") + found.at("hold"), 0, 1e-10 * thin(l));
  EXPECT_NEAR(found.at("thin"), l, 1e-9);
  EXPECT_NEAR(found.at("thick"), (45e-3 - 10e-3 * l) / 20e-3, 1e-9);
  const Case one = read(two_thicknesses + at("between", "10"));
  EXPECT_THROW(Simulation(one, 1), CaseError); // there it has two values
}

TEST_F(Parts, FilmOfNoPartOverlapsAndWrongPlacesAreErrors) {
  write("strip.msh", meshing::gmsh_text(strip()));
  const auto without = [](std::string text, const std::string& from, const std::string& to) {
    const auto first = text.find(from);
    return text.erase(first, text.find(to) - first);
  };
  const std::string of_one = without(two_thicknesses, "[part.b]", "[[support]]");
  EXPECT_EQ(mesh_error(of_one),
            "8 of the film's 16 elements belong to no part with a film; add [film], or a [part.NAME] with "
            "their place");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = two_thicknesses;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(mesh_error(with("place = \"thick\"", "place = \"film\"")),
            "case.toml:13:9: error: part.b.place: \"film\" overlaps the part \"a\"");
  EXPECT_EQ(mesh_error(with("place = \"thick\"", "place = \"left\"")),
            "case.toml:13:9: error: part.b.place: \"left\" is no film of the mesh");
  meshing::Mesh half = strip(); // with a group of its own that has the name of all
  half.node_sets["film"] = half.node_sets["thin"], half.cell_sets["film"] = half.cell_sets["thin"];
  write("strip.msh", meshing::gmsh_text(half));
  EXPECT_EQ(
      mesh_error("[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\n"
                 "relative_permittivity = 4\n[mesh]\nfile = \"strip.msh\"\nunit = \"1 m\"\n"
                 "[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\n[[step]]\nkind = \"voltage\"\n"),
      "8 of the film's 16 elements belong to no part with a film; [film] is that of the mesh's own group "
      "\"film\": rename the group, or add a [part.NAME] with the others' place");
}

// The lattice of the template, written as a gmsh file and read back with its walls as bars along lines.
TEST_F(Parts, BarsAlongLinesOfAFileAreTheWallsOfTheTemplate) {
  const std::string
      film = "[film]\nmaterial = \"VHB 4910 (honeycomb)\"\nthickness = \"1 mm\"\nprestretch = [4, 2.5]\n"
             "[drive]\nvoltage = \"6 kV\"\n[[step]]\nkind = \"release\"\n[[step]]\nkind = \"voltage\"\n"
             "increments = 2\n",
      lattice = "[honeycomb]\nangle = \"150 deg\"\ncolumns = [2, 1, 2]\nwall_length = \"8 mm\"\n"
                "wall_width = \"0.8 mm\"\nwall_height = \"2 mm\"\n[mesh]\nwall_elements = 4\n";
  const auto expected = values(film + lattice);
  write("lattice.msh", meshing::gmsh_text(build_mesh(read(film + lattice))));
  const auto found = values(film + R"toml(
[mesh]
file = "lattice.msh"
unit = "1 m"
[part.frame]
place = "walls"
[part.frame.beam]
width = "0.8 mm"
height = "2 mm"
[[quantity]]
name = "eps_x"
kind = "elongation"
between = ["left_apex", "right_apex"]
along = "x"
since = "release"
[[quantity]]
name = "eps_y"
kind = "elongation"
between = ["corner_bottom", "corner_top"]
along = "y"
since = "release"
)toml");
  for (const char* name : {"eps_x", "eps_y", "yield_ratio", "stored_energy", "max_field", "capacitance"})
    EXPECT_NEAR(found.at(name), expected.at(name), 1e-10 * std::abs(expected.at(name))) << name;
}

// Turned round, a patch is pulled and stretched the other way, and says the numbers of the one that is not.
TEST_F(Parts, ATurnedPatchIsTheSamePatch) {
  const auto patch = [&](const std::string& at, const std::string& drive) {
    return values("[part.p]\n" + at +
                  "[part.p.film]\nthickness = \"1 mm\"\nprestretch = [1.5, 1.2]\n[part.p.film.material]\n"
                  "shear_modulus = \"50 kPa\"\nrelative_permittivity = 4\n[part.p.patch]\nlength = \"20 "
                  "mm\"\nwidth = \"10 mm\"\n" +
                  drive);
  };
  for (const char* drive : {"stretch_x = 2\nstretch_y = 1.1\n[[step]]\nkind = \"move\"\n",
                            "stress_x = \"60 kPa\"\nstress_y = \"-5 kPa\"\n[[step]]\nkind = \"force\"\n"}) {
    const auto straight = patch("", drive), turned = patch("at = [0.1, 0, 0]\nturned = \"180 deg\"\n", drive);
    for (const char* name : {"p_stretch_x", "p_stretch_y", "p_stress_x", "p_stress_y"})
      EXPECT_NEAR(turned.at(name), straight.at(name), 1e-9 * std::abs(straight.at(name)) + 1e-6)
          << name << drive;
  }
  EXPECT_NEAR(patch("turned = \"180 deg\"\n", "stretch_x = 2\n[[step]]\nkind = \"move\"\n").at("p_stretch_x"),
              2, 1e-12);
}

// Its own x and y are meant, wherever they point to.
TEST_F(Parts, StandardQuantitiesTurnWithTheirPart) {
  const auto honeycomb = [&](const std::string& turned) {
    return values("[part.a]\nturned = \"" + turned +
                  "\"\n[part.a.film]\nmaterial = \"VHB 4910 (honeycomb)\"\nthickness = \"0.5 mm\"\n"
                  "prestretch = 1.4\n[part.a.honeycomb]\nangle = \"130 deg\"\ncolumns = [1, 2, 1]\n"
                  "wall_length = \"6 mm\"\nwall_width = \"0.6 mm\"\nwall_height = \"2 "
                  "mm\"\n[part.a.mesh]\nwall_elements = 2\n[[support]]\nplace = "
                  "\"a.left_apex\"\nfix = [\"x\", \"y\", \"turn_z\"]\n[drive]\nvoltage = \"2 kV\"\n"
                  "[[step]]\nkind = \"release\"\n[[step]]\nkind = \"voltage\"\n");
  };
  const auto straight = honeycomb("0 deg");
  for (const char* turned : {"90 deg", "37 deg", "-180 deg"}) {
    const auto found = honeycomb(turned);
    for (const char* name : {"a_eps_x", "a_eps_y", "a_released_length_x", "a_released_length_y"})
      EXPECT_NEAR(found.at(name), straight.at(name), 1e-9 * std::abs(straight.at(name))) << name << turned;
  }
  const auto rectangle = [&](const std::string& turned) {
    return values("[part.r]\nturned = \"" + turned +
                  "\"\n[part.r.film]\nthickness = \"1 mm\"\nprestretch = 2.5\n[part.r.film.material]\n"
                  "shear_modulus = \"50 kPa\"\nrelative_permittivity = 4\n[part.r.rectangle]\nlength = \"40 "
                  "mm\"\nwidth = \"20 mm\"\nelectrode_length = \"20 mm\"\nelectrode_width = \"10 mm\"\n"
                  "[part.r.mesh]\nacross = 8\n[drive]\nvoltage = \"3 kV\"\n");
  };
  const auto upright = rectangle("270 deg"), lying = rectangle("0 deg"), askew = rectangle("10 deg");
  EXPECT_GT(std::abs(lying.at("r_strain_x") / lying.at("r_strain_y") - 1), 0.1);
  for (const char* name : {"r_strain_x", "r_strain_y"}) {
    EXPECT_NEAR(upright.at(name), lying.at(name), 1e-9) << name;
    EXPECT_FALSE(askew.contains(name)) << name;
  }
  EXPECT_NEAR(askew.at("r_areal_strain"), lying.at("r_areal_strain"), 1e-9);
}

const std::string two_discs = R"toml(
[part.a.film]
material = "VHB 4910 (honeycomb)"
thickness = "1 mm"
[part.a.disc]
radius = "20 mm"
electrode_radius = "10 mm"
[part.a.mesh]
rings = 4
[part.b]
at = [0.1, 0, 0]
[part.b.film]
material = "VHB 4910 (honeycomb)"
thickness = "1 mm"
[part.b.patch]
)toml";

TEST_F(Parts, PlacesHaveThePartInTheirName) {
  const Device device = build_device(read(two_discs));
  for (const char* place : {"a", "b", "a.rim", "a.electrode", "b.left", "b.film"})
    EXPECT_TRUE(device.mesh.node_sets.contains(place)) << place;
  EXPECT_EQ(device.mesh.node_sets.at("b").size(), 9u); // triangles of the disc's order
  EXPECT_NEAR(device.mesh.nodes[static_cast<std::size_t>(device.mesh.node_sets.at("b.right")[0])].x(), 0.11,
              1e-15);
}

// A tie makes one node of two; what does not meet cannot be tied.
TEST_F(Parts, TiesJoinNodesThatCoincide) {
  const std::string apart = "[[tie]]\nbetween = [\"a.rim\", \"b.left\"]\n";
  EXPECT_NE(mesh_error(two_discs + apart)
                .find("\"a.rim\" and \"b.left\" cannot be tied: the node at (0.1, 0, 0) m"),
            std::string::npos)
      << mesh_error(two_discs + apart);
  std::string pair = antagonists;
  const std::string far = "at = [\"100 mm\", 0, 0]", near = "at = [\"77.5 mm\", \"10 mm\", 0]";
  pair.replace(pair.find(far), far.size(), near); // 20 mm x 2 + 25 mm x 1.5
  pair.replace(pair.find("width = \"12 mm\""), 15, "width = \"10 mm\"");
  pair.replace(pair.find("\"5 mm\""), 6, "\"0 mm\""); // the spring's ends meet: it pulls
  const auto nodes = [&](const std::string& text) { return build_device(read(text)).mesh.node_count(); };
  EXPECT_EQ(nodes(pair), 8);
  EXPECT_EQ(nodes(pair + "[[tie]]\nbetween = [\"left.right\", \"right.right\"]\n"), 6);
}

} // namespace
} // namespace dielast::cases::parts_test
