// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/state.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::fem {

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& spin) {
  const double angle = spin.norm();
  // sin(a/2)/a by its series where the division would lose digits
  const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
  Eigen::Quaterniond q(std::cos(angle / 2), factor * spin.x(), factor * spin.y(), factor * spin.z());
  q.normalize();
  return q;
}

Eigen::Vector3d spin_of(const Eigen::Quaterniond& rotation) {
  const double sine = rotation.vec().norm();
  const bool is_small = sine == 0 || (sine < 1e-8 && rotation.w() > 0);
  const double factor = is_small ? 2 / rotation.w() : 2 * std::atan2(sine, rotation.w()) / sine;
  return factor * rotation.vec();
}

Eigen::Vector3d angle_near(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& expected) {
  constexpr double turn = 2 * std::numbers::pi, period = 2 * turn; // of the quaternion
  constexpr double close = 0.5; // sine of half the angle: within 60 deg of a whole turn
  const double sine = rotation.vec().norm();
  if (sine < close) {
    const Eigen::Vector3d rest = spin_of(Eigen::Quaterniond(rotation.coeffs() * (rotation.w() < 0 ? -1 : 1)));
    const Eigen::Vector3d whole = expected - rest;
    const double turns = std::round(whole.norm() / turn);
    return turns > 0 ? Eigen::Vector3d(turns * turn * whole.normalized() + rest) : rest;
  }
  const Eigen::Vector3d spin = spin_of(rotation), axis = rotation.vec() / sine;
  const double angle = spin.norm(), periods = std::round((expected.dot(axis) - angle) / period);
  const Eigen::Vector3d near = periods == 0 ? spin : Eigen::Vector3d((angle + periods * period) * axis);
  return (near - expected).norm() <= turn / 2 ? near : expected;
}

std::vector<double> weights_at(std::span<const PathPoint> points, double parameter) {
  std::vector<double> weight(points.size(), 1.0);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < points.size(); ++j)
      if (j != i)
        weight[i] *= (parameter - points[j].parameter) / (points[i].parameter - points[j].parameter);
  return weight;
}

State extrapolate(std::span<const PathPoint> points, double parameter) {
  const std::vector<double> weight = weights_at(points, parameter);
  const State& last = points.back().state;
  State result = last;
  for (std::size_t n = 0; n < last.displacement.size(); ++n) {
    Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i)
      displacement += weight[i] * points[i].state.displacement[n];
    result.displacement[n] = displacement;
    const auto is_last = [&](const PathPoint& p) {
      return p.state.rotation[n].coeffs() == last.rotation[n].coeffs();
    };
    if (std::ranges::all_of(points, is_last)) continue; // nodes of films never turn
    Eigen::Vector3d spin = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      spin += weight[i] * spin_of(points[i].state.rotation[n] * last.rotation[n].conjugate());
    result.rotation[n] = rotation_of(spin) * last.rotation[n];
    result.angle[n] = angle_near(result.rotation[n], last.angle[n] + spin);
  }
  for (std::size_t s = 0; s < last.scalar.size(); ++s) {
    result.scalar[s] = 0;
    for (std::size_t i = 0; i < points.size(); ++i) result.scalar[s] += weight[i] * points[i].state.scalar[s];
  }
  return result;
}

} // namespace dielast::fem
