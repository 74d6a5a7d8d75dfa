// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/nested_dissection.hpp"
#include "fem/algebra/sparse_matrix.hpp"
#include "fem/machine/memory.hpp"
#include "fem/machine/one_thread.hpp"

#include <mumps_c_types.h>

#include <new>
#include <string>
#include <vector>

namespace dielast::fem {

/// L D L^T with pivoting of symmetric matrices of one pattern by MUMPS (Amestoy, Duff, L'Excellent & Koster
/// 2001), in the numbers of its `Structure` and of `function`, which does its jobs.
template<class Structure, auto function>
class Mumps {
 public:
  /// Analyses the pattern; the values are not read. Throws std::bad_alloc, and std::runtime_error where there
  /// is less memory than a factor takes. `by_values`: a factorisation may scale and permute by the values.
  Mumps(const SparseSymmetric& matrix, bool by_values)
      : order_(metis_positions(matrix.column_start, matrix.rows)) {
    require_blas_buffer();
    rows_.reserve(matrix.rows.size());
    columns_.reserve(matrix.rows.size());
    matrix.for_each_entry([&](std::size_t, int column, int row) {
      rows_.push_back(row + 1);
      columns_.push_back(column + 1);
    });
    for (int& place : order_) ++place;
    mumps_.par = 1;
    mumps_.sym = 2;
    mumps_.comm_fortran = use_comm_world;
    run(-1);
    for (const int output : {0, 1, 2, 3}) mumps_.icntl[output] = output == 3 ? 0 : -1; // silent
    if (!by_values) mumps_.icntl[5] = 0, mumps_.icntl[11] = 1; // no permutation, the usual kind of order
    mumps_.icntl[23] = 1;                                      // detect null pivots
    mumps_.icntl[13] = 50;                                     // % spare workspace
    mumps_.icntl[6] = 1; // ordered by us: its own choice, SCOTCH, draws another order at random each time
    mumps_.perm_in = order_.data();
    mumps_.n = matrix.size;
    mumps_.nnz = static_cast<MUMPS_INT8>(rows_.size());
    mumps_.irn = rows_.data();
    mumps_.jcn = columns_.data();
    run(1);
    if (mumps_.infog[0] < 0) throw std::bad_alloc();
    constexpr double megabyte = 1e6;
    require_memory(mumps_.infog[16] * megabyte,
                   "the factor with pivoting of " + std::to_string(matrix.size) + " equations");
  }
  ~Mumps() { run(-2); }
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;

  /// `values` in the order of the pattern's; they must live until the last solve(). False: singular to
  /// working precision.
  template<class Number>
  [[nodiscard]] bool factor(Number* values) {
    constexpr int workspace_too_small = -9;
    mumps_.a = values;
    for (run(2); mumps_.infog[0] == workspace_too_small && mumps_.icntl[13] < 1000; run(2))
      mumps_.icntl[13] *= 2;
    return mumps_.infog[0] >= 0 && mumps_.infog[27] == 0;
  }
  int negative_pivots() const { return mumps_.infog[11]; }
  /// After a factor() that failed: the equation whose pivot vanished, -1 where that is not known.
  int singular_equation() const {
    return mumps_.infog[0] >= 0 && mumps_.infog[27] > 0 ? mumps_.pivnul_list[0] - 1 : -1;
  }
  /// B <- A^-1 B, of so many columns. Requires a successful factor().
  template<class Number>
  void solve(Number* B, int columns) {
    mumps_.nrhs = columns;
    mumps_.lrhs = mumps_.n;
    mumps_.rhs = B;
    run(3);
  }

 private:
  static constexpr int use_comm_world = -987654; // MUMPS' own constant

  void run(int job) {
    const OneThread one_thread;
    mumps_.job = job;
    function(&mumps_);
  }

  Structure mumps_{};
  std::vector<int> rows_, columns_, order_;
};

} // namespace dielast::fem
