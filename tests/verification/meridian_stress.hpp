// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/dofs.hpp"
#include "meshing/mesh.hpp"

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace dielast::fem::test {

/// lambda_1 of a neo-Hookean film of revolution that carries the nominal stress s_1 along its meridian:
/// s_1/mu = l1 - l1^-3 l2^-2 - k l1 l2^2, k = eps (Phi/H)^2/mu.
inline double meridional_stretch(double stress, double l2, double k) {
  double l1 = 1;
  for (int i = 0; i < 100; ++i) {
    const double error = l1 - std::pow(l1, -3) / (l2 * l2) - k * l1 * l2 * l2 - stress;
    l1 -= error / (1 + 3 * std::pow(l1, -4) / (l2 * l2) - k * l2 * l2);
  }
  return l1;
}

/// Radial and vertical force (N) that holds an edge, of the full turn. Forces on an edge converge as energies
/// do, faster than stresses inside elements.
inline Eigen::Vector2d pull(const DofMap& dofs, const meshing::Mesh& mesh, const std::vector<int>& edge,
                            const Eigen::VectorXd& force) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const int a : edge) {
    const Eigen::Vector3d& X = mesh.nodes[static_cast<std::size_t>(a)];
    const Eigen::Vector2d outwards = X.head<2>().normalized();
    for (const int c : {0, 1})
      if (const int e = dofs.equation(a, c); e != DofMap::absent) sum[0] += force[e] * outwards[c];
    // where an edge moves as one it has one equation
    if (a == edge.front() || dofs.equation(a, 2) != dofs.equation(edge.front(), 2))
      sum[1] += force[dofs.equation(a, 2)];
  }
  return sum;
}

} // namespace dielast::fem::test
