// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace dielast::fem {

/// The lower triangle of an element's symmetric matrix row by row, as Scatter::add_tangent() takes it.
template<int dofs, class Matrix>
std::array<double, dofs*(dofs + 1) / 2> lower_triangle(const Matrix& matrix) {
  std::array<double, dofs*(dofs + 1) / 2> packed;
  std::size_t k = 0;
  for (int i = 0; i < dofs; ++i)
    for (int j = 0; j <= i; ++j) packed[k++] = matrix(i, j);
  return packed;
}

} // namespace dielast::fem
