// SPDX-License-Identifier: GPL-3.0-or-later
// Shells that a mesh file draws curved, or in another plane than that of x and y.
#include "cases/devices/device.hpp"
#include "cases/text/diagnostics.hpp"
#include "meshing/gmsh/gmsh_text.hpp"
#include "meshing/middle_nodes.hpp"
#include "tests/cases/case_test.hpp"
#include "tests/cases/values_at_end.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>
#include <vector>

namespace dielast::cases::curved_shells_test {
namespace {

using Eigen::Vector3d;
using Map = std::function<Vector3d(double, double)>;

/// Triangles of 6 nodes on the unit square, moved by `map`; its sides are the places u0, u1, v0 and v1, of
/// which u0 has lines. `facets`: with straight sides.
meshing::Mesh surface(int along, int across, const Map& map, bool facets = false) {
  meshing::Mesh mesh;
  const auto number = [across](int i, int j) { return i * (across + 1) + j; };
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= across; ++j)
      mesh.nodes.emplace_back(static_cast<double>(i) / along, static_cast<double>(j) / across, 0);
  meshing::CellBlock film{meshing::CellType::triangle3, {}}, lines{meshing::CellType::line2, {}};
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const int a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1), d = number(i, j + 1);
      film.nodes.insert(film.nodes.end(), {a, b, c, a, c, d});
    }
  meshing::CellSet edge{1, {}};
  for (int j = 0; j < across; ++j) {
    edge.cells.push_back(lines.size());
    lines.nodes.insert(lines.nodes.end(), {number(0, j), number(0, j + 1)});
  }
  mesh.blocks = {film, lines};
  meshing::CellSet all{0, {}};
  for (int c = 0; c < film.size(); ++c) all.cells.push_back(c);
  mesh.cell_sets["film"] = all;
  mesh.cell_sets["rib"] = edge;
  if (!facets) meshing::add_middle_nodes(mesh);
  const std::vector<Vector3d> drawn = mesh.nodes;
  for (Vector3d& x : mesh.nodes) x = map(x.x(), x.y());
  if (facets) meshing::add_middle_nodes(mesh);
  meshing::add_node_sets(mesh);
  for (int n = 0; n < std::ssize(drawn); ++n) {
    const Vector3d& x = drawn[static_cast<std::size_t>(n)];
    if (x.x() == 0) mesh.node_sets["u0"].push_back(n);
    if (x.x() == 1) mesh.node_sets["u1"].push_back(n);
    if (x.y() == 0) mesh.node_sets["v0"].push_back(n);
    if (x.y() == 1) mesh.node_sets["v1"].push_back(n);
  }
  return mesh;
}

constexpr double radius = 10e-3, length = 8e-3;

/// A quarter of a tube about z.
Vector3d quarter(double u, double v) {
  const double angle = u * std::numbers::pi / 2;
  return {radius * std::cos(angle), radius * std::sin(angle), length * v};
}

const std::string of_tube = R"toml(
model = "3d"
[mesh]
file = "film.msh"
unit = "1 m"
[film]
thickness = "50 um"
section = "shell"
[film.material]
shear_modulus = "1 MPa"
permittivity = "2.5e-11 F/m"
)toml";

/// Of which a test wants no more than the device.
const std::string held =
    "[[support]]\nplace = \"u0\"\nfix = [\"x\", \"y\", \"z\"]\n[[step]]\nkind = \"release\"\n";

/// An edge in a plane of symmetry across an axis.
std::string mirrored(const std::string& place, const std::string& across) {
  std::string fix = fmt::format("\"{}\"", across);
  for (const std::string axis : {"x", "y", "z"})
    if (axis != across) fix += fmt::format(", \"turn_{}\"", axis);
  return fmt::format("[[support]]\nplace = \"{}\"\nfix = [{}]\n", place, fix);
}

std::string displacement(const std::string& name, const std::string& of, const std::string& along) {
  return fmt::format("[[quantity]]\nname = \"{}\"\nkind = \"displacement\"\nof = \"{}\"\nalong = \"{}\"\n",
                     name, of, along);
}

class CurvedShells : public test::CaseTest {
 protected:
  void draw(const meshing::Mesh& mesh) const { write("film.msh", meshing::gmsh_text(mesh)); }
  /// What is wrong with a case, "" if nothing is.
  std::string refusal(const std::string& text) const {
    try {
      build_device(read(text));
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  }
};

// Free in its surface, it grows by one stretch: mu (l^2 - l^-4) = eps (l^2 Phi/H)^2, but for (H/R)^2.
TEST_F(CurvedShells, a_charged_tube_grows_as_flat_film) {
  draw(surface(12, 4, quarter));
  const auto end = values(of_tube + mirrored("u0", "y") + mirrored("u1", "x") + mirrored("v0", "z") +
                          R"toml([[electrode]]
name = "on"
place = "film"
[drive]
voltage = "5 kV"
[[step]]
kind = "voltage"
increments = 4
)toml" + displacement("wider", "u0", "x") +
                          displacement("longer", "v1", "z"));
  const double k = 2.5e-11 * std::pow(5e3 / 50e-6, 2) / 1e6;
  double stretch = 1;
  for (int i = 0; i < 50; ++i) // of l^2 - l^-4 = k l^4
    stretch -= (std::pow(stretch, 2) - std::pow(stretch, -4) - k * std::pow(stretch, 4)) /
               (2 * stretch + 4 * std::pow(stretch, -5) - 4 * k * std::pow(stretch, 3));
  EXPECT_GT(stretch, 1.04);
  EXPECT_NEAR(end.at("wider"), (stretch - 1) * radius, 2e-3 * (stretch - 1) * radius);
  EXPECT_NEAR(end.at("longer"), (stretch - 1) * length, 2e-3 * (stretch - 1) * length);
}

