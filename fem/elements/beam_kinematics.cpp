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
      du_(y.segment<3>(quaternion_slope + 1)), w_(y[quaternion]), dw_(y[quaternion_slope]) {
  const Eigen::Vector3d uxv = u_.cross(v_), uxdu = u_.cross(du_);
  const double f = 1 / N, diagonal = f * (w_ * w_ - u_.squaredNorm()), along = 2 * f * u_.dot(v_);
  strain_.head<3>() = diagonal * v_ + along * u_ - (2 * f * w_) * uxv;
  strain_.tail<3>() = (2 * f * w_) * du_ - (2 * f * dw_) * u_ - (2 * f) * uxdu;
}

BeamKinematics::Gradient BeamKinematics::gradient() const {
  const Eigen::Matrix3d u_cross = cross_matrix(u_), v_cross = cross_matrix(v_);
  const Eigen::Vector3d uxv = u_.cross(v_);
  const double f = 1 / N, g = 2 / N, uv = u_.dot(v_), diagonal = w_ * w_ - u_.squaredNorm();
  const Eigen::Vector4d dN(g * w_, g * u_.x(), g * u_.y(), g * u_.z()); // over N
  Gradient d;
  for (int i = 0; i < 3; ++i) {
    d.stretch_quaternion(i, 0) = g * (w_ * v_[i] - uxv[i]) - strain_[i] * dN[0];
    d.turn_quaternion(i, 0) = g * du_[i] - strain_[3 + i] * dN[0];
    d.turn_quaternion_slope(i, 0) = -g * u_[i];
  }
  const Eigen::Matrix3d du_cross = cross_matrix(du_);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double one = i == j ? 1 : 0;
      d.stretch_slope(i, j) = f * (diagonal * one + 2 * (u_[i] * u_[j] - w_ * u_cross(i, j)));
      d.stretch_quaternion(i, j + 1) =
          g * (u_[i] * v_[j] - v_[i] * u_[j] + uv * one + w_ * v_cross(i, j)) - strain_[i] * dN[j + 1];
      d.turn_quaternion(i, j + 1) = g * (du_cross(i, j) - dw_ * one) - strain_[3 + i] * dN[j + 1];
      d.turn_quaternion_slope(i, j + 1) = g * (w_ * one - u_cross(i, j));
    }
  return d;
}

BeamKinematics::Vector11 BeamKinematics::numerator_gradient(const Vector6& stress) const {
  const Eigen::Vector3d n = stress.head<3>(), m = stress.tail<3>();
  const double nv = n.dot(v_), un = u_.dot(n), uv = u_.dot(v_);
  const Eigen::Vector3d vxn = v_.cross(n);
  Vector11 d;
  d.segment<3>(slope) = (w_ * w_ - u_.squaredNorm()) * n + 2 * un * u_ - 2 * w_ * n.cross(u_);
  d[quaternion] = 2 * (w_ * nv - u_.dot(vxn) + m.dot(du_));
  d.segment<3>(quaternion + 1) = 2 * (uv * n + un * v_ - nv * u_ - w_ * vxn - dw_ * m - du_.cross(m));
  d[quaternion_slope] = -2 * m.dot(u_);
  d.segment<3>(quaternion_slope + 1) = 2 * (w_ * m - m.cross(u_));
  return d;
}

BeamKinematics::Vector11 BeamKinematics::power_gradient(const Vector6& stress) const {
  Vector11 d = numerator_gradient(stress) / N;
  const double change = 2 * stress.dot(strain_) / N;
  d[quaternion] -= change * w_;
  d.segment<3>(quaternion + 1) -= change * u_;
  return d;
}

BeamKinematics::Hessian BeamKinematics::power_hessian(const Vector6& stress) const {
  const Eigen::Vector3d n = stress.head<3>(), m = stress.tail<3>();
  const Eigen::Matrix3d n_cross = cross_matrix(n), m_cross = cross_matrix(m);
  const Eigen::Vector3d nxu = n.cross(u_), vxn = v_.cross(n);
  const double nv = n.dot(v_), un = u_.dot(n);
  Hessian h; // of n.A + m.B first
  h.slope_quaternion.col(0) = 2 * (w_ * n - nxu);
  h.quaternion(0, 0) = 2 * nv;
  h.quaternion_quaternion_slope(0, 0) = 0;
  for (int i = 0; i < 3; ++i) {
    h.quaternion(0, i + 1) = h.quaternion(i + 1, 0) = -2 * vxn[i];
    h.quaternion_quaternion_slope(0, i + 1) = 2 * m[i];
    h.quaternion_quaternion_slope(i + 1, 0) = -2 * m[i];
  }
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double one = i == j ? 1 : 0;
      h.slope_quaternion(i, j + 1) = 2 * (u_[i] * n[j] - n[i] * u_[j] + un * one - w_ * n_cross(i, j));
      h.quaternion(i + 1, j + 1) = 2 * (n[i] * v_[j] + v_[i] * n[j] - nv * one);
      h.quaternion_quaternion_slope(i + 1, j + 1) = 2 * m_cross(i, j);
    }
  // Quotient rule for (n.A + m.B)/N; N depends on q only.
  const Vector11 first = numerator_gradient(stress);
  const double f = 1 / N, power = stress.dot(strain_);
  const Eigen::Vector4d dN(2 * f * w_, 2 * f * u_.x(), 2 * f * u_.y(), 2 * f * u_.z()); // over N
  const Eigen::Vector4d first_q = f * first.segment<4>(quaternion),
                        first_dq = f * first.segment<4>(quaternion_slope);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i)
      h.slope_quaternion(i, j) = f * (h.slope_quaternion(i, j) - first[slope + i] * dN[j]);
    for (int i = 0; i < 4; ++i) {
      h.quaternion(i, j) = f * h.quaternion(i, j) - first_q[i] * dN[j] - dN[i] * first_q[j] +
                           2 * power * (dN[i] * dN[j] - (i == j ? f : 0));
      h.quaternion_quaternion_slope(i, j) = f * h.quaternion_quaternion_slope(i, j) - dN[i] * first_dq[j];
    }
  }
  return h;
}

} // namespace dielast::fem
