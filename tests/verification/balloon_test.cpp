// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"
#include "meshing/meridian.hpp"
#include "tests/fem/chamber_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::balloon_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double modulus = 45e3, permittivity = 4e-11, thickness = 0.5e-3, radius = 0.02;

/// A neo-Hookean balloon, filled with a given volume: p = (2 H/R) (mu (1/l - l^-7) - eps (Phi/H)^2 l).
class Balloon {
 public:
  explicit Balloon(double volts) {
    MembraneSection film = test::vhb();
    film.thickness = thickness;
    model_ = test::inflatable(mesh_, film, radius, {}, true);
    for (const char* pole : {"south", "north"}) model_->dofs.hold(mesh_.node_sets.at(pole).front(), 0);
    equator_ = mesh_.node_sets.at("equator").front();
    model_->dofs.hold(equator_, 2);
    model_->dofs.number();
    equilibrium_ = std::make_unique<Equilibrium>(*model_, 1);
    state_ = model_->initial_state();
    state_.voltage[0] = volts;
    state_.supply[1] = Supply::charge;
  }
  /// Fills in the volume of a sphere of the stretch `l`; the pressure, Pa.
  double inflate(double l) {
    for (int correction = 0; correction < 3; ++correction) { // what the liquid gives way to the pressure
      state_.charge[1] =
          model_->ports[1].chamber->pumped(4 * pi / 3 * std::pow(l * radius, 3), state_.voltage[1]);
      result_ = equilibrium_->solve(state_, {.tolerance = 1e-12});
      EXPECT_EQ(result_.outcome, Outcome::converged) << l;
    }
    return state_.voltage[1];
  }
  double stretch() const { return 1 + state_.displacement[static_cast<std::size_t>(equator_)].x() / radius; }
  const NewtonResult& result() const { return result_; }

 private:
  meshing::Mesh mesh_ = meshing::balloon_meridian(radius, 40, 2);
  std::unique_ptr<Model> model_;
  std::unique_ptr<Equilibrium> equilibrium_;
  State state_;
  NewtonResult result_;
  int equator_ = 0;
};

constexpr double limit_stretch = 1.3830875558413516; // 7^(1/6)

double exact_pressure(double l, double volts) {
  const double k = permittivity * std::pow(volts / thickness, 2);
  return 2 * thickness / radius * (modulus * (1 / l - std::pow(l, -7)) - k * l);
}

TEST(Balloon, its_pressure_passes_the_limit_under_volume_control) {
  Balloon balloon(0);
  for (const auto& [l, pressure] : {std::pair{1.1, 890.8487794354559},
                                    {1.2, 1247.0662937242798},
                                    {1.3, 1372.1950193659557},
                                    {1.5, 1368.312757201646},
                                    {2.0, 1107.421875}}) {
    while (balloon.stretch() < l - 0.15) balloon.inflate(balloon.stretch() + 0.1);
    const double found = balloon.inflate(l);
    EXPECT_NEAR(found, pressure, 1e-4 * pressure);
    EXPECT_NEAR(balloon.stretch(), l, 1e-5 * l);
    EXPECT_EQ(balloon.result().negative_pivots, l > limit_stretch); // at given pressure it would run away
    EXPECT_EQ(balloon.result().unstable_modes, 0);
  }
}

TEST(Balloon, its_highest_pressure_is_that_of_the_closed_form) {
  Balloon balloon(0);
  double top = 1.3, highest = 0;
  balloon.inflate(1.15);
  for (const double step : {0.1, 0.03, 0.01, 0.003}) { // parabolas through three states about the top
    const double below = balloon.inflate(top - step), middle = balloon.inflate(top),
                 above = balloon.inflate(top + step);
    const double slope = (above - below) / 2, curvature = above - 2 * middle + below;
    top -= step * slope / curvature;
    highest = middle - slope * slope / (2 * curvature);
  }
  EXPECT_NEAR(top, limit_stretch, 1e-4 * limit_stretch);
  EXPECT_NEAR(highest, 1394.3957651990045, 1e-4 * 1394.4);
}

TEST(Balloon, a_voltage_lowers_its_pressure) {
  Balloon balloon(4e3);
  for (const double l : {1.1, 1.2, 1.3, 1.4, 1.6}) {
    const double expected = exact_pressure(l, 4e3), found = balloon.inflate(l);
    EXPECT_NEAR(found, expected, 1e-4 * expected) << l;
    EXPECT_LT(found, 0.96 * exact_pressure(l, 0)) << l;
  }
}

} // namespace
} // namespace dielast::fem::balloon_test
