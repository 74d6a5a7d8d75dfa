// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dielast::fem {

/// Lower triangle of a symmetric matrix by compressed columns, rows ascending, the diagonal first in every
/// column.
struct SparseSymmetric {
  int size = 0;
  std::vector<int> column_start; ///< size + 1 entries
  std::vector<int> rows;
  std::vector<double> values;

  /// Place of an entry that exists; column <= row.
  int place(int column, int row) const {
    const auto first = rows.begin() + column_start[static_cast<std::size_t>(column)];
    const auto last = rows.begin() + column_start[static_cast<std::size_t>(column) + 1];
    return static_cast<int>(std::lower_bound(first, last, row) - rows.begin());
  }
};

} // namespace dielast::fem
