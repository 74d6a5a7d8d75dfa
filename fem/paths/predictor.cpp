// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/predictor.hpp"

#include <algorithm>
#include <vector>

namespace dielast::fem {

namespace {

constexpr double unnoticed = 1e-11; ///< rotation, in the mean over nodes

/// How far the displacements and the rotations that polynomials through all of the points and all but the
/// first foretell are apart, squared: a multiple of the points' divided difference.
Eigen::Array2d change_by_first(std::span<const PathPoint> points, double parameter) {
  std::vector<double> weight;
  for (const PathPoint& point : points) {
    double product = 1;
    for (const PathPoint& other : points)
      if (&other != &point) product *= point.parameter - other.parameter;
    weight.push_back(1 / product);
  }
  double reach = 1;
  for (const PathPoint& point : points.subspan(1)) reach *= parameter - point.parameter;
  Eigen::Array2d sum = Eigen::Array2d::Zero();
  for (std::size_t n = 0; n < points[0].state.displacement.size(); ++n) {
    Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
    Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      displacement += weight[i] * points[i].state.displacement[n];
      rotation += weight[i] * points[i].state.rotation[n].coeffs();
    }
    sum += Eigen::Array2d(displacement.squaredNorm(), rotation.squaredNorm());
  }
  return reach * reach * sum;
}

} // namespace

State predict(std::span<const PathPoint> points, double parameter) {
  constexpr std::size_t always = 4;
  std::size_t count = std::min(points.size(), always);
  if (count == points.size()) return extrapolate(points, parameter);
  const double least = unnoticed * unnoticed * static_cast<double>(points[0].state.rotation.size());
  for (Eigen::Array2d before = change_by_first(points.last(count), parameter); count < points.size();
       ++count) {
    const Eigen::Array2d change = change_by_first(points.last(count + 1), parameter);
    if (!(change[0] < before[0]) || !(change[1] <= std::max(before[1], least))) break;
    before = change;
  }
  return extrapolate(points.last(count), parameter);
}

} // namespace dielast::fem
