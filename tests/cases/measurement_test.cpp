// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/quantities/measurement.hpp"
#include "cases/readers/reader.hpp"
#include "fem/equilibrium/equilibrium.hpp"
#include "tests/cases/scratch.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::cases::measurement_test {
namespace {

/// A small disc as clamped at 5 kV, every kind of quantity read at a deformation of our choice.
class DiscMeasurement : public test::ScratchTest {
 protected:
  void SetUp() override {
    ScratchTest::SetUp();
    write("measured.toml", test::small_disc + R"(
[[quantity]]
name = "rim"
kind = "radius"
of = "rim"
[[quantity]]
name = "moved"
kind = "displacement"
of = "centre"
[[quantity]]
name = "moved_y"
kind = "displacement"
of = "centre"
along = "y"
[[quantity]]
name = "force_x"
kind = "force"
of = "rim"
along = "x"
[[quantity]]
name = "force_y"
kind = "force"
of = "rim"
along = "y"
[[quantity]]
name = "charge"
kind = "charge"
of = "film"
[[quantity]]
name = "gap"
kind = "distance"
between = ["centre", "rim"]
[[quantity]]
name = "thinnest"
kind = "extreme"
of = "thickness"
extreme = "minimum"
)");
    one = read_case(directory / "measured.toml");
    device.emplace(build_device(one));
    state = device->model.initial_state();
    state.voltage = {5000};
  }
  double value(const std::string& name) {
    fem::Equilibrium equilibrium(device->model, 1);
    fem::EnergyBalance energy;
    energy.add(fem::energy_point(equilibrium, state, 0));
    const std::vector<double> all =
        Measurement(one, *device).all(Measured(*device, equilibrium, state, energy));
    for (std::size_t q = 0; q < all.size(); ++q)
      if (one.quantities[q].name == name) return all[q];
    ADD_FAILURE() << name;
    return 0;
  }
  /// Area of the electrode's polygonal or curved triangles, m^2.
  double electrode_area() const {
    double area = 0;
    const fem::Samples samples = device->model.sample(state);
    for (const auto& s : samples.film)
      if (s.electrode == 0) area += s.volume * 9 / s.thickness; // stretched 3 x 3 as drawn
    return area;
  }

