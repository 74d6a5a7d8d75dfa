// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/multifrontal_cholesky.hpp"

#include "fem/algebra/blas.hpp"
#include "fem/algebra/panel.hpp"

#include <algorithm>

namespace dielast::fem {

namespace {

constexpr std::size_t at(std::ptrdiff_t i) { return static_cast<std::size_t>(i); }

} // namespace

template<class Real>
MultifrontalCholesky<Real>::MultifrontalCholesky(const Supernodes& supernodes)
    : nodes_(supernodes), values_(at(supernodes.start.back())), updates_(at(supernodes.update_size)),
      x_(supernodes.permutation.size()), of_rows_(supernodes.permutation.size()) {}

template<class Real>
typename MultifrontalCholesky<Real>::Front MultifrontalCholesky<Real>::front(int s) {
  return {nodes_.width(s), nodes_.height(s), nodes_.below(s), values_.data() + nodes_.start[at(s)],
          updates_.data() + nodes_.update_start[at(s)]};
}

/// The panel of the matrix, and what the children change in it.
template<class Real>
void MultifrontalCholesky<Real>::gather(const std::vector<double>& entries, int s) {
  const Front own = front(s);
  std::fill(own.panel, own.panel + static_cast<std::ptrdiff_t>(own.width) * own.height, Real(0));
  for (auto e = at(nodes_.entry_start[at(s)]); e < at(nodes_.entry_start[at(s) + 1]); ++e)
    own.panel[nodes_.entry_place[e]] = static_cast<Real>(entries[at(nodes_.entry[e])]);
  for (int c = nodes_.child_start[at(s)]; c < nodes_.child_start[at(s) + 1]; ++c) {
    const Front child = front(nodes_.child[at(c)]);
    const int* const place = nodes_.place_in_parent(nodes_.child[at(c)]);
    for (int j = 0; j < child.below && place[j] < own.width; ++j) {
      Real* const to = own.panel + static_cast<std::ptrdiff_t>(place[j]) * own.height;
      const Real* const from = child.update + static_cast<std::ptrdiff_t>(j) * child.below;
      for (int i = j; i < child.below; ++i) to[place[i]] += from[i];
    }
  }
}

/// What the children change behind the panel.
template<class Real>
void MultifrontalCholesky<Real>::pass_on(int s) {
  const Front own = front(s);
  for (int c = nodes_.child_start[at(s)]; c < nodes_.child_start[at(s) + 1]; ++c) {
    const Front child = front(nodes_.child[at(c)]);
    const int* const place = nodes_.place_in_parent(nodes_.child[at(c)]);
    const auto behind = std::lower_bound(place, place + child.below, own.width) - place;
    for (auto j = static_cast<int>(behind); j < child.below; ++j) {
      Real* const to = own.update + static_cast<std::ptrdiff_t>(place[j] - own.width) * own.below;
      const Real* const from = child.update + static_cast<std::ptrdiff_t>(j) * child.below;
      for (int i = j; i < child.below; ++i) to[place[i] - own.width] += from[i];
    }
  }
}

template<class Real>
bool MultifrontalCholesky<Real>::factor(const std::vector<double>& entries) {
  for (int s = 0; s < nodes_.count(); ++s) {
    gather(entries, s);
    const auto [width, height, below, panel, update] = front(s);
    if (!blas::cholesky(width, panel, height)) return false;
    if (below == 0) continue;
    blas::divide_by_transposed(below, width, panel, height, panel + width);
    blas::minus_square(below, width, panel + width, height, update, below);
    pass_on(s);
  }
  return true;
}

template<class Real>
typename MultifrontalCholesky<Real>::Pivot
MultifrontalCholesky<Real>::smallest_pivot(const SparseSymmetric& matrix,
                                           const std::vector<double>& entries) const {
  Pivot smallest;
  for (int s = 0; s < nodes_.count(); ++s)
    for (int k = 0; k < nodes_.width(s); ++k) {
      const double root =
          values_[at(nodes_.start[at(s)] + static_cast<std::ptrdiff_t>(k) * nodes_.height(s) + k)];
      const int equation = nodes_.permutation[at(nodes_.first_column[at(s)] + k)];
      const double relative = root * root / entries[at(matrix.column_start[at(equation)])];
      if (relative < smallest.relative) smallest = {relative, equation};
    }
  return smallest;
}

template<class Real>
void MultifrontalCholesky<Real>::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  for (std::size_t k = 0; k < x_.size(); ++k) x_[k] = static_cast<Real>(b[nodes_.permutation[k]]);
  const auto gathered = [this](int s) {
    const int* const row = nodes_.rows_of(s);
    for (int i = 0; i < nodes_.height(s); ++i) of_rows_[at(i)] = x_[at(row[i])];
    return typename Panel<Real>::Vector(of_rows_.data(), nodes_.height(s));
  };
  const auto put_back = [this](int s, int rows) {
    const int* const row = nodes_.rows_of(s);
    for (int i = 0; i < rows; ++i) x_[at(row[i])] = of_rows_[at(i)];
  };
  for (int s = 0; s < nodes_.count(); ++s) {
    Panel<Real>(front(s).panel, nodes_.width(s), nodes_.height(s)).forward(gathered(s));
    put_back(s, nodes_.height(s));
  }
  for (int s = nodes_.count() - 1; s >= 0; --s) {
    Panel<Real>(front(s).panel, nodes_.width(s), nodes_.height(s)).backward(gathered(s));
    put_back(s, nodes_.width(s));
  }
  x.resize(static_cast<Eigen::Index>(x_.size()));
  for (std::size_t k = 0; k < x_.size(); ++k) x[nodes_.permutation[k]] = x_[k];
}

template class MultifrontalCholesky<double>;
template class MultifrontalCholesky<float>;

} // namespace dielast::fem