// Layers beside the drawn surface, and what they weigh: beside it on the side of its normal, wherever that
// points. A strip that lies and one that stands, of which only the axes have other names.
TEST_F(CurvedShells, a_standing_strip_bends_as_a_lying_one) {
  const std::string rest = R"toml(
model = "3d"
[mesh]
file = "film.msh"
unit = "1 m"
[film]
thickness = "0.4 mm"
offset = "1.5 mm"
section = "shell"
[film.material]
shear_modulus = "0.3 MPa"
permittivity = "2.5e-11 F/m"
density = "2000 kg/m^3"
[[electrode]]
name = "on"
place = "film"
[drive]
voltage = "4 kV"
[[support]]
place = "u0"
fix = ["x", "y", "z", "turn_x", "turn_y", "turn_z"]
[[step]]
kind = "weight"
increments = 2
[[step]]
kind = "voltage"
increments = 2
[[step]]
kind = "modes"
)toml";
  const auto asked = [](const char* along, const char* across) {
    return displacement("sinks", "u1", across) + displacement("shortens", "u1", along) +
           "[[quantity]]\nname = \"slow\"\nkind = \"natural frequency\"\nmode = 3\n";
  };
  draw(surface(8, 2, [](double u, double v) { return Vector3d(20e-3 * u, 5e-3 * v, 0); }));
  const auto lying = values(rest + "[gravity]\nfilm = true\ndirection = [1, 0.3, -0.2]\n" + asked("x", "z"));
  // x -> z, y -> x, z -> y
  draw(surface(8, 2, [](double u, double v) { return Vector3d(5e-3 * v, 0, 20e-3 * u); }));
  const auto standing =
      values(rest + "[gravity]\nfilm = true\ndirection = [0.3, -0.2, 1]\n" + asked("z", "y"));
  EXPECT_GT(std::abs(lying.at("sinks")), 1e-4);
  for (const auto& [name, value] : lying)
    EXPECT_NEAR(standing.at(name), value, 1e-8 * std::abs(value)) << name;
}

// The rim of a quarter of a dome holds the pressure on what it covers, and the dome rises, whichever way the
// file turns its triangles.
TEST_F(CurvedShells, a_pressure_lifts_a_dome) {
  constexpr double width = 10e-3, height = 3e-3, pressure = 400;
  const auto of = [](double x) { return std::cos(x * std::numbers::pi / 2); };
  std::vector<std::map<std::string, double>> ends;
  for (const bool turned : {false, true}) {
    meshing::Mesh dome = surface(6, 6, [&](double u, double v) {
      const Vector3d x(width * u, width * v, height * of(u) * of(v));
      return turned ? Vector3d(x.y(), x.x(), x.z()) : x;
    });
    std::vector<int>& rim = dome.node_sets["rim"];
    std::ranges::set_union(dome.node_sets.at("u1"), dome.node_sets.at("v1"), std::back_inserter(rim));
    dome.node_sets["top"] = {0};
    draw(dome);
    ends.push_back(values(of_tube + mirrored(turned ? "v0" : "u0", "x") +
                          mirrored(turned ? "u0" : "v0", "y") + displacement("lift", "top", "z") +
                          fmt::format(R"toml([[support]]
place = "rim"
fix = ["x", "y", "z"]
[chamber]
pressure = "{} Pa"
[[step]]
kind = "pressure"
increments = 2
[[quantity]]
name = "held"
kind = "force"
of = "rim"
along = "z"
)toml",
                                      pressure)));
    EXPECT_GT(ends.back().at("lift"), 1e-6);
    EXPECT_NEAR(std::abs(ends.back().at("held")), pressure * width * width, 1e-8 * pressure * width * width);
  }
  EXPECT_NEAR(ends[1].at("lift"), ends[0].at("lift"), 0.02 * ends[0].at("lift")); // diagonals the other way
}