  Case one;
  std::optional<Device> device;
  fem::State state;
};

TEST_F(DiscMeasurement, AsClamped) {
  EXPECT_NEAR(value("electrode_radius"), 0.03, 2e-8);
  EXPECT_NEAR(value("rim"), 0.09, 1e-7);
  EXPECT_EQ(value("moved"), 0);
  EXPECT_NEAR(value("gap"), 0, 1e-12); // of their centroids
  EXPECT_NEAR(value("thinnest"), 1e-3 / 9, 1e-12);
  EXPECT_NEAR(value("max_field"), 5000 * 9 / 1e-3, 1e-3);
  EXPECT_NEAR(value("force_x"), 0, 1e-9);
}

// C = eps A / h of a flat film; the mesh's circle is a little off the true one.
TEST_F(DiscMeasurement, CapacitanceAndCharge) {
  const double h = 1e-3 / 9;
  EXPECT_NEAR(electrode_area(), std::numbers::pi * 9e-4, 1e-3 * std::numbers::pi * 9e-4);
  const double capacitance = 4e-11 * electrode_area() / h;
  EXPECT_NEAR(value("capacitance"), capacitance, 1e-12 * capacitance);
  EXPECT_NEAR(value("charge"), 5000 * capacitance, 1e-12 * 5000 * capacitance);
}

// Stretched by lambda_1 and lambda_2 the area grows by their product, the thickness falls by it.
TEST_F(DiscMeasurement, CapacitanceGrowsWithTheSquareOfTheArea) {
  const double before = value("capacitance"), a = 1.2, b = 1.1;
  for (std::size_t n = 0; n < device->mesh.nodes.size(); ++n) {
    const Eigen::Vector3d& x = device->mesh.nodes[n];
    state.displacement[n] = {(a - 1) * x.x(), (b - 1) * x.y(), 0};
  }
  EXPECT_NEAR(value("capacitance"), before * std::pow(a * b, 2), 1e-9 * before);
  EXPECT_NEAR(value("thinnest"), 1e-3 / 9 / (a * b), 1e-12);
}

TEST_F(DiscMeasurement, DisplacementOfAPlace) {
  const int centre = device->mesh.node_sets.at("centre")[0];
  state.displacement[static_cast<std::size_t>(centre)] = {3e-4, -4e-4, 0};
  EXPECT_DOUBLE_EQ(value("moved"), 5e-4);
  EXPECT_DOUBLE_EQ(value("moved_y"), -4e-4);
}

// The rim's reaction balances a dead force in the film: what the support exerts on the device.
TEST_F(DiscMeasurement, ForceOfASupportBalancesTheLoad) {
  fem::Equilibrium equilibrium(device->model, 1);
  const int centre = device->mesh.node_sets.at("centre")[0];
  state.dead_force[device->model.dofs.equation(centre, 0)] = 0.02;
  state.dead_force[device->model.dofs.equation(centre, 1)] = -0.01;
  state.voltage = {0};
  ASSERT_EQ(equilibrium.solve(state, {.tolerance = 1e-12}).outcome, fem::Outcome::converged);
  EXPECT_NEAR(value("force_x"), -0.02, 1e-9);
  EXPECT_NEAR(value("force_y"), 0.01, 1e-9);
  EXPECT_GT(value("moved"), 0);
}

TEST_F(DiscMeasurement, ElongationsStartWhereTheirStepEnds) {
  const Case lattice = read_case(directory / "small.toml");
  const Device built = build_device(lattice);
  Measurement measurement(lattice, built);
  fem::State at = built.model.initial_state();
  fem::Equilibrium equilibrium(built.model, 1);
  fem::EnergyBalance energy;
  energy.add(fem::energy_point(equilibrium, at, 0));
  const auto measured = [&] { return Measured(built, equilibrium, at, energy); };
  EXPECT_TRUE(std::isnan(measurement.all(measured())[0])); // eps_x, since the release
  measurement.step_ended("release", measured());
  EXPECT_EQ(measurement.all(measured())[0], 0);
  for (std::size_t n = 0; n < built.mesh.nodes.size(); ++n) at.displacement[n] = 0.25 * built.mesh.nodes[n];
  EXPECT_NEAR(measurement.all(measured())[0], 0.25, 1e-12);
  EXPECT_NEAR(measurement.all(measured())[1], 0.25, 1e-12);
  const fem::Holding held = fem::holding(equilibrium, at);
  EXPECT_EQ(Measured(built, equilibrium, at, energy, post::WantedScalars::all(), &held).reaction(),
            measured().reaction());
}

// How far it has gone since, whichever way it had gone before.
TEST_F(DiscMeasurement, TheMagnitudeOfADisplacementSinceAStepIsThatOfItsChange) {
  write("moved.toml", test::small_disc + R"(
[[step]]
name = "back"
kind = "voltage"
to = "1 kV"
[[quantity]]
name = "moved"
kind = "displacement"
of = "centre"
since = "voltage"
)");
  one = read_case(directory / "moved.toml");
  device.emplace(build_device(one));
  state = device->model.initial_state();
  state.voltage = {5000};
  const auto centre = static_cast<std::size_t>(device->mesh.node_sets.at("centre")[0]);
  Measurement measurement(one, *device);
  fem::Equilibrium equilibrium(device->model, 1);
  fem::EnergyBalance energy;
  energy.add(fem::energy_point(equilibrium, state, 0));
  const auto moved = [&] {
    std::size_t q = 0;
    while (one.quantities[q].name != "moved") ++q;
    return measurement.value(q, Measured(*device, equilibrium, state, energy));
  };
  EXPECT_TRUE(std::isnan(moved()));
  state.displacement[centre] = {5e-4, 0, 0};
  measurement.step_ended("voltage", Measured(*device, equilibrium, state, energy));
  EXPECT_EQ(moved(), 0);
  state.displacement[centre] = {2e-4, -4e-4, 0};
  EXPECT_DOUBLE_EQ(moved(), 5e-4);
}

// Points of a film of revolution turn with it, as do the responses of linear models and harmonic analyses.
TEST_F(DiscMeasurement, TheGradientAtAPointIsThatOfItsDisplacement) {
  std::string text = "model = \"axisymmetric\"\n" + test::small_disc;
  int count = 0;
  for (const char* point : {"20e-3, 0", "-20e-3, 0", "0, 20e-3", "-12e-3, -15e-3"})
    for (const char* along : {"x", "y"})
      text += fmt::format("[[quantity]]\nname = \"q{}\"\nkind = \"displacement\"\npoint = [{}, 0]\n"
                          "along = \"{}\"\n",
                          ++count, point, along);
  write("points.toml", text);
  one = read_case(directory / "points.toml");
  device.emplace(build_device(one));
  state = device->model.initial_state();
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(device->model.dofs.count());
  for (std::size_t n = 0; n < state.displacement.size(); ++n) {
    const double x = device->mesh.nodes[n].x();
    state.displacement[n] = {1e-3 * (1 + 40 * x), 0, 0};
    if (const int e = device->model.dofs.equation(static_cast<int>(n), 0); e != fem::DofMap::absent)
      moved[e] = state.displacement[n].x();
    else
      state.displacement[n].setZero();
  }
  const fem::Samples none;
  int turned = 0;
  for (const Quantity& quantity : one.quantities) {
    if (!quantity.point) continue;
    const Probing probing{quantity, one, *device, none, ""};
    const double value = quantity.kind->shape(probing)(state);
    EXPECT_NEAR(quantity.kind->gradient(probing, state).dot(moved), value, 1e-15) << quantity.name;
    turned += value < -1e-4;
  }
  EXPECT_EQ(turned, 3); // x of the second, both of the last
}

} // namespace
} // namespace dielast::cases::measurement_test
