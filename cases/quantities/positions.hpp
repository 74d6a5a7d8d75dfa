// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/state.hpp"
#include "meshing/mesh.hpp"

#include <string>

namespace dielast::cases {

/// Where a node is in a state, m.
inline Eigen::Vector3d position(const meshing::Mesh& mesh, int node, const fem::State& state) {
  const auto n = static_cast<std::size_t>(node);
  return mesh.nodes[n] + state.displacement[n];
}

/// The mean position of a place's nodes, m.
inline Eigen::Vector3d centroid(const meshing::Mesh& mesh, const std::string& place,
                                const fem::State& state) {
  const auto& nodes = mesh.node_sets.at(place);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int node : nodes) sum += position(mesh, node, state);
  return sum / static_cast<double>(nodes.size());
}

} // namespace dielast::cases
