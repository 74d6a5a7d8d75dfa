// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/dense_products.hpp"

#include "fem/algebra/dense_kernels.hpp"

#include <algorithm>
#include <memory>
#include <type_traits>

namespace dielast::fem {

namespace {

const DenseKernelsOfBoth& best_kernels() {
#ifdef DIELAST_MORE_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma")) return kernels_for_avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return kernels_for_avx2;
#endif
  return kernels_of_program;
}

template<class Real>
const DenseKernels<Real>& kernels() {
  static const DenseKernelsOfBoth& best = best_kernels();
  if constexpr (std::is_same_v<Real, float>)
    return best.single;
  else
    return best.twice;
}

template<class Real>
DenseWorkspace<Real>& workspace() {
  thread_local const auto mine = std::make_unique<DenseWorkspace<Real>>();
  return *mine;
}

/// f(first, last) for ranges of `rows`, each of which costs so many multiplications: for all at once where
/// threads are not worth waking for.
template<class Function>
void run_rows(Workers& workers, int rows, double multiplications, const Function& f) {
  constexpr double worth_threads = 1e6;
  const int together = rows * multiplications < worth_threads ? rows : DenseWorkspace<double>::block_rows;
  workers.run_blocks(rows, std::max(together, 1), f);
}

template<class Real>
void run_product(Workers& workers, int rows, double multiplications, const DenseProduct<Real>& product) {
  run_rows(workers, rows, multiplications,
           [&](int first, int last) { kernels<Real>().multiply(product, first, last, workspace<Real>()); });
}

} // namespace

template<class Real>
void minus_square(int size, int depth, const Real* A, int stride, Real* C, int stride_C, Workers& workers) {
  run_product<Real>(workers, size, 0.5 * size * depth, {size, depth, A, A, stride, C, stride_C, true});
}

template<class Real>
bool factor_panel(int width, int height, Real* panel, Workers& workers) {
  constexpr int block_columns = DenseWorkspace<Real>::block_columns;
  for (int column = 0; column < width; column += block_columns) {
    const int columns = std::min(block_columns, width - column), below = height - column - columns;
    Real* const block = panel + static_cast<std::ptrdiff_t>(column) * height + column;
    if (column > 0)
      run_product<Real>(workers, height - column, static_cast<double>(columns) * column,
                        {columns, column, panel + column, panel + column, height, block, height, false});
    DiagonalBlock<Real> diagonal;
    if (!kernels<Real>().factor(columns, block, height, diagonal)) return false;
    run_rows(workers, below, 0.5 * columns * columns, [&](int first, int last) {
      kernels<Real>().divide(diagonal, columns, block + columns, height, first, last, workspace<Real>());
    });
  }
  return true;
}

template void minus_square(int, int, const float*, int, float*, int, Workers&);
template void minus_square(int, int, const double*, int, double*, int, Workers&);
template bool factor_panel(int, int, float*, Workers&);
template bool factor_panel(int, int, double*, Workers&);

} // namespace dielast::fem
