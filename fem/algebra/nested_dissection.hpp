// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/sparse_matrix.hpp"

#include <vector>

namespace dielast::fem {

/// Order in which the equations of a pattern are to be eliminated, one of few new entries: nested dissection
/// by METIS (Karypis & Kumar 1998) of the equations that no other covers. An equation is covered by another
/// whose neighbours and itself include all of its own: as the components of a node are by one of them, and
/// the middle of an edge by the edge's ends. What is covered adds no new entry right before the first
/// equation that covers it, and a separator of the others separates it, too; of a mesh of 6-node triangles an
/// eighth is left to METIS. Throws std::bad_alloc.
std::vector<int> nested_dissection(const SparseSymmetric& matrix);

/// Place of each vertex of a graph in the order by METIS of them all. `neighbours`, from `start` on: at least
/// those with higher numbers. Throws std::bad_alloc.
std::vector<int> metis_positions(const std::vector<int>& start, const std::vector<int>& neighbours);

} // namespace dielast::fem
