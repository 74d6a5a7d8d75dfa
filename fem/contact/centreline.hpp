// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/dual.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>

namespace dielast::fem {

/// A point, the ends of a line and its middle, in the plane, m.
using PointAndLine = std::array<Eigen::Vector2d, 4>;

/// A line between its ends, s = 0..1: a parabola through its middle, or straight; or its first end.
class Centreline {
 public:
  enum class Shape : std::uint8_t { parabola, straight, point };
  static constexpr int size = 8; ///< x and y of the point, of the ends and of the middle

  explicit Centreline(Shape shape) : shape_(shape) {}

  /// Of the ends and the middle; T: double or a dual number.
  template<class T>
  std::array<T, 3> shape(const T& s) const {
    if (shape_ == Shape::point) return {T(1.0), T(0.0), T(0.0)};
    if (shape_ == Shape::straight) return {1.0 - s, s, T(0.0)};
    return {(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0), 4.0 * s * (1.0 - s)};
  }
  /// Of Bezier's control polygon, in whose hull the line is: its ends and this.
  Eigen::Vector2d control(const PointAndLine& x) const {
    const Eigen::Vector2d mean = (x[1] + x[2]) / 2;
    return shape_ == Shape::parabola ? Eigen::Vector2d(2 * x[3] - mean) : mean;
  }
  Eigen::Vector2d at(const PointAndLine& x, double s) const {
    const std::array<double, 3> N = shape(s);
    return N[0] * x[1] + N[1] * x[2] + N[2] * x[3];
  }
  /// The place that is nearest to the point.
  double nearest(const PointAndLine& x) const;
  /// nearest() of a parabola with its derivatives; where it is an end these are 0.
  materials::Dual<size> nearest_with_derivatives(const PointAndLine& x) const;
  /// No more than the distance of point and line: that from a disc about the latter, m.
  double least_distance(const PointAndLine& x) const;
  /// Of the point from the line, m, not negative.
  double distance(const PointAndLine& x) const;
  /// The nearest place s on the line follows: d2g/dx2 = g_xx - g_xs g_ss^-1 g_sx, as g_s = 0 there.
  materials::Dual<size> distance_with_derivatives(const PointAndLine& x) const;
  /// The part of the straight way between two places, 0..`most`, that can be gone until what is left of the
  /// distance beyond `touching` (m) is a tenth; `most`: as much as that. Conservative advancement: as far as
  /// the gap allows at the speed with which point and line move at most.
  double free_way(const PointAndLine& from, const PointAndLine& to, double touching, double most) const;

 private:
  Shape shape_;
};

} // namespace dielast::fem
