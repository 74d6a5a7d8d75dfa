// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/state.hpp"

#include "fem/paths/predictor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dielast::fem::state_test {
namespace {

TEST(Rotation, spin_of_inverts_rotation_of) {
  for (const double angle : {0.0, 1e-300, 1e-12, 1e-9, 5e-5, 2e-4, 1e-3, 0.1, 1.0, 2.0, 3.0, 3.14}) {
    const Eigen::Vector3d spin = angle * Eigen::Vector3d(0.48, -0.6, 0.64);
    EXPECT_LE((spin_of(rotation_of(spin)) - spin).norm(), 4e-16 * (angle + (angle > 3 ? 1 : 0))) << angle;
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, spin.normalized()).toRotationMatrix();
    if (angle < 1e-200) continue; // AngleAxis needs an axis
    EXPECT_LT((rotation_of(spin).toRotationMatrix() - expected).norm(), 1e-15) << angle;
  }
}

TEST(Rotation, beyond_half_a_turn_the_sign_stays_continuous) {
  EXPECT_LT(rotation_of({0, 0, 3.5}).w(), 0);
  EXPECT_GT(rotation_of({0, 0, 3.5}).dot(rotation_of({0, 0, 3.0})), 0);
}

TEST(Rotation, its_angle_counts_the_turns_one_way_and_back) {
  const Eigen::Vector3d axis(0.48, -0.6, 0.64);
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();
  double turned = 0;
  for (int step = 0; step < 400; ++step) { // whole turns are hit, too
    const double by = (step < 150 ? 1 : -1) * std::numbers::pi / 8;
    rotation = rotation_of(by * axis) * rotation;
    angle = angle_near(rotation, angle + by * axis);
    turned += by;
    EXPECT_LT((angle - turned * axis).norm(), 1e-12) << step;
  }
  EXPECT_LT((angle_near(Eigen::Quaterniond(-1, 0, 0, 0), 6.2 * axis) - 2 * std::numbers::pi * axis).norm(),
            1e-14);
  EXPECT_EQ(angle_near(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()), Eigen::Vector3d::Zero());
}

// At whole turns the rotation vector turns over with the axis' least wobble.
TEST(Rotation, its_angle_counts_the_turns_of_what_wobbles) {
  for (const double wobble : {1e-12, 1e-3, 0.02})
    for (const double by : {0.7, std::numbers::pi / 100, 1e-3}) {
      Eigen::Quaterniond rotation = rotation_of({wobble, 0, 0});
      Eigen::Vector3d angle(wobble, 0, 0);
      double turned = 0;
      while (turned < 20) {
        const Eigen::Vector3d spin(0, 0, by);
        rotation = rotation_of(spin) * rotation;
        angle = angle_near(rotation, angle + spin);
        turned += by;
        const double from_whole = std::abs(std::remainder(turned, 2 * std::numbers::pi));
        if (from_whole > 20 * wobble) {
          EXPECT_NEAR(angle.z(), turned, 0.02) << wobble << " " << by;
        }
      }
    }
}

/// A path that is a polynomial of this degree in the parameter, rotations about one axis.
State on_path(double t, int degree) {
  const Eigen::Vector3d a(0.3, -0.1, 0.2), b(0.05, 0.1, -0.07), axis(0.6, 0, 0.8);
  double value = 0, power = 1;
  for (int p = 0; p <= degree; ++p, power *= t) value += power / (1 + p);
  State state;
  state.displacement = {value * a, value * b};
  state.rotation = {rotation_of(value * axis), rotation_of(-0.3 * value * axis)};
  state.angle = {value * axis, -0.3 * value * axis};
  state.voltage = {t};
  state.dead_force = Eigen::VectorXd::Constant(3, t);
  return state;
}

TEST(Extrapolation, is_exact_for_polynomials_through_as_many_points_as_they_need) {
  for (int degree = 0; degree <= 3; ++degree) {
    std::vector<PathPoint> points;
    for (const double t : {0.0, 0.3, 0.5, 0.9})
      if (static_cast<int>(points.size()) <= degree) points.push_back({t, on_path(t, degree)});
    for (const double t : {1.2, 0.9, 0.1}) {
      const State expected = on_path(t, degree), actual = extrapolate(points, t);
      for (std::size_t n = 0; n < 2; ++n) {
        EXPECT_LT((actual.displacement[n] - expected.displacement[n]).norm(), 1e-14) << degree;
        EXPECT_LT((actual.rotation[n].coeffs() - expected.rotation[n].coeffs()).norm(), 1e-14) << degree;
      }
      EXPECT_EQ(actual.voltage, points.back().state.voltage);
      EXPECT_EQ(actual.dead_force, points.back().state.dead_force);
    }
  }
}

TEST(Extrapolation, passes_through_its_points_whatever_they_are) {
  std::vector<PathPoint> points;
  for (const double t : {1.0, 2.5, 3.0, 4.0}) {
    points.push_back({t, on_path(t / 3, 3)});
    points.back().state.rotation[0] = rotation_of({std::sin(t), std::cos(3 * t), 0.3 * t}); // about any axis
  }
  for (const PathPoint& point : points) {
    const State there = extrapolate(points, point.parameter);
    EXPECT_LT((there.displacement[0] - point.state.displacement[0]).norm(), 1e-14);
    EXPECT_LT((there.rotation[0].coeffs() - point.state.rotation[0].coeffs()).norm(), 1e-14);
  }
}

TEST(Predictor, goes_by_as_many_points_as_a_smooth_path_has) {
  std::vector<PathPoint> points;
  for (int i = 0; i < 8; ++i) points.push_back({0.1 * i, on_path(0.1 * i, 6)});
  const State expected = on_path(0.8, 6);
  const auto error = [&](const State& state) {
    return (state.displacement[0] - expected.displacement[0]).norm();
  };
  EXPECT_LT(error(predict(points, 0.8)), 1e-13);
  EXPECT_GT(error(extrapolate(std::span(points).last(4), 0.8)), 1e-5);
}

TEST(Predictor, forgets_what_was_before_a_kink) {
  std::vector<PathPoint> points;
  for (int i = 0; i < 8; ++i) points.push_back({0.1 * i, on_path(0.1 * i, 2)});
  for (std::size_t i = 0; i < 4; ++i)
    points[i].state.displacement[0].x() += 0.1 * (0.4 - points[i].parameter);
  const State expected = on_path(0.8, 2), actual = predict(points, 0.8);
  EXPECT_LT((actual.displacement[0] - expected.displacement[0]).norm(), 1e-14);
  EXPECT_GT((extrapolate(points, 0.8).displacement[0] - expected.displacement[0]).norm(), 1e-2);
}

TEST(Predictor, adds_nothing_to_what_is_left_in_rotations) { // those of thin shells are hardly resisted
  std::vector<PathPoint> points;
  constexpr double left = 1e-8;
  for (int i = 0; i < 8; ++i) {
    points.push_back({0.1 * i, on_path(0.1 * i, 2)});
    points.back().state.rotation[0] = rotation_of({i % 2 == 0 ? left : -left, 0, 0});
  }
  EXPECT_LT(spin_of(predict(points, 0.8).rotation[0]).norm(), 16 * left);
  EXPECT_GT(spin_of(extrapolate(points, 0.8).rotation[0]).norm(), 200 * left);
}

} // namespace
} // namespace dielast::fem::state_test
