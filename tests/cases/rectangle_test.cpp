// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/device.hpp"
#include "cases/devices/discretisation.hpp"
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dielast::cases::rectangle_test {
namespace {

constexpr double mu = 40e3, permittivity = 4 * 8.8541878128e-12, thickness = 1e-3, prestretch = 2;

class RectangleTest : public test::ScratchTest {
 protected:
  Case read(const std::string& rectangle, const std::string& rest,
            const std::vector<std::string>& overrides = {}) const {
    write("rectangle.toml",
          "[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nshear_modulus = \"40 "
          "kPa\"\nrelative_permittivity = 4\n[rectangle]\n" +
              rectangle + rest);
    return read_case(directory / "rectangle.toml", overrides);
  }
  static double last(const Case& one, const Simulation& simulation, const std::string& name) {
    const auto found = std::ranges::find(one.quantities, name, &Quantity::name);
    return simulation.results().at(static_cast<std::size_t>(found - one.quantities.begin()));
  }
};

TEST_F(RectangleTest, PlacesAreWhereTheyAreSaidToBe) {
  const Case one =
      read("length = \"40 mm\"\nwidth = \"20 mm\"\nelectrode_length = \"10 mm\"\nelectrode_width = "
           "\"8 mm\"\n",
           "[drive]\nvoltage = \"1 kV\"\n[mesh]\nacross = 10\n");
  const meshing::Mesh mesh = build_mesh(one);
  const auto box = [&](const char* place) {
    Eigen::AlignedBox2d all;
    for (const int n : mesh.node_sets.at(place))
      all.extend(mesh.nodes[static_cast<std::size_t>(n)].head<2>());
    return all;
  };
  const auto spans = [&](const char* place, double x0, double x1, double y0, double y1) {
    const Eigen::AlignedBox2d all = box(place);
    EXPECT_LT((all.min() - Eigen::Vector2d(x0, y0)).norm() + (all.max() - Eigen::Vector2d(x1, y1)).norm(),
              1e-12)
        << place << " " << all.min().transpose() << " " << all.max().transpose();
  };
  spans("film", -0.02, 0.02, -0.01, 0.01);
  spans("frame", -0.02, 0.02, -0.01, 0.01);
  spans("left", -0.02, -0.02, -0.01, 0.01);
  spans("right", 0.02, 0.02, -0.01, 0.01);
  spans("bottom", -0.02, 0.02, -0.01, -0.01);
  spans("top", -0.02, 0.02, 0.01, 0.01);
  spans("electrode", -0.005, 0.005, -0.004, 0.004);
  spans("electrode_edge", -0.005, 0.005, -0.004, 0.004);
  spans("centre", 0, 0, 0, 0);
  for (const auto& x : mesh.nodes) EXPECT_EQ(x.z(), 0);
  const meshing::CellBlock& film = *mesh.film();
  for (int c = 0; c < film.size(); ++c) { // counter-clockwise about +z
    const auto nodes = film.cell(c);
    const auto at = [&](int a) {
      return mesh.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])];
    };
    EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).z(), 0);
  }
}

// Sides along x slide: film under the electrode and beside it are each homogeneous, and pull alike.
TEST_F(RectangleTest, TwoStretchesAsOfTwoPiecesInARow) {
  const Case one = read("length = \"40 mm\"\nwidth = \"20 mm\"\nelectrode_length = \"10 mm\"\n",
                        "[drive]\nvoltage = \"6 kV\"\n[mesh]\nacross = 4\n"
                        "[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\n"
                        "[[support]]\nplace = \"right\"\nfix = [\"x\", \"y\"]\n"
                        "[[support]]\nplace = \"bottom\"\nfix = [\"y\"]\n"
                        "[[support]]\nplace = \"top\"\nfix = [\"y\"]\n");
  Simulation simulation(one, 1);
  ASSERT_EQ(simulation.run({}).ending, Ending::complete);
  const auto pull = [](double stretch, double voltage) { // nominal stress along x
    const double field = voltage * stretch * prestretch / thickness;
    return (mu * (stretch * stretch - 1 / std::pow(stretch * prestretch, 2)) - permittivity * field * field) /
           stretch;
  };
  const double covered = 10e-3 / prestretch, free = 30e-3 / prestretch; // unstretched
  double low = prestretch, high = 40e-3 / covered * 0.9;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2, beside = (40e-3 - covered * middle) / free;
    (pull(middle, 6e3) < pull(beside, 0) ? low : high) = middle;
  }
  const double strain = low / prestretch - 1;
  EXPECT_GT(strain, 0.05);
  EXPECT_NEAR(last(one, simulation, "strain_x"), strain, 1e-8);
  EXPECT_NEAR(last(one, simulation, "areal_strain"), strain, 1e-8);
  EXPECT_NEAR(last(one, simulation, "strain_y"), 0, 1e-12);
}

