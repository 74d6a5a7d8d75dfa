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
  using Vector6 = Eigen::Vector<double, 6>;
  using Vector11 = Eigen::Vector<double, 11>;
  static constexpr int slope = 0, quaternion = 3, quaternion_slope = 7; ///< places of x', q, q' in y

  explicit BeamKinematics(const Vector11& y);

  /// The blocks of strain()'s derivative in y that are not zero: of R^T x' in x' and q, of axial(R^T R') in q
  /// and q'.
  struct Gradient {
    Eigen::Matrix3d stretch_slope; ///< R^T
    Eigen::Matrix<double, 3, 4> stretch_quaternion, turn_quaternion, turn_quaternion_slope;
  };
  /// The blocks of a second derivative in y that are not zero; that in q' and q is a transpose.
  struct Hessian {
    Eigen::Matrix<double, 3, 4> slope_quaternion;
    Eigen::Matrix4d quaternion, quaternion_quaternion_slope;
  };

  /// (R^T x', axial(R^T R')).
  const Vector6& strain() const { return strain_; }
  Gradient gradient() const;
  /// Derivative of stress . strain() in y, the stress being fixed.
  Vector11 power_gradient(const Vector6& stress) const;
  /// Second derivative of the same.
  Hessian power_hessian(const Vector6& stress) const;

  double N =
      0; ///< squared length of q; small when neighbouring nodes are turned against each other by a full turn

 private:
  Vector11 numerator_gradient(const Vector6& stress) const; // of (n.A + m.B)

  Eigen::Vector3d v_, u_, du_; // x', vector parts of q and q'
  double w_ = 0, dw_ = 0;      // their scalar parts
  Vector6 strain_;
};

} // namespace dielast::fem
