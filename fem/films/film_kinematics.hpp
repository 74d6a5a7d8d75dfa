// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/convexity.hpp"
#include "fem/films/lanes.hpp"
#include "fem/films/membrane_section.hpp"
#include "fem/films/meridian.hpp"
#include "fem/films/triangle.hpp"

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace dielast::fem {

/// One integration point of `lanes` film elements.
template<int Nodes>
struct FilmPoint {
  Lanes gradient[Nodes]
                [2]; ///< of the shape functions along the film's two directions, see the kinematics, 1/m
  Lanes volume;      ///< undeformed volume, m^3; 0 in lanes past the last element
};

/// The same as it is computed, for one element.
template<int Nodes, int Corners>
struct FilmPlace {
  Eigen::Matrix<double, Nodes, 1> shape;    ///< values of the shape functions
  Eigen::Matrix<double, Nodes, 2> gradient; ///< 1/m
  double area =
      0; ///< undeformed, of all layers side by side, m^2; not positive where the element is degenerate
  Eigen::Matrix<double, Corners, 1> corner_shape;    ///< of functions linear between the corners
  Eigen::Matrix<double, Corners, 2> corner_gradient; ///< 1/m
};

/// S = dPsi/dC and d2Psi/dC2 times the volume of a point, see materials::MembranePotential.
struct WeightedStress {
  Lanes S11, S22, S12;
  Lanes D[6];

  WeightedStress(const Lanes& volume, const materials::MembranePotential<Lanes>& potential)
      : S11(2.0 * volume * potential.first[0]), S22(2.0 * volume * potential.first[1]),
        S12(volume * potential.first[2]) {
    for (std::size_t p = 0; p < 6; ++p) D[p] = volume * potential.second[p];
  }
  /// row . d2Psi/dC2
  void times(const Lanes (&row)[3], Lanes (&product)[3]) const {
    product[0] = D[0] * row[0] + D[3] * row[1] + D[4] * row[2];
    product[1] = D[3] * row[0] + D[1] * row[1] + D[5] * row[2];
    product[2] = D[4] * row[0] + D[5] * row[1] + D[2] * row[2];
  }
};

/// Triangles in the plane (Dim = 2) or in space: F = sum_a x_a (x) grad N_a w.r.t. the unstretched film,
/// C = F^T F.
template<int Nodes, int Dim>
struct TriangleKinematics {
  static constexpr const char* element = "triangle";
  static constexpr bool free_across = false; ///< its second direction follows the first without stress
  static constexpr int nodes = Nodes, dim = Dim, corners = 3;
  static constexpr std::array<int, 3> components{0, 1, 2}; ///< of the displacement, per unknown of a node
  static constexpr int mass_points = Nodes == 6 ? 6 : 3;   ///< that integrate N_a N_b exactly
  using Point = FilmPoint<Nodes>;

  struct Deformation {
    Lanes F[2][Dim]; ///< by columns
    materials::InPlaneC<Lanes> C;
  };

  /// `X`: nodes as drawn, m.
  static std::vector<FilmPlace<Nodes, corners>> places(const Eigen::Matrix<double, 3, Nodes>& X,
                                                       const MembraneSection& section, int points) {
    std::vector<FilmPlace<Nodes, corners>> all;
    const Eigen::Vector2d prestretch(section.prestretch.data());
    for (const TrianglePoint& at : triangle_rule(points)) {
      const Eigen::Matrix<double, Nodes, 2> dN = shape_gradients<Nodes>(at.xi, at.eta);
      const Eigen::Matrix2d jacobian = X.template topRows<2>() * dN;
      const double det = jacobian.determinant();
      const Eigen::Matrix2d per_metre = jacobian.inverse() * prestretch.asDiagonal();
      all.push_back({shape_values<Nodes>(at.xi, at.eta), dN * per_metre,
                     section.layers * at.weight * det / prestretch.prod(), shape_values<3>(at.xi, at.eta),
                     shape_gradients<3>(at.xi, at.eta) * per_metre});
    }
    return all;
  }

  static Deformation deformation(const Lanes (&x)[Nodes][Dim], const Point& point) {
    Deformation d{};
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < 2; ++i)
        for (int c = 0; c < Dim; ++c) d.F[i][c] += x[a][c] * point.gradient[a][i];
    for (int c = 0; c < Dim; ++c) {
      d.C.C11 += d.F[0][c] * d.F[0][c];
      d.C.C22 += d.F[1][c] * d.F[1][c];
      d.C.C12 += d.F[0][c] * d.F[1][c];
    }
    return d;
  }

  /// Positive in films that can be: a planar one must not be turned over; in space its area must not vanish.
  static Lanes orientation(const Deformation& d) {
    if constexpr (Dim == 2)
      return d.F[0][0] * d.F[1][1] - d.F[0][1] * d.F[1][0];
    else
      return d.C.det();
  }

  /// See Evaluation::convex.
  static bool is_convex(const Point& point, const Deformation& d, const WeightedStress& stress) {
    return costs_energy(d.C, point.volume, stress.S11, stress.S22, stress.S12, stress.D, Dim == 3);
  }

  /// dC/du for component c of node a: of C11, C22, and C12 (as it stands in C, once).
  static void slope(const Point& point, const Deformation& d, int a, int c, Lanes (&row)[3]) {
    const auto& G = point.gradient[a];
    row[0] = 2.0 * d.F[0][c] * G[0];
    row[1] = 2.0 * d.F[1][c] * G[1];
    row[2] = d.F[0][c] * G[1] + d.F[1][c] * G[0];
  }

  /// residual_a += F S grad N_a;  tangent_ab += (grad N_a . S grad N_b) 1 + B_a^T (d2Psi/dC2) B_b, B = dC/du.
  template<bool with_tangent>
  static void accumulate(const Point& point, const Deformation& d, const WeightedStress& stress,
                         Lanes (&residual)[Nodes * Dim], Lanes* tangent) {
    Lanes SG[Nodes][2];
    for (int a = 0; a < Nodes; ++a) {
      const auto& G = point.gradient[a];
      SG[a][0] = stress.S11 * G[0] + stress.S12 * G[1];
      SG[a][1] = stress.S12 * G[0] + stress.S22 * G[1];
      for (int c = 0; c < Dim; ++c) residual[a * Dim + c] += d.F[0][c] * SG[a][0] + d.F[1][c] * SG[a][1];
    }
    if constexpr (with_tangent) {
      Lanes B[Nodes * Dim][3], DB[Nodes * Dim][3];
      for (int a = 0; a < Nodes; ++a)
        for (int c = 0; c < Dim; ++c) {
          slope(point, d, a, c, B[a * Dim + c]);
          stress.times(B[a * Dim + c], DB[a * Dim + c]);
        }
      for (int a = 0; a < Nodes; ++a)
        for (int b = 0; b <= a; ++b) {
          const Lanes geometric = point.gradient[a][0] * SG[b][0] + point.gradient[a][1] * SG[b][1];
          for (int c = 0; c < Dim; ++c)
            for (int e = 0; e < Dim; ++e) {
              const int i = a * Dim + c, j = b * Dim + e;
              if (j > i) continue;
              Lanes sum = DB[i][0] * B[j][0] + DB[i][1] * B[j][1] + DB[i][2] * B[j][2];
              if (c == e) sum += geometric;
              tangent[i * (i + 1) / 2 + j] += sum;
            }
        }
    }
  }

  /// F of one lane, by columns, in space.
  static Eigen::Matrix<double, 3, 2> gradient_of(const Deformation& d, int lane) {
    Eigen::Matrix<double, 3, 2> F = Eigen::Matrix<double, 3, 2>::Zero();
    for (int i = 0; i < 2; ++i)
      for (int c = 0; c < Dim; ++c) F(c, i) = d.F[i][c][lane];
    return F;
  }
};

