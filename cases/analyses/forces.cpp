// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/analyses/forces.hpp"

#include <set>

namespace dielast::cases {
namespace {

/// Sum of what is at the equations of a place's nodes, along each axis, as far as `counts` wants them.
template<class Rule>
Eigen::Vector3d sum_at(const Device& device, const std::string& place, const Eigen::VectorXd& values,
                       Rule counts) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    std::set<int> equations; // nodes that move as one share theirs
    for (const int node : device.mesh.node_sets.at(place))
      equations.insert(device.model.dofs.equation(node, c));
    for (const int e : equations)
      if (e != fem::DofMap::absent && counts(e)) sum[c] += values[e];
  }
  return sum;
}

} // namespace

Eigen::Vector3d support_force(const Device& device, const std::string& place,
                              const Eigen::VectorXd& reaction) {
  return sum_at(device, place, reaction, [&](int e) { return device.model.dofs.is_held(e); });
}

Eigen::Vector3d film_force(const Device& device, const std::string& place, const fem::State& state) {
  Eigen::VectorXd internal = Eigen::VectorXd::Zero(device.model.dofs.count());
  for (int b = 0; b < device.films; ++b) {
    const fem::ElementBlock& block = *device.model.blocks[static_cast<std::size_t>(b)];
    const auto size = static_cast<std::size_t>(block.dofs_per_element());
    std::vector<int> equations(size * static_cast<std::size_t>(block.element_count()));
    for (int element = 0; element < block.element_count(); ++element)
      block.element_equations(element, device.model.dofs,
                              std::span(equations).subspan(size * static_cast<std::size_t>(element), size));
    block.evaluate(state, 0, block.element_count(),
                   {.equation = equations.data(), .residual = internal.data()});
  }
  return -sum_at(device, place, internal, [](int) { return true; });
}

} // namespace dielast::cases
