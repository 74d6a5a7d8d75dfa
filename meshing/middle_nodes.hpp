// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <array>

namespace dielast::meshing {

/// Corners at the ends of the sides, in the order of their middle nodes: of a tetrahedron all, of a triangle
/// the first three, of a line the first.
inline constexpr std::array<std::array<std::size_t, 2>, 6> side_ends{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// Turns 3-node triangles, 4-node tetrahedra and 2-node lines into 6-, 10- and 3-node ones with straight
/// sides; cells that share a side share its middle node. Middle nodes are numbered after all others, by the
/// sides' (smaller, larger) corner numbers.
void add_middle_nodes(Mesh& mesh);

/// The nodes of a cell set, ascending.
std::vector<int> nodes_of(const Mesh& mesh, const CellSet& set);

/// Gives every cell set its node set.
void add_node_sets(Mesh& mesh);

} // namespace dielast::meshing
