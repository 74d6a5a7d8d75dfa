// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/sparse_matrix.hpp"

#include <cstddef>
#include <vector>

namespace dielast::fem {

/// How the matrices of one symmetric pattern are factored, A = P^T L L^T P: columns of L of nearly equal rows
/// are a supernode, a dense panel; what it changes in the rest of the matrix goes to its parent, which holds
/// the first of its rows below the diagonal (Duff & Reid 1983; Liu 1992). Supernodes are numbered from the
/// leaves to the roots, those below one another without a gap.
struct Supernodes {
  /// `threads`: that factor at once; more take more memory.
  explicit Supernodes(const SparseSymmetric& matrix, int threads = 1);

  int count() const { return static_cast<int>(parent.size()); }
  int width(int s) const { return first_column[at(s) + 1] - first_column[at(s)]; }
  /// Rows of a panel, those of its own columns first.
  int height(int s) const { return row_start[at(s) + 1] - row_start[at(s)]; }
  /// Rows below its own columns: the size of what it gives to its parent.
  int below(int s) const { return height(s) - width(s); }
  const int* rows_of(int s) const { return rows.data() + row_start[at(s)]; }
  /// Place in the parent's rows of each row below.
  const int* place_in_parent(int s) const { return places.data() + row_start[at(s)] + width(s); }
  /// How many rows from each row below on follow one another in the parent.
  const int* together_in_parent(int s) const { return together.data() + row_start[at(s)] + width(s); }

  std::vector<int> permutation;        ///< equation of each column of L
  std::vector<int> first_column;       ///< per supernode, and the number of columns
  std::vector<int> row_start;          ///< of each supernode in `rows`
  std::vector<int> rows;               ///< ascending, columns of L
  std::vector<int> places, together;   ///< beside `rows`: see place_in_parent(), together_in_parent()
  std::vector<int> parent;             ///< -1: a root
  std::vector<int> child_start, child; ///< lists of children
  std::vector<int> roots;
  std::vector<int> first_below;      ///< first of all that stand below each supernode and of itself: no gap
  std::vector<bool> small;           ///< whether all these are so little work that one thread should do it
  std::vector<std::ptrdiff_t> start; ///< of each panel in the values of L, and their number
  /// Entries that follow one another in a column of the matrix, and in the panel along a column or a row.
  struct Run {
    int entry, place; ///< the first, in the matrix and in the panel
    int stride;       ///< of the places: 1, or the panel's height
    int count;
  };
  std::vector<std::ptrdiff_t> run_start;    ///< of each supernode in the next one
  std::vector<Run> runs;                    ///< what the panels hold of the matrix
  std::vector<int> diagonal;                ///< entry of the matrix of each column's diagonal
  std::vector<std::ptrdiff_t> update_start; ///< of what each supernode gives to its parent, in a workspace of
  std::ptrdiff_t update_size = 0;           ///< this size

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  void make_dense(int size);
  void analyse(const SparseSymmetric& matrix);
  void build_tree();
  void tell_small(int threads);
  void place_entries(const SparseSymmetric& matrix);
  void place_updates();
};

} // namespace dielast::fem