/// A film of revolution about the z axis by its meridian (r, z), S along the unstretched meridian and R its
/// unstretched radius: C11 = lambda_1^2 = r'^2 + z'^2, C22 = lambda_2^2 = (r/R)^2, C12 = 0 (Green & Adkins
/// 1960, ch. IV). The gradients of a point are dN_a/dS and N_a/R; a volume is that of the full turn.
template<int Nodes>
struct MeridianKinematics {
  static constexpr const char* element = "meridian";
  static constexpr bool free_across = false;
  static constexpr int nodes = Nodes, dim = 2, corners = 2;
  static constexpr std::array<int, 2> components{0, 2};
  static constexpr int mass_points = 3;
  using Point = FilmPoint<Nodes>;

  struct Deformation {
    Lanes along[2]; ///< (r', z')
    Lanes hoop;     ///< r/R
    materials::InPlaneC<Lanes> C;
  };

  static std::vector<FilmPlace<Nodes, corners>> places(const Eigen::Matrix<double, 3, Nodes>& X,
                                                       const MembraneSection& section, int points) {
    std::vector<FilmPlace<Nodes, corners>> all;
    for (const MeridianPoint& at : meridian_rule(points)) {
      FilmPlace<Nodes, corners> place{meridian_shape<Nodes>(at.xi), {}, 0, meridian_shape<2>(at.xi), {}};
      const Eigen::Matrix<double, Nodes, 1> slope = meridian_slope<Nodes>(at.xi);
      const Eigen::Vector3d tangent = X * slope, chord = X.col(1) - X.col(0);
      const double length = std::copysign(tangent.norm(), tangent.dot(chord)) / section.prestretch[0];
      const double radius = X.row(0).dot(place.shape) / section.prestretch[1];
      place.gradient.col(0) = slope / length;
      place.gradient.col(1) = place.shape / radius;
      place.area = section.layers * at.weight * length * 2 * std::numbers::pi * radius;
      place.corner_gradient << meridian_slope<2>(at.xi) / length, Eigen::Vector2d::Zero(); // none around
      all.push_back(place);
    }
    return all;
  }

