// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled for one set of instructions or for several, as DIELAST_KERNELS. No function of a library may be
// called here: the linker would take one for the whole program that not every processor can execute.
#include "fem/algebra/dense_kernels.hpp"

namespace dielast::fem {

namespace {

#ifdef __AVX512F__ // 32 registers
constexpr int register_bytes = 64, tile_registers = 2, tile_columns = 8;
#elif defined(__AVX2__)
constexpr int register_bytes = 32, tile_registers = 3, tile_columns = 4;
#else
constexpr int register_bytes = 16, tile_registers = 2, tile_columns = 4;
#endif

constexpr int smaller(int a, int b) { return a < b ? a : b; }

/// A vector register, and how many numbers it holds.
template<class Real>
struct Register {
  typedef Real Type __attribute__((vector_size(register_bytes)));
  typedef Real Unaligned __attribute__((vector_size(register_bytes), aligned(sizeof(Real)), may_alias));
  static constexpr int size = register_bytes / static_cast<int>(sizeof(Real));
};

/// Rows of A or B, tile by tile, each by columns; beyond the last row zeros.
template<int tile, class Real>
void pack(const Real* from, int stride, int rows, int depth, Real* to) {
  for (; rows >= tile; rows -= tile, from += tile)
    for (int k = 0; k < depth; ++k, to += tile) {
      const Real* const column = from + static_cast<std::ptrdiff_t>(k) * stride;
      for (int i = 0; i < tile; ++i) to[i] = column[i];
    }
  if (rows > 0)
    for (int k = 0; k < depth; ++k, to += tile) {
      const Real* const column = from + static_cast<std::ptrdiff_t>(k) * stride;
      for (int i = 0; i < tile; ++i) to[i] = i < rows ? column[i] : 0;
    }
}

/// C -= A B^T of `registers` of rows and one tile of columns, `rows` x `columns` of it.
template<int registers, class Real>
void multiply_tile(int depth, const Real* left, const Real* right, Real* C, int stride, int rows, int columns,
                   bool overwrites) {
  using Vector = typename Register<Real>::Type;
  using Unaligned = typename Register<Real>::Unaligned;
  constexpr int lanes = Register<Real>::size;
  Vector sum[tile_columns][registers]; // in registers: nothing may ask for its address
  for (int j = 0; j < tile_columns; ++j)
    for (int v = 0; v < registers; ++v) sum[j][v] = Vector{};
  for (int k = 0; k < depth; ++k, left += lanes, right += tile_columns) {
    Vector a[registers];
    for (int v = 0; v < registers; ++v)
      a[v] = *reinterpret_cast<const Vector*>(left + static_cast<std::ptrdiff_t>(v) * lanes * depth);
    for (int j = 0; j < tile_columns; ++j)
      for (int v = 0; v < registers; ++v) sum[j][v] += a[v] * right[j];
  }
  if (rows >= registers * lanes && columns == tile_columns) {
    for (int j = 0; j < tile_columns; ++j)
      for (int v = 0; v < registers; ++v) {
        auto& to = *reinterpret_cast<Unaligned*>(C + static_cast<std::ptrdiff_t>(j) * stride + v * lanes);
        to = overwrites ? -sum[j][v] : to - sum[j][v];
      }
    return;
  }
  const int filled = smaller(rows, registers * lanes);
  Vector copy[tile_columns][registers];
  for (int j = 0; j < tile_columns; ++j)
    for (int v = 0; v < registers; ++v) copy[j][v] = sum[j][v];
  for (int j = 0; j < columns; ++j) {
    const Real* const product = reinterpret_cast<const Real*>(copy[j]);
    Real* const to = C + static_cast<std::ptrdiff_t>(j) * stride;
    if (overwrites)
      for (int i = 0; i < filled; ++i) to[i] = -product[i];
    else
      for (int i = 0; i < filled; ++i) to[i] -= product[i];
  }
}

/// All rows, as many registers together as there are.
template<int registers, class Real>
void multiply_rows(int depth, const Real* left, const Real* right, Real* C, int stride, int rows, int columns,
                   bool overwrites) {
  constexpr int tile_rows = registers * Register<Real>::size;
  for (; rows > tile_rows - Register<Real>::size; rows -= tile_rows) {
    multiply_tile<registers>(depth, left, right, C, stride, rows, columns, overwrites);
    left += static_cast<std::ptrdiff_t>(tile_rows) * depth;
    C += tile_rows;
  }
  if constexpr (registers > 1)
    multiply_rows<registers - 1>(depth, left, right, C, stride, rows, columns, overwrites);
}

template<class Real>
void multiply(const DenseProduct<Real>& product, int first, int last, DenseWorkspace<Real>& space) {
  constexpr int lanes = Register<Real>::size;
  constexpr int block_rows = DenseWorkspace<Real>::block_rows;
  static_assert(block_rows % lanes == 0 && tile_columns <= DenseWorkspace<Real>::widest_tile);
  const int end = smaller(product.columns, last);
  for (int column = 0; column < end; column += space.most_columns) {
    const int width = smaller(space.most_columns, end - column);
    for (int k = 0; k < product.depth; k += space.most_depth) {
      const int deep = smaller(space.most_depth, product.depth - k);
      const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(k) * product.stride;
      pack<tile_columns>(product.B + from + column, product.stride, width, deep, space.right);
      for (int row = first; row < last; row += block_rows) {
        const int height = smaller(block_rows, last - row);
        pack<lanes>(product.A + from + row, product.stride, height, deep, space.left);
        for (int j = 0; j < width; j += tile_columns) {
          const int above = column + j - row, i = above > 0 ? above / lanes * lanes : 0; // the diagonal
          if (i >= height) break;
          multiply_rows<tile_registers>(
              deep, space.left + static_cast<std::ptrdiff_t>(i) * deep,
              space.right + static_cast<std::ptrdiff_t>(j) * deep,
              product.C + static_cast<std::ptrdiff_t>(column + j) * product.stride_C + row + i,
              product.stride_C, height - i, smaller(tile_columns, width - j), product.overwrites && k == 0);
        }
      }
    }
  }
}

inline float root(float x) { return __builtin_sqrtf(x); }
inline double root(double x) { return __builtin_sqrt(x); }

template<class Real>
bool factor(int width, Real* A, int stride, DiagonalBlock<Real>& block) {
  using Vector = typename Register<Real>::Type;
  constexpr int lanes = Register<Real>::size, most = DenseWorkspace<Real>::block_columns;
  static_assert(most % lanes == 0);
  const int vectors = (width + lanes - 1) / lanes;
  Vector columns[most][most / lanes]; // of L; above the diagonal anything
  for (int j = 0; j < width; ++j) {
    const Real* const column = A + static_cast<std::ptrdiff_t>(j) * stride;
    auto* const own = reinterpret_cast<Real*>(columns[j]);
    for (int i = 0; i < vectors * lanes; ++i) own[i] = i >= j && i < width ? column[i] : 0;
  }
  for (int j = 0; j < width; ++j) {
    const auto* const own = reinterpret_cast<const Real*>(columns[j]);
    if (!(own[j] > 0) || __builtin_isinf(own[j])) return false;
    const Real pivot = root(own[j]), inverse = 1 / pivot;
    for (int v = j / lanes; v < vectors; ++v) columns[j][v] *= inverse;
    Real* const column = A + static_cast<std::ptrdiff_t>(j) * stride;
    for (int i = j + 1; i < width; ++i) column[i] = block.L[i][j] = own[i];
    column[j] = pivot;
    block.L[j][j] = inverse;
    for (int k = j + 1; k < width; ++k)
      for (int v = k / lanes; v < vectors; ++v) columns[k][v] -= columns[j][v] * block.L[k][j];
  }
  return true;
}

template<class Real>
void divide(const DiagonalBlock<Real>& block, int width, Real* x, int stride, int first, int last,
            DenseWorkspace<Real>& space) {
  using Vector = typename Register<Real>::Type;
  constexpr int together = 4, rows = together * Register<Real>::size;
  static_assert(rows <= DenseWorkspace<Real>::rows_together);
  for (; first < last; first += rows) {
    const int here = smaller(rows, last - first);
    pack<rows>(x + first, stride, here, width, space.part);
    for (int j = 0; j < width; ++j) {
      Vector sum[together];
      auto* const own = reinterpret_cast<Vector*>(space.part + static_cast<std::ptrdiff_t>(j) * rows);
      for (int v = 0; v < together; ++v) sum[v] = own[v];
      for (int k = 0; k < j; ++k) {
        const auto* const solved =
            reinterpret_cast<const Vector*>(space.part + static_cast<std::ptrdiff_t>(k) * rows);
        for (int v = 0; v < together; ++v) sum[v] -= block.L[j][k] * solved[v];
      }
      Real* const to = x + static_cast<std::ptrdiff_t>(j) * stride + first;
      for (int v = 0; v < together; ++v) own[v] = sum[v] * block.L[j][j];
      const Real* const done = space.part + static_cast<std::ptrdiff_t>(j) * rows;
      for (int i = 0; i < here; ++i) to[i] = done[i];
    }
  }
}

} // namespace

const DenseKernelsOfBoth DIELAST_KERNELS{{multiply<float>, factor<float>, divide<float>},
                                         {multiply<double>, factor<double>, divide<double>}};

} // namespace dielast::fem
