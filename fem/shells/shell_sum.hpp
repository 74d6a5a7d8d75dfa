// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/shells/shell_kinematics.hpp"

#include <algorithm>

namespace dielast::fem {

/// Residual and tangent of `lanes` shell elements, gathered point by point. Every strain is a form in
/// positions and directors: what the stresses do to their second variation is one number per pair of nodes,
///   E'' = sum_ab xx[a][b] dx_a . dx_b + 2 xd[a][b] dx_a . dd_b,
/// and the forces on x_a and d_a are those forms applied to x and d. Unknowns: x, y, z of a node and its
/// spins about the first two of its axes, node by node, then the spins about the third axes, which nodes that
/// tilt do not have; by a spin dd = axis x d.
template<bool with_tangent, int axes>
class ShellSum {
 public:
  static constexpr int nodes = ShellTables::nodes, dofs = (3 + axes) * nodes,
                       packed_size = dofs * (dofs + 1) / 2;
  /// Places of the unknowns of a node: displacement c = 0..2, spin about the axis k = 0..2.
  static constexpr int moved(int a, int c) { return 5 * a + c; }
  static constexpr int spun(int a, int k) { return k < 2 ? 5 * a + 3 + k : 5 * nodes + a; }

  explicit ShellSum(const ShellNodes& at) : at_(at) {
    for (int a = 0; a < nodes; ++a)
      for (int k = 0; k < axes; ++k) cross(at.axis[a][k], at.d[a], turns_[a][k]);
  }

  void add(const ShellTables::Point& table, const ShellDeformation& f, const ShellStress& stress) {
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t b = 0; b < nodes; ++b) {
        const auto &Ga = table.gradient[a], &Gb = table.gradient[b];
        Lanes bend{};
        bend += stress.b[0] * (Ga[0] * Gb[0]) + stress.b[1] * (Ga[1] * Gb[1]) +
                stress.b[2] * (0.5 * (Ga[0] * Gb[1] + Ga[1] * Gb[0]));
        xd_[a][b] += bend + stress.gamma[0] * table.shear[0][a][b] + stress.gamma[1] * table.shear[1][a][b];
        if (b <= a)
          xx_[a][b] += stress.a[0] * (2 * table.metric[0][a][b]) + stress.a[1] * (2 * table.metric[1][a][b]) +
                       stress.a[2] * (2 * table.metric[2][a][b]);
      }
    if constexpr (with_tangent) add_material(table, f, stress);
  }

  /// Where nodes have three spins: the rotations about the directors follow the film: 1/2 stiffness omega^2
  /// with omega, the sine of the angle between what the node and what the film (x,r and x,s at the node) have
  /// turned by.
  Lanes add_drilling(const Lanes& stiffness);

  /// After the last point: what acts on the unknowns.
  void finish();

  const Lanes& residual(int i) const { return residual_[i]; }
  const Lanes& tangent(int i) const { return tangent_[i]; } ///< lower triangle row by row

 private:
  /// What acts on the nodes that move, from what acts on those `lever` above them: dx_a + lever dd_a.
  void add_lever();
  static int place(int i, int j) { return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i; }
  void add_material(const ShellTables::Point& table, const ShellDeformation& f, const ShellStress& stress);
  /// The part of the tangent in dx_a . (dspin x p) times a number; of each axis of b, axis x p.
  void add_mixed(int a, int b, const Lanes (&turned)[axes][3], const Lanes& factor) {
    for (int k = 0; k < axes; ++k)
      for (int c = 0; c < 3; ++c) tangent_[place(moved(a, c), spun(b, k))] += factor * turned[k][c];
  }
  /// What the curvature of the rotation group adds where a turning vector p feels the force g: the second
  /// derivative of g . exp(spin) p.
  void add_turning(int a, const Lanes (&p)[3], const Lanes (&g)[3]) {
    const auto& axis = at_.axis[a];
    const Lanes both = dot(p, g);
    Lanes on_p[axes], on_g[axes];
    for (int k = 0; k < axes; ++k) {
      on_p[k] = dot(axis[k], p);
      on_g[k] = dot(axis[k], g);
    }
    for (int k = 0; k < axes; ++k)
      for (int l = 0; l <= k; ++l)
        tangent_[place(spun(a, k), spun(a, l))] +=
            0.5 * (on_p[k] * on_g[l] + on_g[k] * on_p[l]) - dot(axis[k], axis[l]) * both;
  }

