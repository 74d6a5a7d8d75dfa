// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/beam_kinematics.hpp"

namespace dielast::fem {

namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  return (Eigen::Matrix3d() << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0).finished();
}

} // namespace

BeamKinematics::BeamKinematics(const Vector11& y)
    : N(y.segment<4>(quaternion).squaredNorm()), v_(y.segment<3>(slope)), u_(y.segment<3>(quaternion + 1)),
      du_(y.segment<3>(quaternion_slope + 1)), w_(y[quaternion]), dw_(y[quaternion_slope]) {}

Eigen::Vector<double, 6> BeamKinematics::strain() const {
  Eigen::Vector<double, 6> numerator;
  numerator.head<3>() = (w_ * w_ - u_.squaredNorm()) * v_ + 2 * u_.dot(v_) * u_ - 2 * w_ * u_.cross(v_);
  numerator.tail<3>() = 2 * (w_ * du_ - dw_ * u_ - u_.cross(du_));
  return numerator / N;
}

Eigen::Matrix<double, 6, 11> BeamKinematics::numerator_gradient() const {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d u_cross = cross_matrix(u_);
  Eigen::Matrix<double, 6, 11> g = Eigen::Matrix<double, 6, 11>::Zero();
  g.block<3, 3>(0, slope) = (w_ * w_ - u_.squaredNorm()) * one + 2 * u_ * u_.transpose() - 2 * w_ * u_cross;
  g.block<3, 1>(0, quaternion) = 2 * w_ * v_ - 2 * u_.cross(v_);
  g.block<3, 3>(0, quaternion + 1) =
      -2 * v_ * u_.transpose() + 2 * u_.dot(v_) * one + 2 * u_ * v_.transpose() + 2 * w_ * cross_matrix(v_);
  g.block<3, 1>(3, quaternion) = 2 * du_;
  g.block<3, 3>(3, quaternion + 1) = -2 * dw_ * one + 2 * cross_matrix(du_);
  g.block<3, 1>(3, quaternion_slope) = -2 * u_;
  g.block<3, 3>(3, quaternion_slope + 1) = 2 * w_ * one - 2 * u_cross;
  return g;
}

Eigen::Matrix<double, 6, 11> BeamKinematics::gradient() const {
  Eigen::Matrix<double, 6, 11> g = numerator_gradient() / N;
  const Eigen::Vector4d dN = 2 * (Eigen::Vector4d() << w_, u_).finished();
  g.block<6, 4>(0, quaternion) -= strain() * dN.transpose() / N;
  return g;
}

BeamKinematics::Matrix11 BeamKinematics::hessian(const Eigen::Vector<double, 6>& stress) const {
  const Eigen::Vector3d n = stress.head<3>(), m = stress.tail<3>();
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  Matrix11 h = Matrix11::Zero(); // lower blocks of n.A + m.B first, mirrored below
  h(quaternion, quaternion) = 2 * n.dot(v_);
  h.block<3, 1>(quaternion + 1, quaternion) = -2 * v_.cross(n);
  h.block<3, 3>(quaternion + 1, quaternion + 1) =
      -2 * n.dot(v_) * one + 2 * (n * v_.transpose() + v_ * n.transpose());
  h.block<1, 3>(quaternion, slope) = (2 * w_ * n - 2 * n.cross(u_)).transpose();
  h.block<3, 3>(quaternion + 1, slope) =
      (-2 * n * u_.transpose() + 2 * n.dot(u_) * one + 2 * u_ * n.transpose() - 2 * w_ * cross_matrix(n))
          .transpose();
  h.block<3, 1>(quaternion_slope + 1, quaternion) = 2 * m;
  h.block<1, 3>(quaternion_slope, quaternion + 1) = -2 * m.transpose();
  h.block<3, 3>(quaternion_slope + 1, quaternion + 1) = -2 * cross_matrix(m); // transpose of 2 [m]x
  h.triangularView<Eigen::StrictlyUpper>() = h.transpose().triangularView<Eigen::StrictlyUpper>();

  // Quotient rule for (n.A + m.B)/N; N depends on q only.
  const Vector11 phi_1 = numerator_gradient().transpose() * stress;
  const double phi = N * stress.dot(strain());
  Vector11 dN = Vector11::Zero();
  dN.segment<4>(quaternion) << 2 * w_, 2 * u_;
  h /= N;
  h -= (phi_1 * dN.transpose() + dN * phi_1.transpose()) / (N * N);
  h += 2 * phi / (N * N * N) * dN * dN.transpose();
  h.block<4, 4>(quaternion, quaternion) -= 2 * phi / (N * N) * Eigen::Matrix4d::Identity();
  return h;
}

} // namespace dielast::fem
