// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/multifrontal_cholesky.hpp"

#include "fem/algebra/dense_products.hpp"
#include "fem/algebra/panel.hpp"
#include "fem/machine/memory.hpp"

#include <algorithm>
#include <atomic>
#include <string>

namespace dielast::fem {

namespace {

/// Numbers that a thread moves at once, not less.
constexpr int permuted_together = 20000;

/// How many runs of entries of the matrix ahead the memory is asked for one.
constexpr std::size_t asked_before = 16;

constexpr std::size_t at(std::ptrdiff_t i) { return static_cast<std::size_t>(i); }

} // namespace

template<class Real>
MultifrontalCholesky<Real>::MultifrontalCholesky(const Supernodes& supernodes, Workers& workers)
    : nodes_(supernodes), workers_(workers), smallest_(at(supernodes.count())),
      x_(supernodes.permutation.size()), of_rows_(supernodes.rows.size()) {
  const auto numbers = static_cast<double>(supernodes.start.back() + supernodes.update_size);
  require_memory(numbers * sizeof(Real),
                 "the factor of a tangent of " + std::to_string(x_.size()) + " unknowns");
  values_.resize(at(supernodes.start.back()));
  updates_.resize(at(supernodes.update_size));
}

/// f(supernode, workers) for all below s and itself, children before their parent.
template<class Real>
template<class Function>
void MultifrontalCholesky<Real>::climb(int s, const Function& f) {
  if (nodes_.small[at(s)] || workers_.count() == 1) {
    for (int below = nodes_.first_below[at(s)]; below <= s; ++below) f(below, one_thread_);
    return;
  }
  const int first = nodes_.child_start[at(s)];
  workers_.run(at(nodes_.child_start[at(s) + 1] - first),
               [&](std::size_t c) { climb(nodes_.child[at(first) + c], f); });
  f(s, workers_);
}

/// f(supernode) for all below s and itself, parents before their children.
template<class Real>
template<class Function>
void MultifrontalCholesky<Real>::descend(int s, const Function& f) {
  if (nodes_.small[at(s)] || workers_.count() == 1) {
    for (int below = s; below >= nodes_.first_below[at(s)]; --below) f(below);
    return;
  }
  f(s);
  const int first = nodes_.child_start[at(s)];
  workers_.run(at(nodes_.child_start[at(s) + 1] - first),
               [&](std::size_t c) { descend(nodes_.child[at(first) + c], f); });
}

template<class Real>
typename MultifrontalCholesky<Real>::Front MultifrontalCholesky<Real>::front(int s) {
  return {nodes_.width(s), nodes_.height(s), nodes_.below(s), values_.data() + nodes_.start[at(s)],
          updates_.data() + nodes_.update_start[at(s)]};
}

/// to(i, j) += from(i, j) for i = 0..size-1 and j = 0..columns-1, with the distances of columns; goes on to
/// the rows behind these.
template<int size, class Real>
void add_rows(int columns, const Real*& from, int stride, Real*& to, int stride_to) {
  using Rows = Eigen::Array<Real, size, 1>;
  for (std::ptrdiff_t j = 0; j < columns; ++j)
    Eigen::Map<Rows>(to + j * stride_to) += Eigen::Map<const Rows>(from + j * stride);
  from += size;
  to += size;
}

/// That of all rows.
template<class Real>
void add_block(int rows, int columns, const Real* from, int stride, Real* to, int stride_to) {
  for (int k = 0; k < rows / 8; ++k) add_rows<8>(columns, from, stride, to, stride_to);
  if (rows & 4) add_rows<4>(columns, from, stride, to, stride_to);
  if (rows & 2) add_rows<2>(columns, from, stride, to, stride_to);
  if (rows & 1) add_rows<1>(columns, from, stride, to, stride_to);
}

/// to(place[i], place[j]) += from(i, j) for j = first..last-1 and i = j..size-1, by columns. Of the places
/// together[i] follow one another, so that these are blocks; those on the diagonal are added as a whole, as
/// what lies above it may become anything.
template<class Real>
void add(int first, int last, int size, const int* place, const int* together, const Real* from, Real* to,
         int stride_to) {
  for (int j = first, columns; j < last; j += columns) {
    columns = std::min(together[j], last - j);
    const Real* const of_columns = from + static_cast<std::ptrdiff_t>(j) * size;
    Real* const to_columns = to + static_cast<std::ptrdiff_t>(place[j]) * stride_to;
    for (int i = j; i < size; i += together[i])
      add_block(together[i], columns, of_columns + i, size, to_columns + place[i], stride_to);
  }
}

/// How many of a child's columns, whose places are given, are some of a panel's.
int columns_within(int width, const int* place, int count) {
  return static_cast<int>(std::lower_bound(place, place + count, width) - place);
}

/// The panel of the matrix, and what the children change in it.
template<class Real>
void MultifrontalCholesky<Real>::gather(const std::vector<double>& entries, double lessened, int s) {
  const Front own = front(s);
  std::fill(own.panel, own.panel + static_cast<std::ptrdiff_t>(own.width) * own.height, Real(0));
  for (auto r = at(nodes_.run_start[at(s)]); r < at(nodes_.run_start[at(s) + 1]); ++r) {
    if (r + asked_before < nodes_.runs.size())
      __builtin_prefetch(entries.data() + nodes_.runs[r + asked_before].entry); // they lie here and there
    const auto [entry, place, stride, count] = nodes_.runs[r];
    const double* const from = entries.data() + entry;
    Real* const to = own.panel + place;
    if (stride == 1)
      for (int i = 0; i < count; ++i) to[i] = static_cast<Real>(from[i]);
    else
      for (int i = 0; i < count; ++i)
        to[static_cast<std::ptrdiff_t>(i) * stride] = static_cast<Real>(from[i]);
  }
  if (lessened != 0)
    for (int k = 0; k < own.width; ++k)
      own.panel[static_cast<std::ptrdiff_t>(k) * own.height + k] *= static_cast<Real>(1 - lessened);
  for (int c = nodes_.child_start[at(s)]; c < nodes_.child_start[at(s) + 1]; ++c) {
    const Front child = front(nodes_.child[at(c)]);
    const int* const place = nodes_.place_in_parent(nodes_.child[at(c)]);
    const int* const together = nodes_.together_in_parent(nodes_.child[at(c)]);
    add(0, columns_within(own.width, place, child.below), child.below, place, together, child.update,
        own.panel, own.height);
  }
}

/// What the children change behind the panel.
template<class Real>
void MultifrontalCholesky<Real>::pass_on(int s) {
  const Front own = front(s);
  for (int c = nodes_.child_start[at(s)]; c < nodes_.child_start[at(s) + 1]; ++c) {
    const Front child = front(nodes_.child[at(c)]);
    const int* const place = nodes_.place_in_parent(nodes_.child[at(c)]);
    const int* const together = nodes_.together_in_parent(nodes_.child[at(c)]);
    const std::ptrdiff_t before = own.width * (own.below + std::ptrdiff_t(1)); // the panel's rows and columns
    add(columns_within(own.width, place, child.below), child.below, child.below, place, together,
        child.update, own.update - before, own.below);
  }
}

template<class Real>
bool MultifrontalCholesky<Real>::factor_front(const std::vector<double>& entries, double lessened, int s,
                                              Workers& workers) {
  gather(entries, lessened, s);
  const auto [width, height, below, panel, update] = front(s);
  if (!factor_panel(width, height, panel, workers)) return false;
  smallest_[at(s)] = smallest_pivot(entries, s);
  if (below == 0) return true;
  minus_square(below, width, panel + width, height, update, below, workers);
  pass_on(s);
  return true;
}

template<class Real>
bool MultifrontalCholesky<Real>::factor(const std::vector<double>& entries, double lessened,
                                        const Eigen::VectorXd* b) {
  if (b) take(*b);
  std::atomic<bool> definite = true;
  workers_.run(nodes_.roots.size(), [&](std::size_t root) {
    climb(nodes_.roots[root], [&](int s, Workers& workers) {
      if (definite && !factor_front(entries, lessened, s, workers)) definite = false;
      if (b && definite) forward(s);
    });
  });
  return definite;
}

template<class Real>
typename MultifrontalCholesky<Real>::Pivot
MultifrontalCholesky<Real>::smallest_pivot(const std::vector<double>& entries, int s) {
  const Front own = front(s);
  Pivot smallest;
  for (int k = 0; k < own.width; ++k) {
    const double root = own.panel[static_cast<std::ptrdiff_t>(k) * own.height + k];
    const auto column = at(nodes_.first_column[at(s)] + k);
    const double relative = root * root / entries[at(nodes_.diagonal[column])];
    if (relative < smallest.relative) smallest = {relative, nodes_.permutation[column]};
  }
  return smallest;
}

template<class Real>
typename MultifrontalCholesky<Real>::Pivot MultifrontalCholesky<Real>::smallest_pivot() const {
  return *std::ranges::min_element(smallest_, {}, &Pivot::relative);
}

/// Solves for the unknowns of a supernode, and keeps what that changes in the rows below it.
template<class Real>
void MultifrontalCholesky<Real>::forward(int s) {
  const auto [width, height, below, panel, update] = front(s);
  Real* const own = of_rows_.data() + nodes_.row_start[at(s)];
  std::copy_n(x_.data() + nodes_.first_column[at(s)], width, own);
  std::fill_n(own + width, below, Real(0));
  for (int c = nodes_.child_start[at(s)]; c < nodes_.child_start[at(s) + 1]; ++c) {
    const int child = nodes_.child[at(c)], rows = nodes_.below(child);
    const int* const place = nodes_.place_in_parent(child);
    const Real* const change = of_rows_.data() + nodes_.row_start[at(child)] + nodes_.width(child);
    for (int i = 0; i < rows; ++i) own[place[i]] += change[i];
  }
  Panel<Real>(panel, width, height).forward(typename Panel<Real>::Vector(own, height));
}

template<class Real>
void MultifrontalCholesky<Real>::backward(int s) {
  const auto [width, height, below, panel, update] = front(s);
  Real* const own = of_rows_.data() + nodes_.row_start[at(s)];
  const int* const row = nodes_.rows_of(s);
  for (int i = width; i < height; ++i) own[i] = x_[at(row[i])];
  Panel<Real>(panel, width, height).backward(typename Panel<Real>::Vector(own, height));
  std::copy_n(own, width, x_.data() + nodes_.first_column[at(s)]);
}

template<class Real>
void MultifrontalCholesky<Real>::take(const Eigen::VectorXd& b) {
  workers_.run_blocks(static_cast<int>(x_.size()), permuted_together, [&](int first, int last) {
    for (int k = first; k < last; ++k) x_[at(k)] = static_cast<Real>(b[nodes_.permutation[at(k)]]);
  });
}

template<class Real>
void MultifrontalCholesky<Real>::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  take(b);
  workers_.run(nodes_.roots.size(),
               [&](std::size_t root) { climb(nodes_.roots[root], [this](int s, Workers&) { forward(s); }); });
  finish(x);
}

template<class Real>
void MultifrontalCholesky<Real>::finish(Eigen::VectorXd& x) {
  const auto size = static_cast<int>(x_.size());
  workers_.run(nodes_.roots.size(),
               [&](std::size_t root) { descend(nodes_.roots[root], [this](int s) { backward(s); }); });
  x.resize(size);
  workers_.run_blocks(size, permuted_together, [&](int first, int last) {
    for (int k = first; k < last; ++k) x[nodes_.permutation[at(k)]] = x_[at(k)];
  });
}

template class MultifrontalCholesky<double>;
template class MultifrontalCholesky<float>;

} // namespace dielast::fem