  const ShellNodes& at_;
  Lanes turns_[nodes][axes][3];                         ///< dd by each spin: axis x d
  Lanes xx_[nodes][nodes] = {}, xd_[nodes][nodes] = {}; ///< of xx_ a >= b
  Lanes residual_[dofs] = {};
  Lanes tangent_[with_tangent ? packed_size : 1] = {};
};

/// B^T D B, where the rows of B are the strains' first variations.
template<bool with_tangent, int axes>
void ShellSum<with_tangent, axes>::add_material(const ShellTables::Point& table, const ShellDeformation& f,
                                                const ShellStress& stress) {
  Lanes Ba[5 * nodes][3], Bb[dofs][3], Bg[dofs][2]; // Ba: of displacements only
  for (int a = 0; a < nodes; ++a) {
    const auto n = static_cast<std::size_t>(a);
    const auto& G = table.gradient[n];
    Lanes of_d[2 + 3][3]; // variations in d_a: shear, curvature
    for (int c = 0; c < 3; ++c) {
      const int i = moved(a, c);
      for (std::size_t k = 0; k < 3; ++k) {
        Ba[i][k] = Lanes{};
        for (std::size_t b = 1; b < nodes; ++b) Ba[i][k] += 2 * table.metric[k][n][b] * at_.x[b][c];
      }
      for (std::size_t k = 0; k < 2; ++k) {
        Bg[i][k] = of_d[k][c] = Lanes{};
        for (std::size_t b = 0; b < nodes; ++b) {
          Bg[i][k] += table.shear[k][n][b] * at_.d[b][c];
          of_d[k][c] += table.shear[k][b][n] * at_.x[b][c];
        }
        Bb[i][k] = G[k] * f.d[k][c];
        of_d[2 + k][c] = G[k] * f.x[k][c];
      }
      Bb[i][2] = 0.5 * (G[0] * f.d[1][c] + G[1] * f.d[0][c]);
      of_d[4][c] = 0.5 * (G[0] * f.x[1][c] + G[1] * f.x[0][c]);
    }
    for (int k = 0; k < axes; ++k) {
      const int i = spun(a, k);
      for (int s = 0; s < 2; ++s) Bg[i][s] = dot(turns_[a][k], of_d[s]);
      for (int s = 0; s < 3; ++s) Bb[i][s] = dot(turns_[a][k], of_d[2 + s]);
    }
  }
  // Rows of one node's displacements, or of its spins, meet each column together: it is loaded once.
  const auto add_rows = [&]<int count, bool moves>(int first) {
    Lanes Da[count][3], Db[count][3], Dg[count][2];
    for (int r = 0; r < count; ++r) {
      const int i = first + r;
      for (int k = 0; k < 3; ++k) {
        Da[r][k] = stress.ab[k][0] * Bb[i][0] + stress.ab[k][1] * Bb[i][1] + stress.ab[k][2] * Bb[i][2];
        Db[r][k] = stress.bb[k][0] * Bb[i][0] + stress.bb[k][1] * Bb[i][1] + stress.bb[k][2] * Bb[i][2];
        if constexpr (moves) {
          Da[r][k] += stress.aa[k][0] * Ba[i][0] + stress.aa[k][1] * Ba[i][1] + stress.aa[k][2] * Ba[i][2];
          Db[r][k] += stress.ab[0][k] * Ba[i][0] + stress.ab[1][k] * Ba[i][1] + stress.ab[2][k] * Ba[i][2];
        }
      }
      Dg[r][0] = stress.shear[0] * Bg[i][0] + stress.shear[2] * Bg[i][1];
      Dg[r][1] = stress.shear[2] * Bg[i][0] + stress.shear[1] * Bg[i][1];
    }
    const auto add_column = [&](int j, bool column_moves, int from) {
      for (int r = from; r < count; ++r) {
        Lanes sum = Db[r][0] * Bb[j][0] + Db[r][1] * Bb[j][1] + Db[r][2] * Bb[j][2] + Dg[r][0] * Bg[j][0] +
                    Dg[r][1] * Bg[j][1];
        if (column_moves) sum += Da[r][0] * Ba[j][0] + Da[r][1] * Ba[j][1] + Da[r][2] * Ba[j][2];
        tangent_[place(first + r, j)] += sum;
      }
    };
    for (int b = 0; b < nodes && moved(b, 0) < first; ++b) {
      for (int j = moved(b, 0); j < moved(b, 3); ++j) add_column(j, true, 0);
      for (int j = moved(b, 3); j < std::min(moved(b, 5), first); ++j) add_column(j, false, 0);
    }
    if constexpr (axes == 3)
      for (int j = 5 * nodes; j < first; ++j) add_column(j, false, 0);
    for (int r = 0; r < count; ++r) add_column(first + r, moves, r);
  };
  for (int a = 0; a < nodes; ++a) {
    add_rows.template operator()<3, true>(moved(a, 0));
    add_rows.template operator()<2, false>(spun(a, 0));
    if constexpr (axes == 3) add_rows.template operator()<1, false>(spun(a, 2));
  }
}

