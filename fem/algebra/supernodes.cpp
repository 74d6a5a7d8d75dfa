// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/supernodes.hpp"

#include "fem/algebra/cholmod_session.hpp"
#include "fem/algebra/nested_dissection.hpp"
#include "fem/machine/one_thread.hpp"

#include <algorithm>
#include <new>
#include <numeric>

namespace dielast::fem {

namespace {

/// Up to this many unknowns one panel holds the whole matrix.
constexpr int dense_up_to = 64;

/// Into how many parts for each of them, at least, several threads divide the work.
constexpr int parts_of_thread = 16;

/// Above this many unknowns nested dissection repays its slower analysis.
constexpr int nested_dissection_from = 12000;

} // namespace

Supernodes::Supernodes(const SparseSymmetric& matrix, int threads) {
  if (matrix.size <= dense_up_to)
    make_dense(matrix.size);
  else
    analyse(matrix);
  build_tree();
  tell_small(threads);
  place_entries(matrix);
  place_updates();
}

void Supernodes::make_dense(int size) {
  permutation.resize(at(size));
  std::iota(permutation.begin(), permutation.end(), 0);
  rows = permutation;
  first_column = row_start = {0, size};
}

/// Panels by CHOLMOD (Chen, Davis, Hager & Rajamanickam 2008), for smaller matrices the order, too.
void Supernodes::analyse(const SparseSymmetric& matrix) {
  const OneThread one_thread;
  CholmodSession session;
  session.common.supernodal = CHOLMOD_SUPERNODAL;
  session.common.nmethods = 1;
  session.common.postorder = 1;
  std::vector<int> order;
  if (matrix.size >= nested_dissection_from) order = nested_dissection(matrix);
  session.common.method[0].ordering = order.empty() ? CHOLMOD_AMD : CHOLMOD_GIVEN;
  cholmod_sparse pattern = cholmod_pattern(matrix.column_start, matrix.rows);
  cholmod_factor* L =
      cholmod_analyze_p(&pattern, order.empty() ? nullptr : order.data(), nullptr, 0, &session.common);
  if (!L) throw std::bad_alloc();
  const auto copy = [](const void* from, std::size_t size) {
    const auto* numbers = static_cast<const int*>(from);
    return std::vector<int>(numbers, numbers + size);
  };
  permutation = copy(L->Perm, L->n);
  first_column = copy(L->super, L->nsuper + 1);
  row_start = copy(L->pi, L->nsuper + 1);
  rows = copy(L->s, L->ssize);
  cholmod_free_factor(&L, &session.common);
}

void Supernodes::build_tree() {
  const int supernodes = static_cast<int>(first_column.size()) - 1;
  std::vector<int> of_column(permutation.size());
  parent.assign(at(supernodes), -1);
  start.assign(1, 0);
  for (int s = 0; s < supernodes; ++s) {
    std::fill(of_column.begin() + first_column[at(s)], of_column.begin() + first_column[at(s) + 1], s);
    start.push_back(start.back() + static_cast<std::ptrdiff_t>(width(s)) * height(s));
  }
  child_start.assign(at(supernodes) + 1, 0);
  for (int s = 0; s < supernodes; ++s)
    if (below(s) > 0) {
      parent[at(s)] = of_column[at(rows_of(s)[width(s)])];
      ++child_start[at(parent[at(s)]) + 1];
    }
  std::partial_sum(child_start.begin(), child_start.end(), child_start.begin());
  child.resize(at(child_start.back()));
  std::vector<int> next(child_start.begin(), child_start.end() - 1);
  for (int s = 0; s < supernodes; ++s)
    if (parent[at(s)] >= 0) child[at(next[at(parent[at(s)])]++)] = s;

  places.assign(rows.size(), 0);
  std::vector<int> place(permutation.size());
  for (int s = 0; s < supernodes; ++s) {
    for (int k = 0; k < height(s); ++k) place[at(rows_of(s)[k])] = k;
    for (int c = child_start[at(s)]; c < child_start[at(s) + 1]; ++c)
      for (int k = row_start[at(child[at(c)])]; k < row_start[at(child[at(c)]) + 1]; ++k)
        places[at(k)] = place[at(rows[at(k)])];
  }
  together.assign(rows.size(), 1);
  for (int s = 0; s < supernodes; ++s)
    for (int k = row_start[at(s) + 1] - 2; k >= row_start[at(s)]; --k)
      if (places[at(k) + 1] == places[at(k)] + 1) together[at(k)] += together[at(k) + 1];
}

void Supernodes::place_entries(const SparseSymmetric& matrix) {
  std::vector<int> column_of(permutation.size()), of_column(permutation.size()), place(permutation.size());
  for (std::size_t k = 0; k < permutation.size(); ++k) column_of[at(permutation[k])] = static_cast<int>(k);
  for (int s = 0; s < count(); ++s)
    std::fill(of_column.begin() + first_column[at(s)], of_column.begin() + first_column[at(s) + 1], s);
  const auto for_each_entry = [&](const auto& visit) {
    matrix.for_each_entry([&](std::size_t k, int one, int other) {
      const auto [column, row] = std::minmax(column_of[at(one)], column_of[at(other)]);
      visit(static_cast<int>(k), column, row);
    });
  };
  std::vector<std::ptrdiff_t> entry_start(at(count()) + 1, 0); // of each supernode
  diagonal.resize(permutation.size());
  for_each_entry([&](int k, int column, int row) {
    ++entry_start[at(of_column[at(column)]) + 1];
    if (row == column) diagonal[at(column)] = k;
  });
  std::partial_sum(entry_start.begin(), entry_start.end(), entry_start.begin());
  struct Entry {
    int entry, column, row;
  };
  std::vector<Entry> entries(matrix.rows.size());
  std::vector<std::ptrdiff_t> next(entry_start.begin(), entry_start.end() - 1);
  for_each_entry([&](int k, int column, int row) {
    entries[static_cast<std::size_t>(next[at(of_column[at(column)])]++)] = {k, column, row};
  });
  run_start.assign(1, 0);
  for (int s = 0; s < count(); ++s) {
    for (int k = 0; k < height(s); ++k) place[at(rows_of(s)[k])] = k;
    for (auto e = entry_start[at(s)]; e < entry_start[at(s) + 1]; ++e) {
      const auto [entry, column, row] = entries[static_cast<std::size_t>(e)];
      const int here = (column - first_column[at(s)]) * height(s) + place[at(row)];
      if (e > entry_start[at(s)]) {
        Run& last = runs.back();
        const int stride = here - (last.place + (last.count - 1) * last.stride);
        const bool goes_on = last.count == 1 ? stride == 1 || stride == height(s) : stride == last.stride;
        if (goes_on && entry == last.entry + last.count) {
          last.stride = stride;
          ++last.count;
          continue;
        }
      }
      runs.push_back({entry, here, 1, 1});
    }
    run_start.push_back(std::ssize(runs));
  }
}

void Supernodes::tell_small(int threads) {
  std::vector<double> work(at(count()));
  double all = 0;
  first_below.resize(at(count()));
  for (int s = 0; s < count(); ++s) {
    first_below[at(s)] =
        child_start[at(s)] < child_start[at(s) + 1] ? first_below[at(child[at(child_start[at(s)])])] : s;
    const double whole = height(s), rest = below(s), own = whole * whole * whole - rest * rest * rest;
    all += own;
    work[at(s)] += own;
    if (parent[at(s)] >= 0)
      work[at(parent[at(s)])] += work[at(s)];
    else
      roots.push_back(s);
  }
  const int parts = threads > 1 ? parts_of_thread * threads : 1;
  for (const double w : work) small.push_back(parts * w <= all);
}

/// Where a supernode is small, what it gives lies behind what its parent and the children before it give, and
/// before all that stands above its own children: as long as it is needed, nothing else is written there.
/// Others have places of their own, with all that stands below them.
void Supernodes::place_updates() {
  const auto size = [this](int s) { return static_cast<std::ptrdiff_t>(below(s)) * below(s); };
  std::vector<std::ptrdiff_t> extent(at(count())); // what all below a supernode and itself need
  for (int s = 0; s < count(); ++s) {
    std::ptrdiff_t behind = 0, most = 0;
    for (int c = child_start[at(s)]; c < child_start[at(s) + 1]; ++c) {
      most = std::max(most, behind + extent[at(child[at(c)])]);
      behind += small[at(s)] ? size(child[at(c)]) : extent[at(child[at(c)])];
    }
    extent[at(s)] = size(s) + most;
  }
  update_start.assign(at(count()), 0);
  for (const int root : roots) {
    update_start[at(root)] = update_size;
    update_size += extent[at(root)];
  }
  for (int s = count() - 1; s >= 0; --s) {
    std::ptrdiff_t next = update_start[at(s)] + size(s);
    for (int c = child_start[at(s)]; c < child_start[at(s) + 1]; ++c) {
      update_start[at(child[at(c)])] = next;
      next += small[at(s)] ? size(child[at(c)]) : extent[at(child[at(c)])];
    }
  }
}

} // namespace dielast::fem
