// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/predictor.hpp"

#include <cmath>
#include <vector>

namespace dielast::fem {

namespace {

/// How far the displacements that polynomials through all of the points and all but the first foretell are
/// apart, squared: a multiple of the points' divided difference.
double change_by_first(std::span<const PathPoint> points, double parameter) {
  std::vector<double> weight;
  for (const PathPoint& point : points) {
    double product = 1;
    for (const PathPoint& other : points)
      if (&other != &point) product *= point.parameter - other.parameter;
    weight.push_back(1 / product);
  }
  double reach = 1;
  for (const PathPoint& point : points.subspan(1)) reach *= parameter - point.parameter;
  double sum = 0;
  for (std::size_t n = 0; n < points[0].state.displacement.size(); ++n) {
    Eigen::Vector3d difference = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) difference += weight[i] * points[i].state.displacement[n];
    sum += difference.squaredNorm();
  }
  return reach * reach * sum;
}

} // namespace

State predict(std::span<const PathPoint> points, double parameter) {
  constexpr std::size_t always = 4;
  std::size_t count = std::min(points.size(), always);
  if (count < points.size())
    for (double before = change_by_first(points.last(count), parameter); count < points.size(); ++count) {
      const double change = change_by_first(points.last(count + 1), parameter);
      if (!(change < before)) break;
      before = change;
    }
  return extrapolate(points.last(count), parameter);
}

} // namespace dielast::fem
