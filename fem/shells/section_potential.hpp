// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/lanes.hpp"

namespace dielast::fem {

/// Strains of a shell at a point, w.r.t. its unstretched film: the metric a of the surface that lies as far
/// from the drawn one as the middle of the layers does as drawn, along directors that keep their length, and
/// the change of curvature b_ij = sym(x,i . d,j) less that of the drawing, 1/m; components 11, 22, 12. The
/// layers keep their volume, so that what was at Z is at a height z along the director with dz/dZ =
/// 1/sqrt(det C), C = a + 2 z b + z^2 b a^-1 b. With l = 1/sqrt(det a), H = tr(a^-1 b)/2, K = det b/det a
/// and, as b a^-1 b = 2 H b - K a,
///   z(Z) = l Z - H (l Z)^2,   C(Z) = a + 2 l Z b - (l Z)^2 K a,
/// terms of (Z b)^3 left out: in the same shell drawn at another height bending is as stiff.
struct ShellStrain {
  materials::InPlaneC<Lanes> a, b;

  Lanes thinning() const { return 1.0 / materials::sqrt(a.det()); }
  /// K, 1/m^2.
  Lanes gaussian_curvature() const { return b.det() / a.det(); }
  /// H, 1/m.
  Lanes mean_curvature() const {
    return (a.C22 * b.C11 + a.C11 * b.C22 - 2.0 * a.C12 * b.C12) / (2.0 * a.det());
  }
  /// C with K at l Z.
  materials::InPlaneC<Lanes> at(const Lanes& height, const Lanes& K) const {
    const Lanes once = 1.0 - height * height * K, twice = 2.0 * height;
    return {once * a.C11 + twice * b.C11, once * a.C22 + twice * b.C22, once * a.C12 + twice * b.C12};
  }
};

/// The potential of a shell per area as a function of (a, b), from those of the points across its thickness:
/// first and second derivatives in a and b, components as in materials::MembranePotential, mixed ones a by b.
class SectionPotential {
 public:
  explicit SectionPotential(const ShellStrain& strain) : strain_(strain) {}

  /// Adds a point at Z that stands for `weight` (m of the thickness).
  void add(double Z, const Lanes& weight, const materials::MembranePotential<Lanes>& psi) {
    value_ += weight * psi.value;
    Lanes moment = weight;
    for (std::size_t k = 0; k < 5; ++k, moment *= Z) {
      for (std::size_t i = 0; k < 3 && i < 3; ++i) N_[k][i] += moment * psi.first[i];
      for (std::size_t p = 0; p < 6; ++p) D_[k][p] += moment * psi.second[p];
    }
  }

  const Lanes& value() const { return value_; }

