// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <span>

namespace dielast::fem {

/// Integration point of the reference triangle (0,0), (1,0), (0,1).
struct TrianglePoint {
  double xi = 0, eta = 0;
  double weight = 0; ///< the weights add up to 1/2
};

/// Symmetric rules with 1, 3 (degree 2) or 6 (degree 4, Dunavant 1985) points; other counts throw
/// std::invalid_argument.
std::span<const TrianglePoint> triangle_rule(int points);

/// Shape functions of a triangle with 3 or 6 nodes (corners, then middles 01, 12, 20).
template<int Nodes>
Eigen::Matrix<double, Nodes, 1> shape_values(double xi, double eta);

/// Gradients (d/dxi, d/deta) of these.
template<int Nodes>
Eigen::Matrix<double, Nodes, 2> shape_gradients(double xi, double eta);

} // namespace dielast::fem
