// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/centreline.hpp"

#include "fem/contact/barrier.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

using Eigen::Vector2d;

double Centreline::nearest(const PointAndLine& x) const {
  if (shape_ == Shape::point) return 0;
  if (shape_ == Shape::straight) {
    const Vector2d along = x[2] - x[1];
    return std::clamp((x[0] - x[1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
  }
  const Vector2d bend = x[1] + x[2] - 2 * x[3]; // c(s) = x1 + slope s + 2 bend s^2
  const Vector2d slope = x[2] - x[1] - 2 * bend;
  // The squared distance is convex along a line that bends little within it: one start finds its minimum.
  const double bent = 4 * bend.norm();
  const double slowest = (slope + 2 * bend).norm() - bent / 2;
  const bool convex =
      slowest > 0 && slowest * slowest > bent * ((x[0] - at(x, 0.5)).norm() + slope.norm() + bent);
  const int starts = convex ? 1 : 5;
  constexpr int most_steps = 20;
  double best = 0, least = (x[0] - x[1]).squaredNorm();
  for (int start = 0; start < starts; ++start) {
    double s = convex ? 0.5 : start / 4.0;
    for (int step = 0; step < most_steps; ++step) {
      const Vector2d away = at(x, s) - x[0], first = slope + 4 * s * bend;
      const double second = first.squaredNorm() + 4 * away.dot(bend);
      const double to =
          std::clamp(s - away.dot(first) / (second > 0 ? second : first.squaredNorm()), 0.0, 1.0);
      const bool there = std::abs(to - s) < 1e-14;
      s = to;
      if (there) break;
    }
    if (const double distance = (at(x, s) - x[0]).squaredNorm(); distance < least) {
      least = distance;
      best = s;
    }
  }
  return best;
}

materials::Dual<Centreline::size> Centreline::nearest_with_derivatives(const PointAndLine& x) const {
  using Dual = materials::Dual<size>;
  Dual s(nearest(x));
  if (!(s.value > 0 && s.value < 1)) return s;
  // Each of Newton's steps for 0 = (c(s) - x) . c'(s) adds an order of derivatives.
  for (int step = 0; step < 2; ++step) {
    Dual value = 0, derivative = 0;
    for (int i = 0; i < 2; ++i) {
      const auto at = [&](int a) { return Dual::variable(x[static_cast<std::size_t>(a)][i], 2 * a + i); };
      const Dual bend = at(1) + at(2) - 2.0 * at(3), slope = at(2) - at(1) - 2.0 * bend;
      const Dual away = at(1) + s * (slope + 2.0 * s * bend) - at(0), first = slope + 4.0 * s * bend;
      value += away * first;
      derivative += first * first + 4.0 * away * bend;
    }
    s = s - value / derivative;
  }
  return s;
}

double Centreline::least_distance(const PointAndLine& x) const {
  const Vector2d centre = (x[1] + x[2]) / 2;
  const double radius = std::max((x[1] - x[2]).norm() / 2, (control(x) - centre).norm());
  return (x[0] - centre).norm() - radius;
}

double Centreline::distance(const PointAndLine& x) const { return (x[0] - at(x, nearest(x))).norm(); }

materials::Dual<Centreline::size> Centreline::distance_with_derivatives(const PointAndLine& x) const {
  using Dual = materials::Dual<size + 1>;
  const double nearest = this->nearest(x);
  const bool follows = nearest > 0 && nearest < 1;
  const std::array<Dual, 3> N = shape(follows ? Dual::variable(nearest, size) : Dual(nearest));
  Dual squared = 0;
  for (int i = 0; i < 2; ++i) {
    Dual away = Dual::variable(x[0][i], i);
    for (std::size_t a = 0; a < 3; ++a)
      away += -(N[a] * Dual::variable(x[a + 1][i], 2 * static_cast<int>(a + 1) + i));
    squared += away * away;
  }
  const Dual full = sqrt(squared);
  materials::Dual<size> distance(full.value);
  distance.gradient = full.gradient.head<size>();
  distance.hessian = full.hessian.topLeftCorner<size, size>();
  const double stiffness = full.hessian(size, size);
  const Eigen::Vector<double, size> mixed = full.hessian.col(size).head<size>();
  if (follows && stiffness > 0) distance.hessian -= mixed * mixed.transpose() / stiffness;
  return distance;
}

double Centreline::free_way(const PointAndLine& from, const PointAndLine& to, double touching,
                            double most) const {
  constexpr double near = 1.2;
  const Vector2d moved = to[0] - from[0];
  const double speed = std::max({(to[1] - from[1] - moved).norm(), (to[2] - from[2] - moved).norm(),
                                 (control(to) - control(from) - moved).norm()});
  if (least_distance(from) - touching > most * speed) return most;
  double gap = distance(from) - touching;
  const double least = Barrier::kept * gap;
  for (double part = 0;;) {
    if (gap - least >= (most - part) * speed) return most;
    if (gap <= near * least) return part;
    part += (gap - least) / speed;
    PointAndLine x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = from[i] + part * (to[i] - from[i]);
    gap = distance(x) - touching;
  }
}

} // namespace dielast::fem
