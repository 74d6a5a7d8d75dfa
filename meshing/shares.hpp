// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace dielast::meshing {

/// How much each node of a place has of what is spread evenly over the place as drawn.
struct Shares {
  /// In the order of Mesh::node_sets; they sum to 1. Those of corners of curved quadratic cells may be
  /// negative, and always are where the place is filled with 10-node tetrahedra.
  std::vector<double> of_nodes;
  double size = 0; ///< length, area or volume of what the place is made of; 0 where it is made of points
  /// Some nodes lie on what the place is made of and others do not: all have the same share.
  bool mixed = false;
};

/// Shares in every place: integrals of the shape functions over the place's cells, otherwise over the faces,
/// sides or edges of the mesh's film whose nodes are all in the place; of what is revolved (cells and sides
/// in the plane y = 0) over the full turn. The nodes of a place without any of these have the same share.
std::map<std::string, Shares> shares(const Mesh& mesh, bool of_revolution);

/// How much two nodes have in common of what is spread evenly over a place: the integral of the product of
/// their shape functions over that of 1. A node's share is the sum of those with all nodes, itself among
/// them.
struct CommonShare {
  std::array<int, 2> nodes{}; ///< of the mesh; the first has the lower number
  double share = 0;
};

/// All pairs of different nodes of a place that have something in common; none where the nodes have equal
/// shares as nothing of the film is between them.
std::vector<CommonShare> common_shares(const Mesh& mesh, bool of_revolution, const std::string& place);

} // namespace dielast::meshing
