// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace dielast::fem {

/// Rows first..last-1 of C -= A B^T, or C = -A B^T: its columns as far as they lie on or below the diagonal;
/// what lies above may become anything. Matrices by columns, `stride` the distance of columns.
template<class Real>
struct DenseProduct {
  int columns, depth; ///< of C, and columns of A and B
  const Real *A, *B;
  int stride; ///< of A and B
  Real* C;
  int stride_C;
  bool overwrites;
};

/// What a thread works with.
template<class Real>
struct DenseWorkspace {
  static constexpr int most_depth = 256;   ///< of A and B at once: their tiles stay in the nearest cache
  static constexpr int most_columns = 512; ///< of B at once, in the next one
  static constexpr int block_rows = 96;    ///< of A at once: a multiple of every tile's rows
  static constexpr int widest_tile = 8;    ///< columns
  static constexpr int block_columns = 32; ///< of a panel that are factored together
  static constexpr int rows_together = 64; ///< that are divided, at most
  alignas(64) Real left[block_rows * most_depth];
  alignas(64) Real right[(most_columns + widest_tile) * most_depth];
  alignas(64) Real part[block_columns * rows_together];
};

/// L of a block of a panel by rows, its diagonal inverted.
template<class Real>
struct DiagonalBlock {
  Real L[DenseWorkspace<Real>::block_columns][DenseWorkspace<Real>::block_columns];
};

/// The innermost loops, for one set of instructions.
template<class Real>
struct DenseKernels {
  void (*multiply)(const DenseProduct<Real>& product, int first, int last, DenseWorkspace<Real>& space);
  /// A = L L^T of `width` columns, in place and into `L`. False: not positive definite.
  bool (*factor)(int width, Real* A, int stride, DiagonalBlock<Real>& L);
  /// x <- x L^-T for rows first..last-1 of x.
  void (*divide)(const DiagonalBlock<Real>& L, int width, Real* x, int stride, int first, int last,
                 DenseWorkspace<Real>& space);
};

struct DenseKernelsOfBoth {
  DenseKernels<float> single;
  DenseKernels<double> twice;
};

/// With the instructions that the whole program is compiled for; a portable program has more to choose from.
extern const DenseKernelsOfBoth kernels_of_program, kernels_for_avx2, kernels_for_avx512;

} // namespace dielast::fem
