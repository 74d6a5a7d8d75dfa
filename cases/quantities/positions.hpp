// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/device.hpp"
#include "fem/model/state.hpp"

#include <string>

namespace dielast::cases {

/// Where a node is in a state, m.
inline Eigen::Vector3d position(const meshing::Mesh& mesh, int node, const fem::State& state) {
  const auto n = static_cast<std::size_t>(node);
  return mesh.nodes[n] + state.displacement[n];
}

/// The mean position over a place, by the shares of its nodes, m.
inline Eigen::Vector3d centroid(const Device& device, const std::string& place, const fem::State& state) {
  const auto& nodes = device.mesh.node_sets.at(place);
  const std::vector<double>& shares = device.shares.at(place).of_nodes;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < nodes.size(); ++n) sum += shares[n] * position(device.mesh, nodes[n], state);
  return sum;
}

} // namespace dielast::cases
