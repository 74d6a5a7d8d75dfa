// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/film_cases.hpp"

#include <Eigen/Core>

#include <cmath>

// Electrodes that are isolated and leak.

namespace dielast::cases {
namespace {

class Leak : public FilmCases {};

/// The film of `branched_patch`, 1 mm thick and free, with the charge Q and one viscous stretch x: Q and x by
/// the classical Runge-Kutta method, the stretch from the balance at each of their values.
struct LeakingPatch {
  static constexpr double mu = 40e3, relaxation = 1, drawn = 4e-12, volume = 1e-7; ///< Pa, s, F, m^3
  double leakage = 0, charge = 0, viscous = 1, heat = 0;

  static double stretch(double Q, double x) {
    double low = 1, high = 3;
    for (int i = 0; i < 60; ++i) {
      const double l = (low + high) / 2, u = l / x;
      const double pull = 2 * mu * (l - std::pow(l, -5) + (u - std::pow(u, -5)) / x) -
                          2 * Q * Q / (drawn * volume * std::pow(l, 5));
      (pull < 0 ? low : high) = l;
    }
    return low;
  }
  double voltage() const { return charge / (drawn * std::pow(stretch(charge, viscous), 4)); }
  void pass(double time, int steps) {
    const double h = time / steps;
    const auto rate = [this](const Eigen::Vector3d& at) {
      const double l = stretch(at[0], at[1]), u = l / at[1], volts = at[0] / (drawn * std::pow(l, 4));
      return Eigen::Vector3d(-leakage * volts, at[1] * (u * u - std::pow(u, -4)) / (6 * relaxation),
                             leakage * volts * volts);
    };
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector3d at(charge, viscous, heat), k1 = rate(at), k2 = rate(at + h / 2 * k1),
                                                       k3 = rate(at + h / 2 * k2), k4 = rate(at + h * k3);
      const Eigen::Vector3d next = at + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      charge = next[0], viscous = next[1], heat = next[2];
    }
  }
};

TEST_F(Leak, AnIsolatedElectrodeLosesItsChargeThroughTheLeakWhileTimePasses) {
  const std::string text = branched_patch +
                           "[drive]\ncharge = \"20 nC\"\n[circuit]\nresistance = \"1 Mohm\"\n"
                           "leakage_resistance = \"1 TOhm\"\n[solver]\ntime_tolerance = 1e-8\n"
                           "[[step]]\nkind = \"charge\"\n[[step]]\nkind = \"hold\"\nduration = \"5 s\"\n"
                           "control = \"charge\"\n";
  const std::string quantities = "[[quantity]]\nname = \"leaked\"\nkind = \"energy\"\nof = \"leak_heat\"\n"
                                 "[[quantity]]\nname = \"source\"\nkind = \"energy\"\nof = \"source_work\"\n"
                                 "[[quantity]]\nname = \"Q\"\nkind = \"charge\"\nof = \"film\"\n";
  const Ran held = run(text + quantities);
  LeakingPatch patch{.leakage = 1e-12, .charge = 20e-9};
  patch.viscous = LeakingPatch::stretch(patch.charge, 1); // relaxed: bisection finds where u = 1
  for (int i = 0; i < 200; ++i) patch.viscous = LeakingPatch::stretch(patch.charge, patch.viscous);
  patch.pass(5, 2000);
  EXPECT_LT(patch.charge, 14e-9);
  EXPECT_NEAR(held.last("Q"), patch.charge, 1e-5 * patch.charge);
  EXPECT_NEAR(held.voltages.back().at(0), patch.voltage(), 1e-5 * patch.voltage());
  EXPECT_NEAR(held.last("leaked"), patch.heat, 1e-4 * patch.heat);
  double charged = 0; // what the source gave, before the hold
  for (std::size_t row = 0; row < held.time.size(); ++row)
    if (held.time[row] == 0) charged = held.values.at("source")[row];
  EXPECT_GT(charged, 0);
  EXPECT_NEAR(held.last("source"), charged, 1e-4 * charged);
  // A charge that is given stays.
  const std::string given = text + "[[step]]\nkind = \"transient\"\nname = \"given\"\nduration = \"5 s\"\n"
                                   "control = \"charge\"\n";
  EXPECT_NEAR(run(given + quantities).last("Q"), 20e-9, 1e-13);
  // The source takes up at the voltage that is left.
  const std::string driven = "[[step]]\nkind = \"hold\"\nname = \"driven\"\nduration = \"1 ms\"\n";
  EXPECT_NEAR(run(text + driven + quantities).last("Q"), patch.charge, 1e-3 * patch.charge);
}

} // namespace
} // namespace dielast::cases
