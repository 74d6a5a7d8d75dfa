// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/dense_products.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace dielast::fem {

namespace {

#ifdef __AVX512F__ // 32 registers
constexpr int register_bytes = 64, tile_registers = 2, tile_columns = 8;
#else
constexpr int register_bytes = 32, tile_registers = 3, tile_columns = 4;
#endif

/// A vector register, and how many numbers it holds.
template<class Real>
struct Register {
  typedef Real Type __attribute__((vector_size(register_bytes)));
  typedef Real Unaligned __attribute__((vector_size(register_bytes), aligned(sizeof(Real)), may_alias));
  static constexpr int size = register_bytes / static_cast<int>(sizeof(Real));
};

constexpr int most_depth = 256;   ///< of A and B at once: their tiles stay in the nearest cache
constexpr int most_columns = 512; ///< of B at once, in the next one
constexpr int block_rows = 96;    ///< of A at once: a multiple of every tile's rows

/// Parts of A and B, tile by tile, each by columns; beyond the last row zeros.
template<class Real>
struct Workspace {
  alignas(64) Real left[block_rows * most_depth];
  alignas(64) Real right[(most_columns + tile_columns) * most_depth];
};

template<class Real>
Workspace<Real>& workspace() {
  thread_local const auto mine = std::make_unique<Workspace<Real>>();
  return *mine;
}

template<int tile, class Real>
void pack(const Real* from, int stride, int rows, int depth, Real* to) {
  for (; rows >= tile; rows -= tile, from += tile)
    for (int k = 0; k < depth; ++k, to += tile)
      std::copy_n(from + static_cast<std::ptrdiff_t>(k) * stride, tile, to);
  if (rows > 0)
    for (int k = 0; k < depth; ++k, to += tile) {
      const Real* const column = from + static_cast<std::ptrdiff_t>(k) * stride;
      for (int i = 0; i < tile; ++i) to[i] = i < rows ? column[i] : 0;
    }
}

/// C -= A B^T of one tile, `rows` x `columns` of it.
template<class Real>
void multiply_tile(int depth, const Real* left, const Real* right, Real* C, int stride, int rows, int columns,
                   bool overwrites) {
  using Vector = typename Register<Real>::Type;
  using Unaligned = typename Register<Real>::Unaligned;
  constexpr int lanes = Register<Real>::size, tile_rows = tile_registers * lanes;
  Vector sum[tile_columns][tile_registers] = {};
  for (int k = 0; k < depth; ++k, left += tile_rows, right += tile_columns) {
    Vector a[tile_registers];
    for (int v = 0; v < tile_registers; ++v) a[v] = *reinterpret_cast<const Vector*>(left + v * lanes);
    for (int j = 0; j < tile_columns; ++j)
      for (int v = 0; v < tile_registers; ++v) sum[j][v] += a[v] * right[j];
  }
  if (rows == tile_rows && columns == tile_columns) {
    for (int j = 0; j < tile_columns; ++j)
      for (int v = 0; v < tile_registers; ++v) {
        auto& to = *reinterpret_cast<Unaligned*>(C + static_cast<std::ptrdiff_t>(j) * stride + v * lanes);
        to = overwrites ? -sum[j][v] : to - sum[j][v];
      }
    return;
  }
  for (int j = 0; j < columns; ++j) {
    const Real* const product = reinterpret_cast<const Real*>(sum[j]);
    Real* const to = C + static_cast<std::ptrdiff_t>(j) * stride;
    if (overwrites)
      for (int i = 0; i < rows; ++i) to[i] = -product[i];
    else
      for (int i = 0; i < rows; ++i) to[i] -= product[i];
  }
}

/// Rows first..last-1 of C -= A B^T, or C = -A B^T: columns 0..columns-1, as far as they lie on or below the
/// diagonal.
template<class Real>
struct Product {
  int columns, depth;
  const Real *A, *B;
  int stride;
  Real* C;
  int stride_C;
  bool overwrites;

  void operator()(int first, int last) const {
    constexpr int tile_rows = tile_registers * Register<Real>::size;
    static_assert(block_rows % tile_rows == 0);
    Workspace<Real>& space = workspace<Real>();
    const int end = std::min(columns, last);
    for (int column = 0; column < end; column += most_columns) {
      const int width = std::min(most_columns, end - column);
      for (int k = 0; k < depth; k += most_depth) {
        const int deep = std::min(most_depth, depth - k);
        const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(k) * stride;
        pack<tile_columns>(B + from + column, stride, width, deep, space.right);
        for (int row = first; row < last; row += block_rows) {
          const int height = std::min(block_rows, last - row);
          pack<tile_rows>(A + from + row, stride, height, deep, space.left);
          for (int j = 0; j < width; j += tile_columns)
            for (int i = 0; i < height; i += tile_rows) {
              if (row + i + tile_rows <= column + j) continue; // above the diagonal
              multiply_tile(deep, space.left + static_cast<std::ptrdiff_t>(i) * deep,
                            space.right + static_cast<std::ptrdiff_t>(j) * deep,
                            C + static_cast<std::ptrdiff_t>(column + j) * stride_C + row + i, stride_C,
                            std::min(tile_rows, height - i), std::min(tile_columns, width - j),
                            overwrites && k == 0);
            }
        }
      }
    }
  }
};

constexpr int block_columns = 32; ///< of a panel that are factored together

/// L of a block of a panel by rows, its diagonal inverted.
template<class Real>
struct DiagonalBlock {
  Real L[block_columns][block_columns];

