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

/// Kinematics whose blocks keep the gradients as they are.
template<int Nodes>
struct KeepsGradients {
  using Point = FilmPoint<Nodes>;
  using Kept = Point;
  struct Rule {};

  static std::vector<Rule> rule(int points) { return std::vector<Rule>(static_cast<std::size_t>(points)); }
  template<int Corners>
  static void keep(const FilmPlace<Nodes, Corners>& place, int lane, Kept& kept) {
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < 2; ++i) kept.gradient[a][i][lane] = place.gradient(a, i);
  }
  static const Point& point(const Kept& kept, const Rule&) { return kept; }
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
  /// What an element has of its own at a point, as it is kept: all gradients follow from those of the
  /// functions that are linear between the corners and 1 at the second and the third, at two fifths of the
  /// memory that an assembly would read.
  struct Kept {
    Lanes linear[2][2];
    Lanes volume;
  };
  /// Derivatives of the shape functions along the reference triangle's sides, per integration point.
  using Rule = std::array<std::array<double, 2>, Nodes>;

  struct Deformation {
    Lanes F[2][Dim]; ///< by columns
    materials::InPlaneC<Lanes> C;
  };

  /// `X`: nodes as drawn, m.
  static std::vector<FilmPlace<Nodes, corners>> places(const Eigen::Matrix<double, 3, Nodes>& X,
                                                       const MembraneSection& section, int points) {
    std::vector<FilmPlace<Nodes, corners>> all;
    all.reserve(static_cast<std::size_t>(points));
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

  static std::vector<Rule> rule(int points) {
    std::vector<Rule> all;
    for (const TrianglePoint& at : triangle_rule(points)) {
      const Eigen::Matrix<double, Nodes, 2> dN = shape_gradients<Nodes>(at.xi, at.eta);
      Rule& of_point = all.emplace_back();
      for (int a = 0; a < Nodes; ++a) of_point[static_cast<std::size_t>(a)] = {dN(a, 0), dN(a, 1)};
    }
    return all;
  }
  static void keep(const FilmPlace<Nodes, corners>& place, int lane, Kept& kept) {
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) kept.linear[i][j][lane] = place.corner_gradient(1 + i, j);
  }
  static Point point(const Kept& kept, const Rule& rule) {
    Point point;
    for (int a = 0; a < Nodes; ++a)
      for (int j = 0; j < 2; ++j) {
        const auto& dN = rule[static_cast<std::size_t>(a)];
        point.gradient[a][j] = dN[0] * kept.linear[0][j] + dN[1] * kept.linear[1][j];
      }
    point.volume = kept.volume;
    return point;
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

  /// dC/du for component c of node a: of C11, C22, and C12 (as it stands in C, once).
  static void slope(const Point& point, const Deformation& d, int a, int c, Lanes (&row)[3]) {
    const auto& G = point.gradient[a];
    row[0] = 2.0 * d.F[0][c] * G[0];
    row[1] = 2.0 * d.F[1][c] * G[1];
    row[2] = d.F[0][c] * G[1] + d.F[1][c] * G[0];
  }

  /// residual_a += F S grad N_a;  tangent_ab += A grad N_a grad N_b, A = dP/dF. `residual`: null where it is
  /// not wanted. Returns whether the tangent's part is convex, see Evaluation::convex.
  template<bool with_tangent>
  static bool accumulate(const Point& point, const Deformation& d, const WeightedStress& stress,
                         Lanes* residual, Lanes* tangent) {
    for (int a = 0; residual && a < Nodes; ++a) {
      const auto& G = point.gradient[a];
      const Lanes SG[2]{stress.S11 * G[0] + stress.S12 * G[1], stress.S12 * G[0] + stress.S22 * G[1]};
      for (int c = 0; c < Dim; ++c) residual[a * Dim + c] += d.F[0][c] * SG[0] + d.F[1][c] * SG[1];
    }
    if constexpr (!with_tangent) return false;
    Lanes A[2 * Dim][2 * Dim];
    elasticity(d, stress, A);
    for (int a = 0; a < Nodes; ++a)
      for (int c = 0; c < Dim; ++c) {
        Lanes AG[2 * Dim]; // change of P with component c of node a
        for (int i = 0; i < 2 * Dim; ++i)
          AG[i] = A[i][2 * c] * point.gradient[a][0] + A[i][2 * c + 1] * point.gradient[a][1];
        for (int b = 0; b <= a; ++b)
          for (int e = 0; e < Dim; ++e)
            if (b < a || e <= c)
              *tangent++ += point.gradient[b][0] * AG[2 * e] + point.gradient[b][1] * AG[2 * e + 1];
      }
    return is_positive_definite(A, point.volume);
  }

  /// dP/dF, P = F S the first Piola-Kirchhoff stress, a component c and a direction I at place 2 c + I:
  ///   A_cIeJ = delta_ce S_IJ + b_cI^T (d2Psi/dC2) b_eJ, b = dC/dF.
  static void elasticity(const Deformation& d, const WeightedStress& stress, Lanes (&A)[2 * Dim][2 * Dim]) {
    for (int c = 0; c < Dim; ++c) {
      const Lanes f0 = d.F[0][c], f1 = d.F[1][c];
      const Lanes(&D)[6] = stress.D;
      const Lanes Db[2][3]{
          {2.0 * D[0] * f0 + D[4] * f1, 2.0 * D[3] * f0 + D[5] * f1, 2.0 * D[4] * f0 + D[2] * f1},
          {2.0 * D[3] * f1 + D[4] * f0, 2.0 * D[1] * f1 + D[5] * f0, 2.0 * D[5] * f1 + D[2] * f0}};
      for (int e = 0; e <= c; ++e)
        for (int I = 0; I < 2; ++I) {
          A[2 * c + I][2 * e] = 2.0 * Db[I][0] * d.F[0][e] + Db[I][2] * d.F[1][e];
          A[2 * c + I][2 * e + 1] = 2.0 * Db[I][1] * d.F[1][e] + Db[I][2] * d.F[0][e];
        }
      A[2 * c][2 * c] += stress.S11;
      A[2 * c + 1][2 * c] += stress.S12;
      A[2 * c + 1][2 * c + 1] += stress.S22;
    }
    for (int i = 0; i < 2 * Dim; ++i)
      for (int j = i + 1; j < 2 * Dim; ++j) A[i][j] = A[j][i];
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
struct MeridianKinematics : KeepsGradients<Nodes> {
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

  static void slope(const Point& point, const Deformation& d, int a, int c, Lanes (&row)[3]) {
    const auto& G = point.gradient[a];
    row[0] = 2.0 * d.along[c] * G[0];
    row[1] = c == 0 ? 2.0 * d.hoop * G[1] : Lanes{};
    row[2] = Lanes{};
  }

  /// Whether it is convex is not known: few unknowns are soon factored.
  template<bool with_tangent>
  static bool accumulate(const Point& point, const Deformation& d, const WeightedStress& stress,
                         Lanes* residual, Lanes* tangent) {
    for (int a = 0; residual && a < Nodes; ++a) {
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
    return false;
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
