// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "meshing/mesh.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

namespace dielast::fem {

/// Scatters the second derivatives of an element: the lower triangle of `second`.
template<int dofs, class Matrix>
void add_tangent(const Scatter& scatter, int element, const Matrix& second) {
  std::array<double, dofs*(dofs + 1) / 2> packed;
  std::size_t k = 0;
  for (int i = 0; i < dofs; ++i)
    for (int j = 0; j <= i; ++j) packed[k++] = second(i, j);
  scatter.add_tangent(element, packed);
}

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
    if (scatter.tangent) add_tangent<dofs>(scatter, element, second);
  }
};

/// Throws std::invalid_argument where two surfaces have nodes in common.
inline void require_apart(const meshing::CellBlock& one, const meshing::CellBlock& other) {
  const std::set<int> nodes(one.nodes.begin(), one.nodes.end());
  if (std::ranges::any_of(other.nodes, [&](int node) { return nodes.contains(node); }))
    throw std::invalid_argument("surfaces in contact have no nodes in common");
}

} // namespace dielast::fem