TEST_F(CurvedShells, what_must_be_drawn_flat_is_told_at_its_key) {
  draw(surface(6, 4, quarter));
  std::string membrane = of_tube + held;
  membrane.replace(membrane.find("section = \"shell\"\n"), 18, "");
  EXPECT_NE(refusal(membrane).find("film.section"), std::string::npos) << refusal(membrane);
  std::string stretched = of_tube + held;
  stretched.insert(stretched.find("section"), "prestretch = 1.1\n");
  EXPECT_NE(refusal(stretched).find("film.prestretch: a shell that is not drawn"), std::string::npos)
      << refusal(stretched);
  const std::string ribbed = of_tube + held +
                             "[part.rib]\nplace = \"rib\"\n[part.rib.beam]\nwidth = \"0.4 mm\"\nheight = \"1 "
                             "mm\"\nmaterial = \"TPU 78 MPa\"\n";
  EXPECT_NE(refusal(ribbed).find("part.rib.place: found a beam on film"), std::string::npos)
      << refusal(ribbed);
  EXPECT_EQ(refusal(of_tube + held), "");
}

TEST_F(CurvedShells, what_is_too_thick_or_lies_too_far_beside_its_surface_is_refused) {
  draw(surface(6, 4, quarter));
  std::string thick = of_tube + held;
  thick.replace(thick.find("50 um"), 5, "3 mm");
  EXPECT_NE(refusal(thick).find("film.thickness: 3.000 mm on a radius of"), std::string::npos)
      << refusal(thick);
  std::string layered = of_tube + held;
  layered.insert(layered.find("[film.material]"),
                 "layer = [{ name = \"upper\", thickness = \"250 um\", material = { shear_modulus = \"1 "
                 "MPa\", permittivity = \"2.5e-11 F/m\" } }]\n");
  EXPECT_NE(refusal(layered).find("film.layer[1].thickness: 300.0 µm on a radius of"), std::string::npos)
      << refusal(layered);
  const auto with_offset = [&](const char* offset) {
    std::string text = of_tube + held;
    return text.insert(text.find("section"), fmt::format("offset = \"{}\"\n", offset));
  };
  EXPECT_EQ(refusal(with_offset("20 um")), "");
  EXPECT_NE(refusal(with_offset("40 um")).find("film.offset: the middle of its layers is 40.00 µm beside"),
            std::string::npos)
      << refusal(with_offset("40 um"));
}

// At rest, at every depth.
TEST_F(CurvedShells, have_no_strain_as_drawn) {
  draw(surface(3, 2, quarter));
  std::string thick = of_tube + held;
  thick.replace(thick.find("50 um"), 5, "1 mm");
  const Device device = build_device(read(thick));
  const fem::Samples samples = device.model.sample(device.model.initial_state());
  ASSERT_FALSE(samples.film.empty());
  for (const fem::MembraneSample& sample : samples.film)
    EXPECT_LT((sample.F.transpose() * sample.F - Eigen::Matrix2d::Identity()).norm(),
              1e-7); // (H/2)/R is 0.05
}

TEST_F(CurvedShells, which_side_is_above_is_told_of_what_stands) {
  const auto told = [&](const std::string& text) {
    const Device device = build_device(read(text));
    return std::ranges::any_of(device.warnings, [](const std::string& warning) {
      return warning.find("film.offset: the film is not drawn with one side upwards") != std::string::npos;
    });
  };
  std::string beside = of_tube + held;
  beside.insert(beside.find("section"), "offset = \"10 um\"\n");
  draw(surface(6, 4, quarter));
  EXPECT_FALSE(told(of_tube + held));
  EXPECT_TRUE(told(beside));
  draw(surface(6, 4, [](double u, double v) { return Vector3d(10e-3 * u, 8e-3 * v, 3e-3 * u * u); }));
  EXPECT_FALSE(told(beside));
}

TEST_F(CurvedShells, flat_facets_are_told) {
  const auto told = [&] {
    const Device device = build_device(read(of_tube + held));
    return std::ranges::any_of(device.warnings, [](const std::string& warning) {
      return warning.find("flat facets, 15 deg") != std::string::npos;
    });
  };
  draw(surface(6, 4, quarter));
  EXPECT_FALSE(told());
  draw(surface(6, 4, quarter, true));
  EXPECT_TRUE(told());
}

/// The gallery's hinged roof, half as thick and `scale` times as large, under stresses as they are: its load
/// changes its direction on the way from one stable shape to the other.
double deflection_of_thin_roof(double scale, const std::string& on_instability) {
  return test::values_at_end(
             read_case(std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/shells/roof.toml",
                       {fmt::format("mesh.unit={} mm", scale),
                        fmt::format("film.thickness={} mm", 6.35 * scale),
                        fmt::format("load[1].force=[0, 0, {}]", -812.625 * scale * scale),
                        "step.force.on_instability=" + on_instability}))
      .at("deflection");
}

TEST_F(CurvedShells, a_thin_roof_is_followed_to_where_it_jumps_whatever_its_size) {
  const double jumped = deflection_of_thin_roof(1, "jump");
  EXPECT_LT(jumped, -35e-3);
  EXPECT_NEAR(deflection_of_thin_roof(1, "follow"), jumped, 1e-6 * std::abs(jumped));
  EXPECT_NEAR(deflection_of_thin_roof(0.01, "jump"), 0.01 * jumped, 1e-8 * std::abs(jumped));
}

} // namespace
} // namespace dielast::cases::curved_shells_test
