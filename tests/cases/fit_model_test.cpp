// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/fit_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::cases::fit_model_test {
namespace {

using materials::Material;
using materials::Mode;

materials::Branch neo_hookean_branch(double modulus, double relaxation_time) {
  return {.law = materials::NeoHookean{modulus}, .viscosity = modulus * relaxation_time};
}

/// VHB 4910 of Wang et al. 2016.
Material vhb() {
  return {.law = materials::ArrudaBoyce{15.36e3, 5.99},
          .branches = {neo_hookean_branch(26.06e3, 0.6074), neo_hookean_branch(26.53e3, 6.56),
                       neo_hookean_branch(10.83e3, 61.25)}};
}

/// Up to the stretch 2.5 and down at 0.03 1/s, a row at each quarter of stretch.
StretchHistory cycle() {
  StretchHistory history;
  for (int i = 0; i <= 12; ++i) {
    history.time.push_back(i * 0.25 / 0.03);
    history.stretch.push_back(1 + 0.25 * (i <= 6 ? i : 12 - i));
  }
  return history;
}

double largest_change(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST(FitModel, EquilibriumIsThatOfTheLawAlone) {
  const Material material{.law = materials::NeoHookean{1000}, .branches = {neo_hookean_branch(5000, 1)}};
  const double l = 1.7;
  EXPECT_NEAR(nominal_stress(material, {Mode::uniaxial, {}, {l}}, 1)[0], 1000 * (l - 1 / (l * l)), 1e-9);
  EXPECT_NEAR(nominal_stress(material, {Mode::pure_shear, {}, {l}}, 1)[0], 1000 * (l - std::pow(l, -3)),
              1e-9);
  EXPECT_NEAR(nominal_stress(material, {Mode::equal_biaxial, {}, {l}}, 1)[0], 1000 * (l - std::pow(l, -5)),
              1e-9);
}

TEST(FitModel, ARowAtTimeZeroIsReachedAtOnce) {
  const Material material{.law = materials::NeoHookean{1000}, .branches = {neo_hookean_branch(5000, 1)}};
  const double l = 1.7;
  const auto stress = nominal_stress(material, {Mode::uniaxial, {0, 1, 50}, {l, l, l}}, 64);
  EXPECT_NEAR(stress[0], 6000 * (l - 1 / (l * l)), 1e-9);
  EXPECT_NEAR(stress[2], 1000 * (l - 1 / (l * l)), 1e-3);
  EXPECT_GT(stress[1], 1.2 * stress[2]);
  EXPECT_LT(stress[1], 0.6 * stress[0]);
}

// The reference integrates the flow rule in three dimensions to 1e-10.
TEST(FitModel, TheStepsThatAreNeededKeepTheToleranceThatWasAsked) {
  const std::vector<double> exact{0,           24.697660e3, 33.768064e3, 39.127217e3,
                                  43.172999e3, 46.666622e3, 49.987736e3, 37.014056e3,
                                  27.434275e3, 18.037934e3, 7.340037e3};
  int last = 0;
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    const int steps = steps_needed(vhb(), cycle(), tolerance);
    std::vector<double> model = nominal_stress(vhb(), cycle(), steps);
    model.resize(exact.size());
    EXPECT_LT(largest_change(model, exact), 1.4 * tolerance * 50e3) << steps;
    EXPECT_GT(steps, last);
    last = steps;
  }
  EXPECT_EQ(steps_needed(vhb(), cycle(), 1e-2, 64), 64);
}

TEST(FitModel, TimeStepsAreOfThirdOrder) {
  const auto fine = nominal_stress(vhb(), cycle(), 2048);
  const double coarse = largest_change(nominal_stress(vhb(), cycle(), 64), fine);
  const double halved = largest_change(nominal_stress(vhb(), cycle(), 128), fine);
  EXPECT_NEAR(coarse / halved, 8, 1);
}

// In pure shear the viscous deformation flows across, too: as a film's at C = diag(l^2, 1).
TEST(FitModel, BranchesInPureShearFlowAsThoseOfAFilm) {
  const materials::Branch branch = neo_hookean_branch(5000, 1);
  const Material material{.law = materials::NeoHookean{0}, .branches = {branch}};
  const double l = 2;
  const auto stress = nominal_stress(material, {Mode::pure_shear, {0, 0.5, 2}, {l, l, l}}, 512);
  materials::Internal viscous = materials::undeformed();
  const double dt = 1e-5;
  const materials::InPlaneC<double> C{l * l, 1, 0};
  for (int n = 0; n < 50000; ++n)
    viscous = materials::advance(branch, C, materials::TimeScheme::backward_euler(dt), viscous, viscous);
  EXPECT_GT(std::abs(viscous[1] - 1), 0.02);
  const auto film = materials::branch_potential(branch, C, materials::TimeScheme::frozen(), viscous, viscous);
  EXPECT_NEAR(stress[1], 2 * l * film.first[0], 1e-4 * stress[1]);
}

// Along a curve of stretch in time the rates are the curve's to second order; at a corner that before it
// counts; rows at the start, which are reached at once, say nothing of a dashpot.
TEST(FitModel, ADashpotBesideTheLawResistsTheRate) {
  const Material material{.law = materials::NeoHookean{1000}, .viscosity = 300};
  const double omega = 2, dt = 0.05;
  struct Factor {
    Mode mode;
    double factor;
  };
  for (const Factor& of : {Factor{Mode::uniaxial, 3}, {Mode::pure_shear, 4}, {Mode::equal_biaxial, 6}}) {
    const Mode mode = of.mode;
    const double factor = of.factor;
    StretchHistory wave{mode, {}, {}}, corner{mode, {}, {}};
    for (int i = 0; i <= 60; ++i) {
      wave.time.push_back(i * dt), corner.time.push_back(i * dt);
      wave.stretch.push_back(1.5 + 0.2 * std::sin(omega * i * dt));
      corner.stretch.push_back(1 + 0.02 * std::min(i, 60 - i));
    }
    const auto elastic = [&](const StretchHistory& history) {
      return nominal_stress({.law = material.law}, {mode, {}, history.stretch}, 1);
    };
    const auto smooth = nominal_stress(material, wave, 1), sharp = nominal_stress(material, corner, 1);
    for (std::size_t i = 0; i < smooth.size(); ++i) {
      const double l = wave.stretch[i], rate = 0.4 * std::cos(omega * wave.time[i]);
      if (i > 1 && i + 1 < smooth.size()) {
        EXPECT_NEAR(smooth[i] - elastic(wave)[i], factor * 300 * rate / (l * l), factor * 300 * 1e-3) << i;
      }
      const double ramp = i == 0 ? 0 : i <= 30 ? 0.4 : -0.4, at = corner.stretch[i];
      EXPECT_NEAR(sharp[i] - elastic(corner)[i], factor * 300 * ramp / (at * at), 1e-6) << i;
    }
    EXPECT_DOUBLE_EQ(smooth[0], elastic(wave)[0]);
    EXPECT_EQ(steps_needed(material, wave, 1e-4), 1);
  }
}

TEST(FitModel, BeyondTheLawThereIsNoStress) {
  const auto stress = nominal_stress({.law = materials::Gent{1000, 10}}, {Mode::uniaxial, {}, {2, 5}}, 1);
  EXPECT_TRUE(std::isfinite(stress[0]));
  EXPECT_TRUE(std::isnan(stress[1]));
}

} // namespace
} // namespace dielast::cases::fit_model_test
