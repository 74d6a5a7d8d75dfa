// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/supernodes.hpp"

#include <Eigen/Core>

#include <vector>

namespace dielast::fem {

/// L L^T of positive definite matrices of one pattern in the precision of Real, by the multifrontal method
/// (Liu 1992). One thread does it: Debian's serial OpenBLAS gives wrong results where several call it at
/// once. Its memory is kept.
template<class Real>
class MultifrontalCholesky {
 public:
  /// `supernodes` must outlive this.
  explicit MultifrontalCholesky(const Supernodes& supernodes);

  /// `entries`: those of the matrix that the supernodes were made for. False: not positive definite in this
  /// precision, and no solve is possible.
  [[nodiscard]] bool factor(const std::vector<double>& entries);

  struct Pivot {
    double relative = 1; ///< over the diagonal entry that it came from: no units
    int equation = -1;
  };
  /// Round-off when the matrix is singular. `matrix`: which was factored, with these `entries`.
  Pivot smallest_pivot(const SparseSymmetric& matrix, const std::vector<double>& entries) const;
  /// x = A^-1 b, with the rounding of this precision.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

 private:
  /// A supernode's panel of L and what it changes in its parent's rows, by columns.
  struct Front {
    int width, height, below;
    Real *panel, *update;
  };
  Front front(int s);
  void gather(const std::vector<double>& entries, int s);
  void pass_on(int s);

  const Supernodes& nodes_;
  std::vector<Real> values_;  ///< of L, panel by panel
  std::vector<Real> updates_; ///< what supernodes give to their parents
  std::vector<Real> x_, of_rows_;
};

extern template class MultifrontalCholesky<double>;
extern template class MultifrontalCholesky<float>;

} // namespace dielast::fem
