// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/lanes.hpp"

#include <cmath>

namespace dielast::fem {

/// Whether every gradient of a displacement costs energy at an integration point, in every lane that has a
/// volume: with the stress S and D = d2Psi/dC2 (both weighted by the volume, D as in
/// materials::MembranePotential) the quadratic form
///   S_ij H_i . H_j + B(H)^T D B(H),  B(H) = (2 F_1 . H_1, 2 F_2 . H_2, F_1 . H_2 + F_2 . H_1)
/// is positive definite, H_i = du/dX_i, F_i the columns of the deformation gradient. So is then the tangent
/// of a film that is held somewhere: a sufficient condition for its stability, not a necessary one. As the
/// form knows F by C alone, it is taken in the frame in which F is triangular; across the film it is S.
/// `out_of_plane`: the film may move there.
inline bool costs_energy(const materials::InPlaneC<Lanes>& C, const Lanes& volume, const Lanes& S11,
                         const Lanes& S22, const Lanes& S12, const Lanes (&D)[6], bool out_of_plane) {
  constexpr double negligible = 1e-6; // pivot over the trace of the form
  Lanes a, c;
  for (int l = 0; l < lanes; ++l) a[l] = std::sqrt(C.C11[l]);
  const Lanes b = C.C12 / a;
  for (int l = 0; l < lanes; ++l) c[l] = std::sqrt(C.C22[l] - b[l] * b[l]);
  // H = (H_1x, H_1y, H_2x, H_2y), F_1 = (a, 0), F_2 = (b, c)
  const Lanes zero{};
  const Lanes B[4][3]{{2.0 * a, zero, b}, {zero, zero, c}, {zero, 2.0 * b, a}, {zero, 2.0 * c, zero}};
  Lanes form[4][4]; // lower triangle
  for (int i = 0; i < 4; ++i) {
    const Lanes DB[3]{D[0] * B[i][0] + D[3] * B[i][1] + D[4] * B[i][2],
                      D[3] * B[i][0] + D[1] * B[i][1] + D[5] * B[i][2],
                      D[4] * B[i][0] + D[5] * B[i][1] + D[2] * B[i][2]};
    for (int j = 0; j <= i; ++j) form[i][j] = DB[0] * B[j][0] + DB[1] * B[j][1] + DB[2] * B[j][2];
  }
  for (int x = 0; x < 2; ++x) {
    form[x][x] += S11;
    form[x + 2][x + 2] += S22;
    form[x + 2][x] += S12;
  }
  const Lanes least = negligible * (form[0][0] + form[1][1] + form[2][2] + form[3][3]);
  const auto exceeds_least = [&](const Lanes& pivot) {
    for (int l = 0; l < lanes; ++l)
      if (volume[l] != 0 && !(least[l] > 0 && pivot[l] > least[l])) return false;
    return true;
  };
  for (int k = 0; k < 4; ++k) {
    if (!exceeds_least(form[k][k])) return false;
    for (int i = k + 1; i < 4; ++i)
      for (int j = k + 1; j <= i; ++j) form[i][j] -= form[i][k] * form[j][k] / form[k][k];
  }
  return !out_of_plane || (exceeds_least(S11) && exceeds_least(S22 - S12 * S12 / S11));
}

} // namespace dielast::fem
