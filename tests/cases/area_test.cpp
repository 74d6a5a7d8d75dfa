// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/quantities.hpp"
#include "cases/quantities/measurement.hpp"
#include "cases/readers/reader.hpp"
#include "tests/cases/scratch.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::cases::area_test {
namespace {

/// A disc of which an electrode covers the middle; parameters: model and order of its elements.
class Area : public test::ScratchTest,
             public testing::WithParamInterface<std::pair<const char*, const char*>> {
 protected:
  void SetUp() override {
    ScratchTest::SetUp();
    one = of("electrode");
    device.emplace(build_device(one));
    state = device->model.initial_state();
  }
  Case of(const std::string& place) const {
    const std::string text = std::string("model = \"") + GetParam().first + "\"\n" + test::small_disc +
                             "order = " + GetParam().second + "\n";
    const std::string quantities = "[[quantity]]\nname = \"a\"\nkind = \"area\"\nof = \"" + place +
                                   "\"\n[[quantity]]\nname = \"e\"\nkind = \"areal strain\"\nof = \"" +
                                   place + "\"\n";
    const std::size_t mesh = text.find("[[step]]"), order = text.rfind("order =");
    write("area.toml",
          text.substr(0, mesh) + text.substr(order) + text.substr(mesh, order - mesh) + quantities);
    return read_case(directory / "area.toml");
  }
  const Quantity& quantity(const std::string& name) const {
    return *std::ranges::find(one.quantities, name, &Quantity::name);
  }
  double area(const fem::State& at) const {
    const fem::Samples none;
    return quantity("a").kind->shape({quantity("a"), one, *device, none, ""})(at);
  }
  /// Moves every node from where it is drawn.
  template<class Motion>
  void move(const Motion& motion) {
    for (std::size_t n = 0; n < device->mesh.nodes.size(); ++n)
      state.displacement[n] = motion(device->mesh.nodes[n]) - device->mesh.nodes[n];
  }
  bool of_revolution() const { return one.dimension == fem::Dimension::axisymmetric; }

  Case one;
  std::optional<Device> device;
  fem::State state;
};

TEST_P(Area, GrowsByTheProductOfTheStretches) {
  const double drawn = area(state), circle = std::numbers::pi * 9e-4;
  EXPECT_NEAR(drawn, circle, (of_revolution() ? 1e-12 : 5e-2) * circle);
  const double a = 1.3, b = of_revolution() ? 1.3 : 1.1;
  move([&](const Eigen::Vector3d& x) { return Eigen::Vector3d(a * x.x(), b * x.y(), x.z()); });
  EXPECT_NEAR(area(state), a * b * drawn, 1e-12 * drawn);
  fem::Equilibrium equilibrium(device->model, 1);
  fem::EnergyBalance energy;
  energy.add(fem::energy_point(equilibrium, state, 0));
  const std::vector<double> all =
      Measurement(one, *device).all(Measured(*device, equilibrium, state, energy));
  EXPECT_NEAR(all[static_cast<std::size_t>(&quantity("a") - one.quantities.data())], a * b * drawn,
              1e-12 * drawn);
  EXPECT_NEAR(all[static_cast<std::size_t>(&quantity("e") - one.quantities.data())], a * b - 1, 1e-12);
  EXPECT_EQ(unit_of(quantity("a"), one.quantities), "m^2");
}

// Flat film that is tilted, or drawn out to a cone: larger by one over the cosine of its slope.
TEST_P(Area, IsThatOfTheSurfaceInSpace) {
  if (one.dimension == fem::Dimension::planar) GTEST_SKIP() << "nothing leaves the plane";
  const double drawn = area(state), slope = 0.75; // 3 4 5
  move([&](const Eigen::Vector3d& x) { return Eigen::Vector3d(x.x(), x.y(), x.z() + slope * x.x()); });
  EXPECT_NEAR(area(state), 1.25 * drawn, 1e-12 * drawn);
}

TEST_P(Area, GradientIsThatOfDifferences) {
  move([&](const Eigen::Vector3d& x) {
    const double bulge = one.dimension == fem::Dimension::planar ? 0 : 5 * x.x() * x.x() - 3 * x.y() * x.x();
    return Eigen::Vector3d(1.1 * x.x() + 2 * x.x() * x.x(), x.y() * (1 + 3 * x.x()), bulge);
  });
  const fem::Samples none;
  const Eigen::VectorXd gradient =
      quantity("a").kind->gradient({quantity("a"), one, *device, none, ""}, state);
  const fem::DofMap& dofs = device->model.dofs;
  const double h = 1e-6, size = gradient.lpNorm<Eigen::Infinity>();
  int compared = 0;
  for (std::size_t n = 0; n < device->mesh.nodes.size(); ++n)
    for (int c = 0; c < 3; ++c) {
      const int e = dofs.equation(static_cast<int>(n), c);
      if (e == fem::DofMap::absent) continue;
      fem::State there = state, back = state;
      there.displacement[n][c] += h;
      back.displacement[n][c] -= h;
      EXPECT_NEAR(gradient[e], (area(there) - area(back)) / (2 * h), 1e-6 * size) << n << " " << c;
      compared += std::abs(gradient[e]) > 1e-3 * size;
    }
  EXPECT_GT(compared, 1);
}

TEST_P(Area, AnEdgeHasNone) {
  one = of("rim");
  try {
    Measurement(one, *device);
    FAIL();
  } catch (const CaseError& error) {
    EXPECT_NE(
        std::string(error.what()).find("quantity[1].of: found \"rim\": only a part of the film has an area"),
        std::string::npos)
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, Area,
                         testing::Values(std::pair("planar", "1"), std::pair("planar", "2"),
                                         std::pair("3d", "1"), std::pair("3d", "2"),
                                         std::pair("axisymmetric", "1"), std::pair("axisymmetric", "2")));

} // namespace
} // namespace dielast::cases::area_test