  static Deformation deformation(const Lanes (&x)[Nodes][2], const Point& point) {
    Deformation d{};
    for (int a = 0; a < Nodes; ++a) {
      for (int c = 0; c < 2; ++c) d.along[c] += x[a][c] * point.gradient[a][0];
      d.hoop += x[a][0] * point.gradient[a][1];
    }
    d.C.C11 = d.along[0] * d.along[0] + d.along[1] * d.along[1];
    d.C.C22 = d.hoop * d.hoop;
    return d;
  }

  static Lanes orientation(const Deformation& d) { return d.C.C11 * d.hoop; }

  /// Not known: few unknowns are soon factored.
  static bool is_convex(const Point&, const Deformation&, const WeightedStress&) { return false; }

  static void slope(const Point& point, const Deformation& d, int a, int c, Lanes (&row)[3]) {
    const auto& G = point.gradient[a];
    row[0] = 2.0 * d.along[c] * G[0];
    row[1] = c == 0 ? 2.0 * d.hoop * G[1] : Lanes{};
    row[2] = Lanes{};
  }

  template<bool with_tangent>
  static void accumulate(const Point& point, const Deformation& d, const WeightedStress& stress,
                         Lanes (&residual)[Nodes * 2], Lanes* tangent) {
    for (int a = 0; a < Nodes; ++a) {
      const auto& G = point.gradient[a];
      for (int c = 0; c < 2; ++c) residual[a * 2 + c] += stress.S11 * d.along[c] * G[0];
      residual[a * 2] += stress.S22 * d.hoop * G[1];
    }
    if constexpr (with_tangent) {
      Lanes B[Nodes * 2][3], DB[Nodes * 2][3];
      for (int i = 0; i < Nodes * 2; ++i) {
        slope(point, d, i / 2, i % 2, B[i]);
        stress.times(B[i], DB[i]);
      }
      for (int i = 0; i < Nodes * 2; ++i)
        for (int j = 0; j <= i; ++j) {
          Lanes sum = DB[i][0] * B[j][0] + DB[i][1] * B[j][1];
          const auto &Ga = point.gradient[i / 2], &Gb = point.gradient[j / 2];
          if (i % 2 == j % 2) sum += stress.S11 * Ga[0] * Gb[0];
          if (i % 2 == 0 && j % 2 == 0) sum += stress.S22 * Ga[1] * Gb[1];
          tangent[i * (i + 1) / 2 + j] += sum;
        }
    }
  }

  static Eigen::Matrix<double, 3, 2> gradient_of(const Deformation& d, int lane) {
    Eigen::Matrix<double, 3, 2> F = Eigen::Matrix<double, 3, 2>::Zero();
    F(0, 0) = d.along[0][lane];
    F(2, 0) = d.along[1][lane];
    F(1, 1) = d.hoop[lane];
    return F;
  }
};

} // namespace dielast::fem
