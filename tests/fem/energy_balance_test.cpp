#include "fem/energy_balance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::fem {
namespace {

/// A device whose stored energy is exp(q) - 1 + x^4: voltage exp(q), force 4 x^3.
EnergyPoint point_at(double parameter, double q, double x, double power, double time) {
  EnergyPoint point;
  point.parameter = parameter;
  point.time = time;
  point.voltage = {std::exp(q)};
  point.charge = {q};
  point.force = Eigen::VectorXd::Constant(1, 4 * x * x * x);
  point.position = Eigen::VectorXd::Constant(1, x);
  point.energy.elastic = std::exp(q) - 1 + x * x * x * x;
  point.energy.dissipation = power;
  return point;
}

EnergyBalance along(int increments) {
  EnergyBalance balance;
  for (int i = 0; i <= increments; ++i) {
    const double s = static_cast<double>(i) / increments;
    balance.add(point_at(s, std::sin(s), s + 0.3 * s * s, 0, s));
  }
  return balance;
}

TEST(EnergyBalance, integrates_works_along_a_smooth_path_to_high_order) {
  const Work work = along(20).work();
  EXPECT_NEAR(work.electrical, std::exp(std::sin(1.0)) - 1, 1e-9);
  EXPECT_NEAR(work.mechanical, std::pow(1.3, 4), 1e-9);
  EXPECT_GT(std::abs(along(10).error()), 60 * std::abs(along(20).error()));
}

TEST(EnergyBalance, few_points_are_integrated_by_what_they_allow) {
  EXPECT_DOUBLE_EQ(along(1).work().electrical, (1 + std::exp(std::sin(1.0))) / 2 * std::sin(1.0));
}

TEST(EnergyBalance, dissipated_power_is_integrated_in_time) {
  EnergyBalance balance;
  for (int i = 0; i <= 12; ++i) {
    const double t = 0.25 * i;
    balance.add(point_at(t, 0, 0, std::exp(-t), t));
  }
  EXPECT_NEAR(balance.work().dissipated, 1 - std::exp(-3.0), 1e-7);
}

TEST(EnergyBalance, polynomials_do_not_reach_across_a_corner) {
  EnergyBalance balance;
  const auto path = [](double s) { return s < 1 ? s : 2 - s; }; // there and back
  for (int i = 0; i <= 20; ++i) {
    if (i == 11) balance.corner();
    balance.add(point_at(0.1 * i, path(0.1 * i), 0, 0, 0));
  }
  EXPECT_NEAR(balance.work().electrical, 0, 1e-10);
  EXPECT_NEAR(balance.error(), 0, 1e-10);
}

TEST(EnergyBalance, a_jump_releases_what_nobody_accounts_for) {
  EnergyBalance balance;
  balance.add(point_at(0, 1, 0, 0, 0));
  EnergyPoint landed = point_at(1, 2, 0, 0, 0);
  landed.voltage = {std::exp(1.0)};
  balance.add_after_jump(landed);
  EXPECT_NEAR(balance.work().electrical, std::exp(1.0), 1e-15);
  EXPECT_NEAR(balance.work().released, std::exp(1.0) - (std::exp(2.0) - std::exp(1.0)), 1e-14);
  EXPECT_NEAR(balance.error(), 0, 1e-14);
}

TEST(EnergyBalance, goes_on_from_its_record) {
  EnergyBalance straight = along(20), stopped = along(0);
  stopped = EnergyBalance();
  for (int i = 0; i <= 20; ++i) {
    const double s = i / 20.0;
    stopped = EnergyBalance(stopped.record());
    stopped.add(point_at(s, std::sin(s), s + 0.3 * s * s, 0, s));
  }
  EXPECT_EQ(straight.work().electrical, stopped.work().electrical);
}

} // namespace
} // namespace dielast::fem
