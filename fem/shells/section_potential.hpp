// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/lanes.hpp"

namespace dielast::fem {

/// Strains of a shell at a point, w.r.t. its unstretched film: the metric a of the drawn surface, or of the
/// layers' face beside it (FaceStrain), and the change of curvature b_ij = sym(x,i . d,j) less that of the
/// drawing, 1/m; components 11, 22, 12. The layers keep their volume, so that what was at Z is at
/// Z/sqrt(det a) along the director:
///   C(Z) = a + 2 Z b / sqrt(det a),
/// terms of (Z b)^2 left out.
struct ShellStrain {
  materials::InPlaneC<Lanes> a, b;

  Lanes thinning() const { return 1.0 / materials::sqrt(a.det()); }
  materials::InPlaneC<Lanes> at(const Lanes& thinning, double Z) const {
    const Lanes z = 2.0 * Z * thinning;
    return {a.C11 + z * b.C11, a.C22 + z * b.C22, a.C12 + z * b.C12};
  }
};

/// The potential of a shell per area as a function of (a, b), from those of the points across its thickness:
/// first and second derivatives in a and b, components as in materials::MembranePotential, mixed ones a by b.
class SectionPotential {
 public:
  explicit SectionPotential(const ShellStrain& strain) : strain_(strain) {}

  /// Adds a point at Z that stands for `weight` (m of the thickness).
  void add(double Z, const Lanes& weight, const materials::MembranePotential<Lanes>& psi) {
    const Lanes once = weight * Z, twice = once * Z;
    value_ += weight * psi.value;
    for (std::size_t i = 0; i < 3; ++i) {
      N_[i] += weight * psi.first[i];
      M_[i] += once * psi.first[i];
    }
    for (std::size_t p = 0; p < 6; ++p) {
      D0_[p] += weight * psi.second[p];
      D1_[p] += once * psi.second[p];
      D2_[p] += twice * psi.second[p];
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
    const auto& [a, b] = strain_;
    const Lanes s = strain_.thinning(), per_det = 1.0 / a.det();
    const Lanes f1[3] = {a.C22, a.C11, -2.0 * a.C12}, kappa[3] = {b.C11, b.C22, b.C12};
    Lanes s1[3]; // d s/d a
    for (int i = 0; i < 3; ++i) s1[i] = -0.5 * s * per_det * f1[i];
    const Lanes bent = M_[0] * kappa[0] + M_[1] * kappa[1] + M_[2] * kappa[2];
    Derivatives d = squares_;
    for (int i = 0; i < 3; ++i) {
      d.a[i] = N_[i] + 2.0 * bent * s1[i];
      d.b[i] = 2.0 * s * M_[i];
    }
    if constexpr (with_second) {
      constexpr int place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
      Lanes D1b[3], D2b[3];
      for (int i = 0; i < 3; ++i) {
        D1b[i] = D2b[i] = Lanes{};
        for (int j = 0; j < 3; ++j) {
          D1b[i] += D1_[place[i][j]] * kappa[j];
          D2b[i] += D2_[place[i][j]] * kappa[j];
        }
      }
      const Lanes bDb = D2b[0] * kappa[0] + D2b[1] * kappa[1] + D2b[2] * kappa[2];
      constexpr double f2[3][3] = {{0, 1, 0}, {1, 0, 0}, {0, 0, -2}};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const Lanes s2 = 3.0 * s1[i] * s1[j] / s - 0.5 * s * per_det * f2[i][j];
          d.aa[i][j] += D0_[place[i][j]] + 2.0 * (D1b[i] * s1[j] + s1[i] * D1b[j]) +
                        4.0 * bDb * s1[i] * s1[j] + 2.0 * bent * s2;
          d.ab[i][j] += 2.0 * s1[i] * M_[j] + 2.0 * s * (D1_[place[i][j]] + 2.0 * s1[i] * D2b[j]);
          d.bb[i][j] += 4.0 * s * s * D2_[place[i][j]];
        }
    }
    return d;
  }

 private:
  ShellStrain strain_;
  Lanes value_{}, N_[3] = {}, M_[3] = {};
  Lanes D0_[6] = {}, D1_[6] = {}, D2_[6] = {};
  Derivatives squares_{};
};

} // namespace dielast::fem