template<bool with_tangent, int axes>
Lanes ShellSum<with_tangent, axes>::add_drilling(const Lanes& stiffness) {
  Lanes energy{};
  for (int n = 0; n < nodes; ++n) {
    const auto& G = shell_tables().node[static_cast<std::size_t>(n)];
    Lanes x[2][3] = {}, turned[3], other[3], spin[axes], row[nodes][3];
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t i = 0; i < 2; ++i)
        for (int c = 0; c < 3; ++c) x[i][c] += G[a][i] * at_.x[a][c];
    const auto &r = at_.along[0][n], &s = at_.along[1][n];
    const Lanes scale = at_.per_area[n];
    const Lanes omega = scale * (dot(r, x[1]) - dot(s, x[0])), force = stiffness * omega;
    energy += 0.5 * force * omega;
    cross(r, x[1], turned);
    cross(s, x[0], other);
    for (int c = 0; c < 3; ++c) turned[c] = scale * (turned[c] - other[c]);
    for (int k = 0; k < axes; ++k) {
      spin[k] = dot(at_.axis[n][k], turned);
      residual_[spun(n, k)] += force * spin[k];
    }
    for (int a = 0; a < nodes; ++a)
      for (int c = 0; c < 3; ++c) {
        const auto& Ga = G[static_cast<std::size_t>(a)];
        row[a][c] = scale * (Ga[1] * r[c] - Ga[0] * s[c]);
        residual_[moved(a, c)] += force * row[a][c];
      }
    if constexpr (with_tangent) {
      for (int a = 0; a < nodes; ++a)
        for (int c = 0; c < 3; ++c) {
          for (int b = 0; b <= a; ++b)
            for (int e = 0; e < 3 && moved(b, e) <= moved(a, c); ++e)
              tangent_[place(moved(a, c), moved(b, e))] += stiffness * row[a][c] * row[b][e];
          for (int k = 0; k < axes; ++k)
            tangent_[place(moved(a, c), spun(n, k))] += stiffness * row[a][c] * spin[k];
        }
      for (int k = 0; k < axes; ++k)
        for (int l = 0; l <= k; ++l) tangent_[place(spun(n, k), spun(n, l))] += stiffness * spin[k] * spin[l];
      Lanes on_r[3], on_s[3], r_turns[axes][3], s_turns[axes][3];
      for (int c = 0; c < 3; ++c) {
        on_r[c] = force * scale * x[1][c];
        on_s[c] = -force * scale * x[0][c];
      }
      for (int k = 0; k < axes; ++k) {
        cross(at_.axis[n][k], r, r_turns[k]);
        cross(at_.axis[n][k], s, s_turns[k]);
      }
      add_turning(n, r, on_r);
      add_turning(n, s, on_s);
      for (int a = 0; a < nodes; ++a) {
        const auto& Ga = G[static_cast<std::size_t>(a)];
        add_mixed(a, n, r_turns, force * scale * Ga[1]);
        add_mixed(a, n, s_turns, -force * scale * Ga[0]);
      }
    }
  }
  return energy;
}

