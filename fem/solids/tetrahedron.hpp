// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>

namespace dielast::fem {

/// Integration point of the reference tetrahedron (0,0,0), (1,0,0), (0,1,0), (0,0,1).
struct TetrahedronPoint {
  Eigen::Vector3d local; ///< xi, eta, zeta
  double weight = 0;     ///< the weights add up to 1/6
};

/// The symmetric rule with 4 points, of degree 2.
const std::array<TetrahedronPoint, 4>& tetrahedron_rule();

/// A point of the rule with 15 points, of degree 5 (Keast 1986), which integrates products of quadratic shape
/// functions. What lies at it is made of what lies at the four points of tetrahedron_rule(), the
/// Jacobian being linear between them.
struct TetrahedronMassPoint {
  Eigen::Vector<double, 10> shape;
  std::array<double, 4> share; ///< of their volumes; those of one add up to 1
};
const std::array<TetrahedronMassPoint, 15>& tetrahedron_mass_rule();

/// Shape functions of a tetrahedron with 4 or 10 nodes (corners, then middles 01, 12, 20, 03, 13, 23).
template<int Nodes>
Eigen::Vector<double, Nodes> tetrahedron_shape(const Eigen::Vector3d& local);

/// Gradients (d/dxi, d/deta, d/dzeta) of these.
template<int Nodes>
Eigen::Matrix<double, Nodes, 3> tetrahedron_slope(const Eigen::Vector3d& local);

} // namespace dielast::fem
