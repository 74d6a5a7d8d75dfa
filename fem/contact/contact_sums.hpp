// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/elements/lower_triangle.hpp"
#include "fem/model/element_block.hpp"
#include "meshing/mesh.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace dielast::fem {

/// Energy of one element of a contact with its derivatives, summed over points.
template<int dofs>
struct ContactSums {
  double energy = 0;
  bool feasible = true;
  bool any = false; ///< whether anything touches
  Eigen::Vector<double, dofs> first = Eigen::Vector<double, dofs>::Zero();
  Eigen::Matrix<double, dofs, dofs> second = Eigen::Matrix<double, dofs, dofs>::Zero();

  void add_to(Evaluation& result, int element, const Scatter& scatter) const {
    result.energy += energy;
    result.feasible = result.feasible && feasible;
    if (!any) return;
    if (scatter.residual) scatter.add_residual(element, std::span(first.data(), dofs));
    if (scatter.tangent) scatter.add_tangent(element, lower_triangle<dofs>(second));
  }
};

/// Throws std::invalid_argument where two surfaces have nodes in common.
inline void require_apart(const meshing::CellBlock& one, const meshing::CellBlock& other) {
  const std::set<int> nodes(one.nodes.begin(), one.nodes.end());
  if (std::ranges::any_of(other.nodes, [&](int node) { return nodes.contains(node); }))
    throw std::invalid_argument("have nodes in common: what touches has its own");
}

} // namespace dielast::fem
