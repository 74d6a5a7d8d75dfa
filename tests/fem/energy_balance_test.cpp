// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/energy_balance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::fem::energy_balance_test {
namespace {

Conjugates pair(double force, double coordinate) {
  return {Eigen::VectorXd::Constant(1, force), Eigen::VectorXd::Constant(1, coordinate)};
}

/// A device whose stored energy is exp(q) - 1 + x^4: voltage exp(q), force 4 x^3.
EnergyPoint point_at(double length, double q, double x, double time = 0) {
  EnergyPoint point{.length = length, .time = time};
  point.electrical = pair(std::exp(q), q);
  point.resistance = pair(0, q);
  point.mechanical = pair(4 * x * x * x, x);
  point.energy.elastic = std::exp(q) - 1 + x * x * x * x;
  return point;
}

/// Charge and displacement grow to sin(1) and 1.3 along a smooth path.
EnergyBalance along(int increments) {
  EnergyBalance balance;
  for (int i = 0; i <= increments; ++i) {
    const double s = static_cast<double>(i) / increments;
    balance.add(point_at(i > 0 ? 1.0 / increments : 0, std::sin(s), s + 0.3 * s * s));
  }
  return balance;
}

// The work of the only load that changes is what the others leave of a potential.
TEST(EnergyBalance, one_changing_load_is_exact_with_any_increments) {
  for (const int increments : {1, 2, 3, 12, 40}) {
    EnergyBalance charged, loaded;
    for (int i = 0; i <= increments; ++i) {
      const double s = static_cast<double>(i) / increments, length = i > 0 ? 1.0 / increments : 0;
      charged.add(point_at(length, 2 * s, 0.5));
      loaded.add(point_at(length, 0.5, 2 * s));
    }
    EXPECT_NEAR(charged.work().electrical, std::exp(2.0) - 1, 1e-13) << increments;
    EXPECT_EQ(charged.work().mechanical, 0);
    EXPECT_NEAR(loaded.work().mechanical, 16, 1e-13) << increments;
    EXPECT_EQ(loaded.work().electrical, 0);
    EXPECT_LT(charged.error() + loaded.error(), 1e-13);
  }
}

TEST(EnergyBalance, two_changing_loads_share_what_the_rules_leave) {
  const double electrical = std::exp(std::sin(1.0)) - 1, mechanical = std::pow(1.3, 4);
  std::vector<double> errors;
  for (const int increments : {5, 20, 40}) {
    const EnergyBalance balance = along(increments);
    const Work& work = balance.work();
    EXPECT_NEAR(work.electrical + work.mechanical, electrical + mechanical, 1e-13);
    errors.push_back(std::abs(work.electrical - electrical));
    EXPECT_LT(errors.back(), balance.error()) << increments;
  }
  EXPECT_LT(errors[1], 1e-4);
  EXPECT_GT(errors[1], 6 * errors[2]);
}

// Time steps of any ratio beside each other, and increments of no length: no weight grows.
TEST(EnergyBalance, spacing_does_not_matter) {
  EnergyBalance balance;
  double s = 0, last = 0;
  balance.add(point_at(0, 0, 0));
  for (int i = 0; s < 1; ++i) {
    s = std::min(1.0, s + std::array{1e-16, 0.04, 1e-9, 1e-5, 0.02, 0.0, 1e-12}[i % 7]);
    balance.add(point_at(s - last, std::sin(s), s + 0.3 * s * s, s));
    last = s;
  }
  EXPECT_NEAR(balance.work().electrical, std::exp(std::sin(1.0)) - 1, 1e-3);
  EXPECT_NEAR(balance.work().mechanical, std::pow(1.3, 4), 1e-3);
  EXPECT_LT(balance.error(), 1e-2);
}

TEST(EnergyBalance, heat_is_what_the_states_lose) {
  EnergyBalance balance;
  balance.add(point_at(0, 0, 0));
  for (int i = 1; i <= 30; ++i) { // under a constant load: force 4, of which power exp(-t) becomes heat
    const double t = 0.1 * i, lost = 1 - std::exp(-t);
    EnergyPoint point{.length = 0.1, .time = t};
    point.electrical = point.resistance = pair(0, 0);
    point.mechanical = pair(4, lost);
    point.energy.elastic = 3 * lost;
    point.power[EnergyPoint::dashpots] = std::exp(-t);
    point.flow = 1.001 * (std::exp(-t + 0.1) - std::exp(-t));
    if (i == 1) balance = EnergyBalance();
    balance.add(point);
  }
  const double first = 1 - std::exp(-0.1), lost = 1 - std::exp(-3.0) - first;
  EXPECT_NEAR(balance.work().mechanical, 4 * lost, 1e-14);
  EXPECT_NEAR(balance.work().dissipated, lost, 1e-14);        // the loads are known exactly: the rest is heat
  EXPECT_NEAR(balance.error(), 1e-3 / 3 * lost, 1e-4 * lost); // of two rules the better one is taken
}

TEST(EnergyBalance, heat_never_falls) {
  EnergyBalance balance;
  double before = 0;
  for (int i = 0; i <= 100; ++i) {
    EnergyPoint point = point_at(0.1, std::sin(0.3 * i), std::cos(0.2 * i), 0.1 * i);
    point.flow = std::sin(1.7 * i); // whatever it says
    balance.add(point);
    EXPECT_GE(balance.work().dissipated, before);
    before = balance.work().dissipated;
  }
  EXPECT_GT(before, 1);
}

// A capacitor of 1 F that a source of 2 V charges through 1 Ohm and a leak of 3 Ohm drains.
TEST(EnergyBalance, the_source_pays_for_resistance_and_leak) {
  const double rate = 1 + 1.0 / 3, steady = 2 / rate;
  EnergyBalance balance;
  constexpr int steps = 200;
  for (int i = 0; i <= steps; ++i) {
    const double t = 3.0 * i / steps, phi = steady * (1 - std::exp(-rate * t));
    EnergyPoint point{.length = i > 0 ? 3.0 / steps : 0, .time = t};
    point.mechanical = pair(0, 0);
    point.electrical = pair(phi, phi);
    point.resistance = pair(2 - phi, phi);
    point.power[EnergyPoint::leak] = phi * phi / 3;
    point.power[EnergyPoint::leak_through_resistance] = phi / 3 * (2 - phi);
    point.energy.electric = phi * phi / 2;
    balance.add(point);
  }
  const auto gone = [&](double k) { return (1 - std::exp(-k * rate * 3)) / (k * rate); };
  const double leak = steady * steady / 3 * (3 - 2 * gone(1) + gone(2));
  const double drop = 2 - steady; // of the resistance, in the end
  const double resistance = drop * drop * 3 + 2 * drop * steady * gone(1) + steady * steady * gone(2);
  EXPECT_NEAR(balance.work().leak, leak, 1e-6 * leak);
  EXPECT_NEAR(balance.work().resistance, resistance, 1e-5 * resistance);
  EXPECT_NEAR(balance.work().source(), leak + resistance + balance.stored(), 1e-5 * resistance);
  EXPECT_EQ(balance.work().dissipated, 0);
}

TEST(EnergyBalance, with_inertia_the_rest_is_an_error) {
  EnergyBalance balance;
  EnergyPoint start = point_at(0, 0, 1), end = point_at(1, 0, 2, 1);
  start.moves = end.moves = true;
  balance.add(start);
  balance.add(end);
  EXPECT_DOUBLE_EQ(balance.work().mechanical, 18);
  EXPECT_DOUBLE_EQ(balance.error(), 3);
}

// The force grows, then the coordinate: parabolas across the corner see a curvature that is not there.
TEST(EnergyBalance, no_curvature_is_taken_across_a_corner) {
  const auto mechanical = [](bool told) {
    EnergyBalance balance;
    EnergyPoint point = point_at(1, 0, 0);
    point.moves = true;
    for (const auto& [force, coordinate] : {std::pair{0, 0}, {1, 0}, {1, 1}}) {
      if (told && coordinate == 1) balance.corner();
      point.mechanical = pair(force, coordinate);
      balance.add(point);
    }
    return balance.work().mechanical;
  };
  EXPECT_EQ(mechanical(true), 1);
  EXPECT_NEAR(mechanical(false), 1 + 1.0 / 12, 1e-15);
}

TEST(EnergyBalance, increments_without_length_are_no_curvature) {
  EnergyBalance balance;
  for (int i = 0; i <= 4; ++i) balance.add(point_at(0, 0.1 * i, 0.2 * i));
  EXPECT_TRUE(std::isfinite(balance.work().electrical) && std::isfinite(balance.error()));
}

TEST(EnergyBalance, a_jump_releases_what_nobody_accounts_for) {
  EnergyBalance balance;
  balance.add(point_at(0, 1, 0));
  EnergyPoint landed = point_at(1, 2, 0);
  landed.electrical.force[0] = std::exp(1.0);
  const EnergyBalance::JumpRelease release = balance.add_after_jump(landed);
  EXPECT_DOUBLE_EQ(release.energy, balance.work().released);
  EXPECT_DOUBLE_EQ(release.doubt, std::abs(std::exp(1.0) - point_at(0, 1, 0).electrical.force[0]) / 2);
  EXPECT_NEAR(balance.work().electrical, std::exp(1.0), 1e-15);
  EXPECT_NEAR(balance.work().released, std::exp(1.0) - (std::exp(2.0) - std::exp(1.0)), 1e-14);
  EXPECT_NEAR(balance.error(), 0, 1e-14);
}

TEST(EnergyBalance, a_result_beyond_one_percent_is_poor_unless_the_run_exchanges_much_more) {
  EnergyBalance balance;
  EnergyPoint point = point_at(0, 0, 0);
  point.moves = true;
  const auto worst_after = [&](double x, double error) {
    point.mechanical = pair(1, x);
    point.energy.elastic = x - error;
    balance.add(point);
    balance.judge(0);
    return balance.worst();
  };
  EXPECT_FALSE(worst_after(0, 0).is_poor());
  EXPECT_FALSE(worst_after(1, 0.009).is_poor());
  EXPECT_TRUE(worst_after(2, 0.03).is_poor());
  EXPECT_TRUE(worst_after(3, 0.04).is_poor());
  EXPECT_EQ(worst_after(100, 0.04).exchanged, 2);
  EXPECT_EQ(worst_after(2100, 0.04).exchanged, 2.1); // a thousandth
  EXPECT_EQ(worst_after(2400, 0.04).exchanged, 3);   // the first is 0.03 of 2.4 by now
  EXPECT_EQ(EnergyBalance(balance.record()).worst().exchanged, 3);
  EXPECT_FALSE(worst_after(5000, 0.04).is_poor());
}

// What a drawn film stores until it is let go says nothing of what follows, but for a thousandth of it.
TEST(EnergyBalance, what_a_cut_sets_free_is_no_measure) {
  for (const double stored : {100.0, 3100.0}) {
    EnergyBalance balance;
    EnergyPoint point = point_at(0, 0, 0);
    point.mechanical = pair(1, 0);
    point.energy.elastic = stored;
    balance.add(point);
    point.energy.elastic = 0;
    balance.add_cut_free(point);
    balance.judge(0);
    EXPECT_FALSE(balance.worst().is_poor());
    EXPECT_NEAR(balance.work().released, stored, 1e-12);
    point.moves = true;
    point.mechanical = pair(1, 1);
    point.energy.elastic = 0.97;
    balance.add(point);
    balance.judge(0);
    EXPECT_EQ(EnergyBalance(balance.record()).worst().is_poor(), stored < 3000);
  }
}

// A resistance takes most of what the source gives, and is known to a part of that; the electrode's own
// energy is known better, or else is poor.
TEST(EnergyBalance, heat_of_circuits_is_judged_beside_what_the_source_gives) {
  for (const double error : {0.0, 0.1}) {
    EnergyBalance balance;
    for (int i = 0; i <= 4; ++i) {
      EnergyPoint point = point_at(0, 0, 0);
      const double s = i / 4.0;
      point.length = 0.25;
      point.time = s;
      point.moves = true;
      point.electrical = pair(1, s);
      point.resistance = pair(100 * (1 + s * s), s); // curved
      point.energy.electric = s * (1 - error);
      balance.add(point);
      balance.judge(0, i, 2);
    }
    EXPECT_NEAR(balance.work().resistance, 400.0 / 3, 1);
    EXPECT_GT(balance.error(), 0.05); // of the electrode's energy of 1
    EXPECT_EQ(balance.worst().is_poor(), error > 0);
    if (error > 0) {
      EXPECT_FALSE(balance.worst().given);
      EXPECT_EQ(balance.worst().step, 2);
      EXPECT_GT(balance.worst().row, 0);
      EXPECT_NEAR(balance.worst().error, error * balance.worst().row / 4.0, 1e-6);
      EXPECT_GE(balance.worst().told, balance.worst().error);
    }
  }
}

TEST(EnergyBalance, a_result_of_which_nothing_is_known_is_poor) {
  EnergyBalance balance;
  EnergyPoint point = point_at(0, 0, 0);
  point.moves = true;
  balance.add(point);
  point.energy.elastic = 1; // from nowhere
  balance.add(point);
  balance.judge(1e15); // to which rounding makes more
  EXPECT_FALSE(balance.worst().is_poor());
  balance.judge(1);
  EXPECT_TRUE(balance.worst().is_poor());
  EXPECT_EQ(balance.worst().exchanged, 0);
  EXPECT_NEAR(balance.worst().error, 1, 1e-8);
}

// In increments of one jump.
TEST(EnergyBalance, a_jump_at_a_sheets_terminal_goes_on_from_its_record) {
  EnergyBalance straight, stopped;
  for (int i = 0; i <= 4; ++i) {
    EnergyPoint point{.length = i > 0 ? 0.25 : 0};
    point.electrical = pair(i, 2.0 * i);
    point.resistance = pair(0, 2.0 * i);
    point.mechanical = point.sheet = pair(0, 0);
    point.energy.electric = 1.0 * i * i;
    point.at_source = Eigen::VectorXd::Ones(1);
    stopped = EnergyBalance(stopped.record());
    straight.add(point);
    stopped.add(point);
  }
  EXPECT_EQ(straight.work().dissipated, 16); // 4 V give 8 C
  EXPECT_EQ(stopped.work().dissipated, straight.work().dissipated);
  EXPECT_EQ(stopped.work().electrical, straight.work().electrical);
}

TEST(EnergyBalance, goes_on_from_its_record) {
  EnergyBalance straight = along(20), stopped;
  for (int i = 0; i <= 20; ++i) {
    const double s = i / 20.0;
    stopped = EnergyBalance(stopped.record());
    stopped.add(point_at(i > 0 ? 1.0 / 20 : 0, std::sin(s), s + 0.3 * s * s));
  }
  EXPECT_EQ(straight.work().electrical, stopped.work().electrical);
  EXPECT_EQ(straight.error(), stopped.error());
}

} // namespace
} // namespace dielast::fem::energy_balance_test
