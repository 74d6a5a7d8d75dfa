// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/shells/section_potential.hpp"
#include "fem/shells/shell_tables.hpp"

namespace dielast::fem {

/// One integration point of `lanes` shell elements.
struct ShellPoint {
  Lanes area;        ///< undeformed, m^2; 0 in lanes past the last element
  Lanes T[3][3];     ///< components of a metric in the unstretched film from those in r, s
  Lanes shear[2][3]; ///< parts, by x and by y, of the unstretched film's inverse metric: rr, ss, rs; 1/m^2
  Lanes a[3];        ///< what straightens the interpolated metric: 1 (of the drawing) - T . interpolated
  Lanes b[3];        ///< -T . curvature of the drawing
  Lanes gamma[2];    ///< transverse shear of the drawing, in r, s
};

/// Nodes of `lanes` shell elements as they are: positions of the surface whose strains they tell, at the
/// distance `lever` along the directors from what moves, directors, axes of their spins, and the
/// tangents of that surface as drawn, turned with the nodes.
struct ShellNodes {
  static constexpr int nodes = ShellTables::nodes;
  double lever = 0;                         ///< m
  Lanes x[nodes][3], d[nodes][3];           ///< x from node 0, whose place tells of no strain
  Lanes xx[nodes][nodes], xd[nodes][nodes]; ///< x_a . x_b as far as a >= b > 0, x_a . d_b for a > 0
  Lanes axis[nodes][3][3]; ///< x, y, z; of a node that tilts the two axes of its tilts (see DofMap), and 0
  bool tilt;               ///< all of them: the rest is left out
  Lanes along[2][nodes][3];
  Lanes per_area[nodes]; ///< 1/|along_r x along_s|; 0 of a node that tilts
};

/// Strains of a point in r, s and what they are made of.
struct ShellDeformation {
  Lanes x[2][3], d[2][3]; ///< x,r x,s; d,r d,s
  Lanes normal;           ///< (x,r x x,s) . d, with x and d of the point
  Lanes metric[3], curvature[3], gamma[2];
};

inline Lanes dot(const Lanes (&u)[3], const Lanes (&v)[3]) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

inline void cross(const Lanes (&u)[3], const Lanes (&v)[3], Lanes (&w)[3]) {
  w[0] = u[1] * v[2] - u[2] * v[1];
  w[1] = u[2] * v[0] - u[0] * v[2];
  w[2] = u[0] * v[1] - u[1] * v[0];
}

/// sum_ab form[a][b] x_a . x_b, of a symmetric form.
inline Lanes of_metric(const ShellTables::Form& form, const ShellNodes& nodes) {
  Lanes own{}, mixed{};
  for (std::size_t a = 1; a < 6; ++a) {
    own += form[a][a] * nodes.xx[a][a];
    for (std::size_t b = 1; b < a; ++b) mixed += form[a][b] * nodes.xx[a][b];
  }
  return own + 2.0 * mixed;
}

/// sum_ab form[a][b] x_a . d_b
inline Lanes of_shear(const ShellTables::Form& form, const ShellNodes& nodes) {
  Lanes sum{};
  for (std::size_t a = 1; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) sum += form[a][b] * nodes.xd[a][b];
  return sum;
}

inline void multiply_nodes(ShellNodes& nodes) {
  for (int a = 1; a < ShellNodes::nodes; ++a) {
    for (int b = 1; b <= a; ++b) nodes.xx[a][b] = dot(nodes.x[a], nodes.x[b]);
    for (int b = 0; b < ShellNodes::nodes; ++b) nodes.xd[a][b] = dot(nodes.x[a], nodes.d[b]);
  }
}

inline ShellDeformation deformation(const ShellTables::Point& table, const ShellNodes& nodes) {
  ShellDeformation f{};
  Lanes d[3] = {}, normal[3];
  for (std::size_t a = 0; a < 6; ++a)
    for (int c = 0; c < 3; ++c) {
      d[c] += table.shape[a] * nodes.d[a][c];
      for (std::size_t i = 0; i < 2; ++i) {
        f.x[i][c] += table.gradient[a][i] * nodes.x[a][c];
        f.d[i][c] += table.gradient[a][i] * nodes.d[a][c];
      }
    }
  cross(f.x[0], f.x[1], normal);
  f.normal = dot(normal, d);
  for (std::size_t i = 0; i < 3; ++i) f.metric[i] = of_metric(table.metric[i], nodes);
  for (std::size_t i = 0; i < 2; ++i) {
    f.curvature[i] = dot(f.x[i], f.d[i]);
    f.gamma[i] = of_shear(table.shear[i], nodes);
  }
  f.curvature[2] = 0.5 * (dot(f.x[0], f.d[1]) + dot(f.x[1], f.d[0]));
  return f;
}

inline void times(const Lanes (&T)[3][3], const Lanes (&v)[3], Lanes (&product)[3]) {
  for (int i = 0; i < 3; ++i) product[i] = T[i][0] * v[0] + T[i][1] * v[1] + T[i][2] * v[2];
}

inline ShellStrain strain(const ShellPoint& point, const ShellDeformation& f) {
  Lanes a[3], b[3];
  times(point.T, f.metric, a);
  times(point.T, f.curvature, b);
  for (int i = 0; i < 3; ++i) {
    a[i] += point.a[i];
    b[i] += point.b[i];
  }
  return {{a[0], a[1], a[2]}, {b[0], b[1], b[2]}};
}

/// Stresses and stiffnesses of a point, conjugate to the strains in r, s, times its area.
struct ShellStress {
  Lanes a[3], b[3], gamma[2];
  Lanes aa[3][3], ab[3][3], bb[3][3], shear[3];

  template<bool with_second>
  static ShellStress of(const ShellPoint& point, const SectionPotential::Derivatives& d) {
    ShellStress s{};
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        s.a[j] += point.area * point.T[i][j] * d.a[i];
        s.b[j] += point.area * point.T[i][j] * d.b[i];
      }
    if constexpr (with_second) {
      pull_back(point, d.aa, s.aa);
      pull_back(point, d.ab, s.ab);
      pull_back(point, d.bb, s.bb);
    }
    return s;
  }

 private:
  /// area T^T D T
  static void pull_back(const ShellPoint& point, const Lanes (&D)[3][3], Lanes (&pulled)[3][3]) {
    Lanes DT[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        DT[i][j] = Lanes{};
        for (int k = 0; k < 3; ++k) DT[i][j] += point.area * D[i][k] * point.T[k][j];
      }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) pulled[i][j] += point.T[k][i] * DT[k][j];
  }
};

} // namespace dielast::fem