  /// False: not positive definite.
  bool factor(int width, Real* block, int stride) {
    for (int j = 0; j < width; ++j)
      for (int i = j; i < width; ++i) L[i][j] = block[static_cast<std::ptrdiff_t>(j) * stride + i];
    for (int j = 0; j < width; ++j) {
      for (int i = j; i < width; ++i) {
        Real sum = L[i][j];
        for (int k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
        L[i][j] = sum;
      }
      if (!(L[j][j] > 0) || !std::isfinite(L[j][j])) return false;
      const Real root = std::sqrt(L[j][j]), inverse = 1 / root;
      block[static_cast<std::ptrdiff_t>(j) * stride + j] = root;
      for (int i = j + 1; i < width; ++i) {
        L[i][j] *= inverse;
        block[static_cast<std::ptrdiff_t>(j) * stride + i] = L[i][j];
      }
      L[j][j] = inverse;
    }
    return true;
  }

  /// x <- x L^-T for rows first..last-1 of x.
  void divide(int width, Real* x, int stride, int first, int last) const {
    using Vector = typename Register<Real>::Type;
    constexpr int together = 4, rows = together * Register<Real>::size;
    alignas(64) Real part[block_columns][rows];
    for (; first < last; first += rows) {
      const int here = std::min(rows, last - first);
      for (int j = 0; j < width; ++j) {
        const Real* const column = x + static_cast<std::ptrdiff_t>(j) * stride + first;
        if (here == rows)
          std::copy_n(column, rows, part[j]);
        else
          for (int i = 0; i < rows; ++i) part[j][i] = i < here ? column[i] : 0;
      }
      for (int j = 0; j < width; ++j) {
        Vector sum[together];
        auto* const own = reinterpret_cast<Vector*>(part[j]);
        for (int v = 0; v < together; ++v) sum[v] = own[v];
        for (int k = 0; k < j; ++k)
          for (int v = 0; v < together; ++v) sum[v] -= L[j][k] * reinterpret_cast<const Vector*>(part[k])[v];
        for (int v = 0; v < together; ++v) own[v] = sum[v] * L[j][j];
      }
      for (int j = 0; j < width; ++j)
        std::copy_n(part[j], here, x + static_cast<std::ptrdiff_t>(j) * stride + first);
    }
  }
};

/// Rows of a block of `rows`, each of which costs so many multiplications: all, where threads are not worth
/// waking for.
int rows_together(int rows, double multiplications) {
  constexpr double worth_threads = 1e6;
  return rows * multiplications < worth_threads ? rows : block_rows;
}

} // namespace

template<class Real>
void minus_square(int size, int depth, const Real* A, int stride, Real* C, int stride_C, Workers& workers) {
  workers.run_blocks(size, rows_together(size, 0.5 * size * depth),
                     Product<Real>{size, depth, A, A, stride, C, stride_C, true});
}

template<class Real>
bool factor_panel(int width, int height, Real* panel, Workers& workers) {
  for (int column = 0; column < width; column += block_columns) {
    const int columns = std::min(block_columns, width - column);
    Real* const block = panel + static_cast<std::ptrdiff_t>(column) * height + column;
    if (column > 0)
      workers.run_blocks(
          height - column, rows_together(height - column, static_cast<double>(columns) * column),
          Product<Real>{columns, column, panel + column, panel + column, height, block, height, false});
    DiagonalBlock<Real> diagonal;
    if (!diagonal.factor(columns, block, height)) return false;
    workers.run_blocks(
        height - column - columns, rows_together(height - column - columns, 0.5 * columns * columns),
        [&](int first, int last) { diagonal.divide(columns, block + columns, height, first, last); });
  }
  return true;
}

template void minus_square(int, int, const float*, int, float*, int, Workers&);
template void minus_square(int, int, const double*, int, double*, int, Workers&);
template bool factor_panel(int, int, float*, Workers&);
template bool factor_panel(int, int, double*, Workers&);

} // namespace dielast::fem
