// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/supernodes.hpp"
#include "fem/machine/large_vector.hpp"
#include "fem/machine/workers.hpp"

#include <Eigen/Core>

#include <vector>

namespace dielast::fem {

/// L L^T of positive definite matrices of one pattern in the precision of Real, by the multifrontal method
/// (Liu 1992). Branches of the tree of supernodes and parts of large fronts are computed at once, with the
/// same bits for any number of threads. Its memory is kept.
template<class Real>
class MultifrontalCholesky {
 public:
  /// Both must outlive this. Throws std::runtime_error where there is less memory than it takes.
  MultifrontalCholesky(const Supernodes& supernodes, Workers& workers);

  /// `entries`: those of the matrix that the supernodes were made for; `lessened`: part of its diagonal that
  /// is taken off. False: not positive definite in this precision, and no solve is possible. `b`: half of the
  /// solve for it is done on the way, while the panels are at hand; finish() does the other.
  [[nodiscard]] bool factor(const std::vector<double>& entries, double lessened = 0,
                            const Eigen::VectorXd* b = nullptr);

  struct Pivot {
    double relative = 1; ///< over the diagonal entry that it came from: no units
    int equation = -1;
  };
  /// Of the last factor; round-off when the matrix is singular.
  Pivot smallest_pivot() const;
  /// x = A^-1 b, with the rounding of this precision.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);
  /// The same for the b of the last factor(), before any solve().
  void finish(Eigen::VectorXd& x);

 private:
  /// A supernode's panel of L and what it changes in its parent's rows, by columns.
  struct Front {
    int width, height, below;
    Real *panel, *update;
  };
  Front front(int s);
  template<class Function>
  void climb(int s, const Function& f);
  template<class Function>
  void descend(int s, const Function& f);
  void take(const Eigen::VectorXd& b);
  bool factor_front(const std::vector<double>& entries, double lessened, int s, Workers& workers);
  void gather(const std::vector<double>& entries, double lessened, int s);
  void pass_on(int s);
  Pivot smallest_pivot(const std::vector<double>& entries, int s);
  void forward(int s);
  void backward(int s);

  const Supernodes& nodes_;
  Workers& workers_;
  Workers one_thread_{1};
  LargeVector<Real> values_;    ///< of L, panel by panel
  LargeVector<Real> updates_;   ///< what supernodes give to their parents
  std::vector<Pivot> smallest_; ///< of each supernode
  std::vector<Real> x_;
  std::vector<Real> of_rows_; ///< beside the rows of the supernodes: their part of a solution
};

extern template class MultifrontalCholesky<double>;
extern template class MultifrontalCholesky<float>;

} // namespace dielast::fem