// A film in a frame that is all electrode has nowhere to go.
TEST_F(RectangleTest, AllElectrodeStays) {
  for (const std::string model : {"planar", "3d"}) {
    const Case one =
        read("length = \"20 mm\"\n", "[drive]\nvoltage = \"2 kV\"\n[mesh]\nacross = 4\n", {"model=" + model});
    Simulation simulation(one, 1);
    ASSERT_EQ(simulation.run({}).ending, Ending::complete) << model;
    EXPECT_NEAR(last(one, simulation, "areal_strain"), 0, 1e-12);
    const double h = thickness / (prestretch * prestretch);
    EXPECT_NEAR(last(one, simulation, "capacitance"), permittivity * 4e-4 / h,
                1e-9 * permittivity * 4e-4 / h);
  }
}

// Charges of thousands of elements that are alike are all rounded to the same side.
TEST_F(RectangleTest, AllElectrodeTakesAnyCharge) {
  const double capacitance = permittivity * 4e-4 / (thickness / (prestretch * prestretch));
  for (const double charge : {5.5727874816597936e-08, 2.5500060900863998e-8, 2.55e-8, 4.4e-12}) {
    const Case one = read("length = \"40 mm\"\nwidth = \"10 mm\"\n",
                          fmt::format("[drive]\ncharge = {}\n[[step]]\nkind = \"charge\"\n", charge));
    Simulation simulation(one, 1);
    const Outcome outcome = simulation.run({});
    ASSERT_EQ(outcome.ending, Ending::complete) << charge << " " << outcome.message;
    EXPECT_NEAR(simulation.state().voltage[0], charge / capacitance, 1e-9 * charge / capacitance);
  }
}

TEST_F(RectangleTest, TurnedByARightAngleItIsTheSame) {
  const std::string rest = "[drive]\nvoltage = \"5 kV\"\n[mesh]\nacross = ";
  const Case flat =
      read("length = \"40 mm\"\nwidth = \"20 mm\"\nelectrode_length = \"16 mm\"\nelectrode_width = "
           "\"8 mm\"\n",
           rest + "16\n");
  const Case high =
      read("length = \"20 mm\"\nwidth = \"40 mm\"\nelectrode_length = \"8 mm\"\nelectrode_width = "
           "\"16 mm\"\n",
           rest + "32\n");
  Simulation one(flat, 1), other(high, 1);
  ASSERT_EQ(one.run({}).ending, Ending::complete);
  ASSERT_EQ(other.run({}).ending, Ending::complete);
  const double x = last(flat, one, "strain_x"), y = last(flat, one, "strain_y");
  EXPECT_GT(x, 0.005);
  EXPECT_GT(y, x);
  EXPECT_NEAR(last(high, other, "strain_y"), x, 2e-3 * x);
  EXPECT_NEAR(last(high, other, "strain_x"), y, 2e-3 * y);
}

// Film that is slack along y carries waves along x of any shape across, all of one frequency.
TEST_F(RectangleTest, WavesOfFilmThatIsSlackAcrossThemAreFound) {
  for (const char* across : {"10", "12"}) {
    const Case one =
        read("length = \"60 mm\"\n",
             "[mesh]\nacross = 4\n[[step]]\nkind = \"release\"\n[[step]]\nkind = \"modes\"\ncount = 1\n"
             "[[quantity]]\nname = \"w\"\nkind = \"natural frequency\"\n[output]\nerror_estimate = false\n",
             {"model=3d", "film.wrinkling=tension field", "film.prestretch=[1.4, 0.8]",
              "film.material.density=1000 kg/m^3", std::string("mesh.across=") + across});
    Simulation simulation(one, 1);
    ASSERT_EQ(simulation.run({}).ending, Ending::complete);
    const double stress = mu * (1.4 * 1.4 - 1 / 1.4), length = 60e-3;
    EXPECT_NEAR(last(one, simulation, "w"), std::numbers::pi / length * std::sqrt(stress / 1000), 0.02)
        << across;
  }
}

TEST_F(RectangleTest, HasCoarserMeshes) {
  const Case one = read("length = \"40 mm\"\n", "[drive]\nvoltage = \"5 kV\"\n");
  const auto others = other_discretisations(one);
  ASSERT_EQ(others.size(), 2U);
  EXPECT_EQ(others[0].one.parts[0].mesh.across, 16);
  EXPECT_EQ(others[0].size, 2);
}

} // namespace
} // namespace dielast::cases::rectangle_test
