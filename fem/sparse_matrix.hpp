// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace dielast::fem {

/// Lower triangle of a symmetric matrix by compressed columns, rows ascending, the diagonal first in every
/// column.
struct SparseSymmetric {
  int size = 0;
  std::vector<int> column_start; ///< size + 1 entries
  std::vector<int> rows;
  std::vector<double> values;
};

} // namespace dielast::fem
