// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace dielast::cases {

/// What a least-squares solution with residuals r (n) and Jacobian J (n x k) says of its k coordinates when
/// the errors are independent, of one variance:
///   s^2 = r.r/(n - k),  Cov = s^2 (J^T J)^-1,  interval +- t(97.5 %, n - k) sqrt(Cov_ii)
/// (Seber & Wild 1989, ch. 5). A coordinate that lies in a direction along which r does not change has an
/// infinite half width and no correlation (NaN).
struct FitStatistics {
  double deviation = 0;        ///< s
  Eigen::VectorXd half_widths; ///< of the 95 % intervals
  Eigen::MatrixXd correlation;
};

/// n > k. Columns of zero (coordinates that are held) count as not identifiable but not in k. `model_error`:
/// of each residual, that of how it is computed: intervals are no narrower than with s = model_error.
FitStatistics fit_statistics(const Eigen::MatrixXd& J, const Eigen::VectorXd& r, double model_error = 0);

} // namespace dielast::cases
