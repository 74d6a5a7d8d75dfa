// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/fit_statistics.hpp"

#include "fem/algebra/dense_algebra.hpp"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::cases {

FitStatistics fit_statistics(const Eigen::MatrixXd& J, const Eigen::VectorXd& r, double model_error) {
  constexpr double singular = 1e-7; // of unit columns; differences are good to 1e-9
  constexpr double takes_part = 1e-3;
  const Eigen::Index k = J.cols();
  Eigen::VectorXd size = J.colwise().norm();
  const auto active = (size.array() > 0).count();
  for (double& one : size)
    if (one == 0) one = 1;
  const fem::SingularValues svd = fem::singular_values(J * size.cwiseInverse().asDiagonal());

  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(k, k);
  Eigen::Array<bool, Eigen::Dynamic, 1> known = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(k, true);
  for (Eigen::Index i = 0; i < k; ++i) {
    const Eigen::VectorXd v = svd.V.col(i);
    const double s = svd.values[i];
    if (s > singular * svd.values[0])
      inverse += v * v.transpose() / (s * s);
    else
      known = known && v.array().abs() < takes_part;
  }

  const double freedom = static_cast<double>(r.size() - active);
  const double t = boost::math::quantile(boost::math::students_t(freedom), 0.975);
  FitStatistics result{std::sqrt(r.squaredNorm() / freedom), Eigen::VectorXd(k), Eigen::MatrixXd(k, k)};
  const double error = std::max(result.deviation, model_error);
  for (Eigen::Index i = 0; i < k; ++i) {
    result.half_widths[i] =
        known[i] ? t * error * std::sqrt(inverse(i, i)) / size[i] : std::numeric_limits<double>::infinity();
    for (Eigen::Index j = 0; j < k; ++j)
      result.correlation(i, j) = known[i] && known[j]
                                     ? inverse(i, j) / std::sqrt(inverse(i, i) * inverse(j, j))
                                     : std::numeric_limits<double>::quiet_NaN();
  }
  return result;
}

} // namespace dielast::cases
