// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"

namespace dielast::fem {

/// Adds the tangent of an element with a NodeOrder (lower triangle row by row; of its first `unknowns` of
/// each node, and further ones, where it has some, up to `all` dofs) node by node: a place for each pair of
/// nodes instead of one for each entry.
///
/// The columns of a node have the same rows below it, so that its entries in the rows of another node follow
/// one another in each column, and the next column is shorter by one. Scatter::pair has the place of the
/// first entry of each pair, (1,0), (2,0), (2,1), ...; of elements where places are others the first number
/// is -1 - the element's number among those that have slots.
template<int nodes, int unknowns, int all>
void add_by_nodes(const Scatter& scatter, int element, std::span<const double> packed) {
  constexpr int pairs = nodes * (nodes - 1) / 2;
  const int* place = scatter.pair + static_cast<std::ptrdiff_t>(element) * pairs;
  if (*place < 0) return scatter.add_tangent(-1 - *place, packed, all * (all + 1) / 2);
  const int* const equation = scatter.equation + static_cast<std::ptrdiff_t>(element) * all;
  for (int a = 0; a < nodes; ++a) {
    const int own = equation[a * unknowns];
    const double* row[unknowns];
    for (int i = 0; i < unknowns; ++i) {
      const int k = a * unknowns + i;
      row[i] = packed.data() + k * (k + 1) / 2;
    }
    for (int b = 0; b < a; ++b, ++place) {
      const int other = equation[b * unknowns], first = b * unknowns;
      const int* const start = scatter.column_start + (own > other ? other : own);
      const int length = start[1] - start[0];
      double* to = scatter.tangent + *place;
      for (int j = 0; j < unknowns; to += length - ++j)
        for (int i = 0; i < unknowns; ++i) to[i] += own > other ? row[i][first + j] : row[j][first + i];
    }
    for (int j = 0; j < unknowns; ++j) {
      double* const to = scatter.tangent + scatter.column_start[own + j];
      for (int i = j; i < unknowns; ++i) to[i - j] += row[i][a * unknowns + j];
    }
  }
}

} // namespace dielast::fem