  struct Derivatives {
    Lanes a[3], b[3];
    Lanes aa[3][3], ab[3][3], bb[3][3];
  };
  /// Adds factor g g^T to the second derivatives, g the first ones of another potential.
  void add_square(const Lanes& factor, const Derivatives& g) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        squares_.aa[i][j] += factor * g.a[i] * g.a[j];
        squares_.ab[i][j] += factor * g.a[i] * g.b[j];
        squares_.bb[i][j] += factor * g.b[i] * g.b[j];
      }
  }
  template<bool with_second>
  Derivatives derivatives() const {
    // By a, by B = 2 s b and by q = s^2 K of C(Z) = a + Z B - Z^2 q a, s = l, and these by a and b.
    const auto& [a, b] = strain_;
    const Lanes s = strain_.thinning(), per_det = 1.0 / a.det(), q = strain_.gaussian_curvature() * per_det;
    const Lanes f1[3] = {a.C22, a.C11, -2.0 * a.C12}, e1[3] = {b.C22, b.C11, -2.0 * b.C12}; // of det a, det b
    const Lanes metric[3] = {a.C11, a.C22, a.C12}, kappa[3] = {b.C11, b.C22, b.C12};
    const Lanes(&M)[3] = N_[1];
    Lanes s1[3], qa[3], qb[3];
    for (int i = 0; i < 3; ++i) {
      s1[i] = -0.5 * s * per_det * f1[i];
      qa[i] = -2.0 * q * per_det * f1[i];
      qb[i] = per_det * per_det * e1[i];
    }
    const Lanes bent = M[0] * kappa[0] + M[1] * kappa[1] + M[2] * kappa[2];
    const Lanes by_q = -(N_[2][0] * metric[0] + N_[2][1] * metric[1] + N_[2][2] * metric[2]);
    Derivatives d = squares_;
    for (int i = 0; i < 3; ++i) {
      d.a[i] = N_[0][i] - q * N_[2][i] + 2.0 * bent * s1[i] + by_q * qa[i];
      d.b[i] = 2.0 * s * M[i] + by_q * qb[i];
    }
    if constexpr (with_second) {
      constexpr int place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
      Lanes aa[3][3], aB[3][3], aBb[3], BBb[3], qB[3], qga[3], qgb[3];
      for (int i = 0; i < 3; ++i) {
        aBb[i] = BBb[i] = qB[i] = Lanes{};
        qga[i] = -N_[2][i];
        for (int j = 0; j < 3; ++j) {
          const int p = place[i][j];
          aa[i][j] = D_[0][p] - q * (2.0 * D_[2][p] - q * D_[4][p]);
          aB[i][j] = D_[1][p] - q * D_[3][p];
          aBb[i] += aB[i][j] * kappa[j];
          BBb[i] += D_[2][p] * kappa[j];
          qga[i] -= (D_[2][p] - q * D_[4][p]) * metric[j];
          qB[i] -= D_[3][p] * metric[j];
        }
      }
      Lanes bBBb{}, qBb{}, qq{};
      for (int i = 0; i < 3; ++i) {
        bBBb += BBb[i] * kappa[i];
        qBb += qB[i] * kappa[i];
        for (int j = 0; j < 3; ++j) qq += metric[i] * D_[4][place[i][j]] * metric[j];
      }
      for (int i = 0; i < 3; ++i) {
        qga[i] += 2.0 * qBb * s1[i] + 0.5 * qq * qa[i]; // half of the square on either side of a sum
        qgb[i] = 2.0 * s * qB[i] + 0.5 * qq * qb[i];
      }
      constexpr double f2[3][3] = {{0, 1, 0}, {1, 0, 0}, {0, 0, -2}};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const Lanes s2 = 3.0 * s1[i] * s1[j] / s - 0.5 * s * per_det * f2[i][j];
          const Lanes qaa = 2.0 * q * per_det * (3.0 * per_det * f1[i] * f1[j] - f2[i][j]),
                      qab = -2.0 * per_det * f1[i] * qb[j], qbb = per_det * per_det * f2[i][j];
          d.aa[i][j] += aa[i][j] + 2.0 * (aBb[i] * s1[j] + s1[i] * aBb[j]) + 4.0 * bBBb * s1[i] * s1[j] +
                        2.0 * bent * s2 + qga[i] * qa[j] + qa[i] * qga[j] + by_q * qaa;
          d.ab[i][j] += 2.0 * s1[i] * M[j] + 2.0 * s * (aB[i][j] + 2.0 * s1[i] * BBb[j]) + qga[i] * qb[j] +
                        qa[i] * qgb[j] + by_q * qab;
          d.bb[i][j] += 4.0 * s * s * D_[2][place[i][j]] + qgb[i] * qb[j] + qb[i] * qgb[j] + by_q * qbb;
        }
    }
    return d;
  }

 private:
  ShellStrain strain_;
  Lanes value_{};
  Lanes N_[3][3] = {}, D_[5][6] = {}; ///< first and second derivatives in C times powers of Z
  Derivatives squares_{};
};

} // namespace dielast::fem