template<bool with_tangent, int axes>
void ShellSum<with_tangent, axes>::finish() {
  for (int a = 0; a < nodes; ++a) {
    Lanes on_x[3] = {}, on_d[3] = {};
    for (int b = 0; b < nodes; ++b)
      for (int c = 0; c < 3; ++c) {
        on_x[c] += xx_[std::max(a, b)][std::min(a, b)] * at_.x[b][c] + xd_[a][b] * at_.d[b][c];
        on_d[c] += xd_[b][a] * at_.x[b][c];
      }
    for (int c = 0; c < 3; ++c) residual_[moved(a, c)] += on_x[c];
    for (int k = 0; k < axes; ++k) residual_[spun(a, k)] += dot(turns_[a][k], on_d);
    if constexpr (with_tangent) {
      for (int b = 0; b < nodes; ++b) {
        for (int c = 0; b <= a && c < 3; ++c) tangent_[place(moved(a, c), moved(b, c))] += xx_[a][b];
        add_mixed(a, b, turns_[b], xd_[a][b]);
      }
      add_turning(a, at_.d[a], on_d);
    }
  }
  if (at_.lever != 0) add_lever();
}

template<bool with_tangent, int axes>
void ShellSum<with_tangent, axes>::add_lever() {
  const auto for_each_spin = [](const auto& visit) {
    for (int a = 0; a < nodes; ++a)
      for (int k = 0; k < axes; ++k) visit(a, k);
  };
  const auto by_spin = [&](int a, int k, const auto& along) { // of what is along x, y, z of node a
    return at_.lever * (turns_[a][k][0] * along(0) + turns_[a][k][1] * along(1) + turns_[a][k][2] * along(2));
  };
  if constexpr (with_tangent) {
    Lanes added[nodes][axes][nodes][3]; // to the mixed terms of spins and displacements
    const auto tangent = [&](int i, int j) -> Lanes& { return tangent_[place(i, j)]; };
    for_each_spin([&](int a, int k) {
      for (int b = 0; b < nodes; ++b)
        for (int c = 0; c < 3; ++c)
          added[a][k][b][c] = by_spin(a, k, [&](int e) { return tangent(moved(a, e), moved(b, c)); });
    });
    for_each_spin([&](int a, int k) {
      for_each_spin([&](int b, int l) {
        if (spun(b, l) > spun(a, k)) return;
        tangent(spun(a, k), spun(b, l)) +=
            by_spin(a, k, [&](int c) { return tangent(moved(a, c), spun(b, l)) + added[b][l][a][c]; }) +
            by_spin(b, l, [&](int c) { return tangent(moved(b, c), spun(a, k)); });
      });
    });
    for_each_spin([&](int a, int k) {
      for (int b = 0; b < nodes; ++b)
        for (int c = 0; c < 3; ++c) tangent(moved(b, c), spun(a, k)) += added[a][k][b][c];
    });
    for (int a = 0; a < nodes; ++a) {
      Lanes force[3];
      for (int c = 0; c < 3; ++c) force[c] = at_.lever * residual_[moved(a, c)];
      add_turning(a, at_.d[a], force);
    }
  }
  for_each_spin([&](int a, int k) {
    residual_[spun(a, k)] += by_spin(a, k, [&](int c) { return residual_[moved(a, c)]; });
  });
}

} // namespace dielast::fem
