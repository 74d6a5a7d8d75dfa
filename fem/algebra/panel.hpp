// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace dielast::fem {

/// The panel of a supernode: columns of L, those of the diagonal block first. Solves with it read every entry
/// once, a few columns together; panels of a few columns are too small for BLAS.
template<class Real>
class Panel {
 public:
  using Vector = Eigen::Map<Eigen::Matrix<Real, Eigen::Dynamic, 1>>;

  Panel(const Real* values, int width, int height) : values_(values, height, width) {}

  /// x <- L^-1 x in the rows of the diagonal block, and what that changes in the rows below.
  void forward(Vector x) const {
    Eigen::Index j = 0;
    for (; j + together <= values_.cols(); j += together) forward<together>(j, x);
    for (; j < values_.cols(); ++j) forward<1>(j, x);
  }
  /// x <- L^-T x in the rows of the diagonal block.
  void backward(Vector x) const {
    Eigen::Index j = values_.cols();
    for (; j % together != 0; --j) backward<1>(j - 1, x);
    for (; j > 0; j -= together) backward<together>(j - together, x);
  }

 private:
  static constexpr int together = 4; ///< columns
  /// Rows at once. Sums depend on them, and must not on where the panel lies in memory, as Eigen's own would.
  static constexpr int chunk = 16;
  using Chunk = Eigen::Array<Real, chunk, 1>;
  /// Numbers that the memory is asked for ahead on the way back, where it does not see what comes: panels of
  /// supernodes lie one behind the other.
  static constexpr Eigen::Index asked_before = 16384 / sizeof(Real);

  template<int columns>
  void forward(Eigen::Index j, Vector& x) const {
    Eigen::Matrix<Real, columns, 1> own = x.template segment<columns>(j);
    values_.template block<columns, columns>(j, j).template triangularView<Eigen::Lower>().solveInPlace(own);
    x.template segment<columns>(j) = own;
    Eigen::Index i = j + columns;
    for (; i + chunk <= values_.rows(); i += chunk) {
      Chunk rows = x.template segment<chunk>(i);
      for (int c = 0; c < columns; ++c)
        rows -= own[c] * values_.col(j + c).template segment<chunk>(i).array();
      x.template segment<chunk>(i) = rows;
    }
    for (; i < values_.rows(); ++i)
      for (int c = 0; c < columns; ++c) x[i] -= own[c] * values_(i, j + c);
  }
  template<int columns>
  void backward(Eigen::Index j, Vector& x) const {
    Chunk sums[columns];
    for (Chunk& sum : sums) sum.setZero();
    Eigen::Index i = j + columns;
    for (; i + chunk <= values_.rows(); i += chunk) {
      const Chunk rows = x.template segment<chunk>(i);
      for (int c = 0; c < columns; ++c) {
        __builtin_prefetch(values_.data() + (j + c) * values_.rows() + i - asked_before);
        sums[c] += rows * values_.col(j + c).template segment<chunk>(i).array();
      }
    }
    Eigen::Matrix<Real, columns, 1> own;
    for (int c = 0; c < columns; ++c) {
      Real sum = sums[c].sum();
      for (Eigen::Index k = i; k < values_.rows(); ++k) sum += x[k] * values_(k, j + c);
      own[c] = x[j + c] - sum;
    }
    const auto diagonal = values_.template block<columns, columns>(j, j);
    diagonal.transpose().template triangularView<Eigen::Upper>().solveInPlace(own);
    x.template segment<columns>(j) = own;
  }

  Eigen::Map<const Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>> values_;
};

} // namespace dielast::fem
