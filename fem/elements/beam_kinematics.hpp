// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dielast::fem {

/// Strain measures of a geometrically exact beam at one point, as functions of y = (x', q, q'): the slope of
/// the centreline and an unnormalised quaternion field q = (w, u) with its slope,
///   R^T x' = A/N,  A = (w^2 - u.u) x' + 2 u (u.x') - 2 w u x x',
///   axial(R^T R') = B/N,  B = 2 (w u' - w' u - u x u'),  N = q.q
/// for R = R(q/|q|).
struct BeamKinematics {
  using Vector11 = Eigen::Vector<double, 11>;
  using Matrix11 = Eigen::Matrix<double, 11, 11>;
  static constexpr int slope = 0, quaternion = 3, quaternion_slope = 7; ///< places of x', q, q' in y

  explicit BeamKinematics(const Vector11& y);

  /// (R^T x', axial(R^T R')).
  Eigen::Vector<double, 6> strain() const;
  /// Derivative of strain() in y.
  Eigen::Matrix<double, 6, 11> gradient() const;
  /// Second derivative of stress . strain() in y, the stress being fixed.
  Matrix11 hessian(const Eigen::Vector<double, 6>& stress) const;

  double N =
      0; ///< squared length of q; small when neighbouring nodes are turned against each other by a full turn

 private:
  Eigen::Matrix<double, 6, 11> numerator_gradient() const;

  Eigen::Vector3d v_, u_, du_; // x', vector parts of q and q'
  double w_ = 0, dw_ = 0;      // their scalar parts
};

} // namespace dielast::fem
