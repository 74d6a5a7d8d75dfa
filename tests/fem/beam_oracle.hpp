// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace dielast::fem::test {

/// Strain measures of a beam written down from their definition, without the algebra of fem::BeamKinematics:
/// rotation matrix of the normalised quaternion, its derivative by the product rule. T: a dual number.
template<class T>
struct BeamOracle {
  using Vector = std::array<T, 3>;
  using Quaternion = std::array<T, 4>; ///< scalar part first
  using Matrix = std::array<Vector, 3>;

  /// The polar form of q -> R(q) for unit q: R(q) = form(q, q).
  static Matrix form(const Quaternion& p, const Quaternion& q) {
    const auto [pw, px, py, pz] = p;
    const auto [qw, qx, qy, qz] = q;
    const T xy = px * qy + py * qx, xz = px * qz + pz * qx, yz = py * qz + pz * qy;
    const T wx = pw * qx + px * qw, wy = pw * qy + py * qw, wz = pw * qz + pz * qw;
    const T ww = pw * qw, xx = px * qx, yy = py * qy, zz = pz * qz;
    return {Vector{ww + xx - yy - zz, xy - wz, xz + wy}, Vector{xy + wz, ww - xx + yy - zz, yz - wx},
            Vector{xz - wy, yz + wx, ww - xx - yy + zz}};
  }

  /// (R^T x', axial(R^T R')) for R = R(q/|q|).
  static std::array<T, 6> strain(const Vector& slope, const Quaternion& q, const Quaternion& dq) {
    T square = 0, product = 0;
    for (int i = 0; i < 4; ++i) {
      square += q[i] * q[i];
      product += q[i] * dq[i];
    }
    const T norm = sqrt(square);
    Quaternion unit, dunit;
    for (int i = 0; i < 4; ++i) {
      unit[i] = q[i] / norm;
      dunit[i] = (dq[i] - unit[i] * product / norm) / norm;
    }
    const Matrix R = form(unit, unit), half = form(unit, dunit);
    const auto column_product = [](const Matrix& A, int i, const Matrix& B, int j) {
      return A[0][i] * B[0][j] + A[1][i] * B[1][j] + A[2][i] * B[2][j];
    };
    std::array<T, 6> strain;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      strain[i] = R[0][i] * slope[0] + R[1][i] * slope[1] + R[2][i] * slope[2];
      strain[3 + i] = column_product(R, k, half, j) - column_product(R, j, half, k); // R' = 2 half
    }
    return strain;
  }
};

} // namespace dielast::fem::test
