// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/machine/workers.hpp"

namespace dielast::fem {

// What a front of a sparse matrix needs of dense algebra, ours because Debian's serial OpenBLAS gives wrong
// results where several threads call it at once. Matrices by columns; `stride` is the distance of columns.
// Every entry is one sum in one order, wherever the matrices lie in memory and whichever thread computes it.
// Of what is square only the lower triangle is needed, and what lies above may become anything.

/// C = -A A^T, A of `size` rows and `depth` columns.
template<class Real>
void minus_square(int size, int depth, const Real* A, int stride, Real* C, int stride_C, Workers& workers);

/// A panel of `height` rows becomes one of L, A = L L^T: its first `width` rows the lower triangle, the rows
/// below A L^-T. False where the matrix is not positive definite.
template<class Real>
[[nodiscard]] bool factor_panel(int width, int height, Real* panel, Workers& workers);

} // namespace dielast::fem
