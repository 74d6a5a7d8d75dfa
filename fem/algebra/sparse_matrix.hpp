// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

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
  /// use(place, column, row) for every entry, column by column.
  template<class Use>
  void for_each_entry(const Use& use) const {
    for (int column = 0; column < size; ++column)
      for (int k = column_start[static_cast<std::size_t>(column)];
           k < column_start[static_cast<std::size_t>(column) + 1]; ++k)
        use(static_cast<std::size_t>(k), column, rows[static_cast<std::size_t>(k)]);
  }
  /// x . K x
  double quadratic_form(const Eigen::VectorXd& x) const {
    double sum = 0;
    for_each_entry([&](std::size_t k, int column, int row) {
      sum += (row == column ? 1 : 2) * values[k] * x[column] * x[row];
    });
    return sum;
  }
};

} // namespace dielast::fem
