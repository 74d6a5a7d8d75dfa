// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/film_kinematics.hpp"
#include "fem/model/samples.hpp"

#include <Eigen/Geometry>

namespace dielast::fem {

/// A straight rod of film between two nodes in the plane (Dim = 2) or in space, which is free to contract in
/// both directions across itself alike, as an incompressible cylinder does: with the stretch lambda along the
/// rod C11 = lambda^2, C22 = 1/lambda, C12 = 0. A law with energy W(C) thus stores W(lambda^2, 1/lambda), and
/// a field k through the film's thickness -(k/2) lambda. The gradients of a point are dN_a/dS along the
/// unstretched rod; a volume is that of a strip of the section's width.
template<int Dim>
struct RodKinematics : KeepsGradients<2> {
  static constexpr const char* element = "rod";
  static constexpr bool free_across = true;
  static constexpr int nodes = 2, dim = Dim, corners = 2;
  static constexpr std::array<int, 3> components{0, 1, 2};
  static constexpr int mass_points = 2;
  using Point = FilmPoint<nodes>;

  struct Deformation {
    Lanes along[Dim]; ///< dx/dS
    materials::InPlaneC<Lanes> C;
    Lanes narrowing; ///< dC22/dC11
  };

  static std::vector<FilmPlace<nodes, corners>> places(const Eigen::Matrix<double, 3, nodes>& X,
                                                       const MembraneSection& section, int points) {
    std::vector<FilmPlace<nodes, corners>> all;
    const double length = (X.col(1) - X.col(0)).norm() / section.prestretch[0];
    for (const MeridianPoint& at : meridian_rule(points)) {
      FilmPlace<nodes, corners> place{meridian_shape<2>(at.xi), {}, 0, meridian_shape<2>(at.xi), {}};
      place.gradient << meridian_slope<2>(at.xi) * (2 / length), Eigen::Vector2d::Zero();
      place.area = at.weight / 2 * length * section.width;
      place.corner_gradient = place.gradient;
      all.push_back(place);
    }
    return all;
  }

  static Deformation deformation(const Lanes (&x)[nodes][Dim], const Point& point) {
    Deformation d{};
    for (int c = 0; c < Dim; ++c) {
      for (int a = 0; a < nodes; ++a) d.along[c] += x[a][c] * point.gradient[a][0];
      d.C.C11 += d.along[c] * d.along[c];
    }
    for (int l = 0; l < lanes; ++l) d.C.C22[l] = 1 / std::sqrt(d.C.C11[l]);
    d.narrowing = -0.5 * d.C.C22 / d.C.C11;
    return d;
  }

  static Lanes orientation(const Deformation& d) { return d.C.C11; }

  static void slope(const Point& point, const Deformation& d, int a, int c, Lanes (&row)[3]) {
    row[0] = 2.0 * d.along[c] * point.gradient[a][0];
    row[1] = d.narrowing * row[0];
    row[2] = Lanes{};
  }

  /// Of Psi(C11, C22(C11)): the stress is S11 + S22 C22', the stiffness
  /// Psi,11 + 2 Psi,12 C22' + Psi,22 C22'^2 + Psi,2 C22''. Whether it is convex is not known: a rod gives way
  /// across itself.
  template<bool with_tangent>
  static bool accumulate(const Point& point, const Deformation& d, const WeightedStress& stress,
                         Lanes* residual, Lanes* tangent) {
    const Lanes S = stress.S11 + stress.S22 * d.narrowing;
    for (int a = 0; residual && a < nodes; ++a)
      for (int c = 0; c < Dim; ++c) residual[a * Dim + c] += S * d.along[c] * point.gradient[a][0];
    if constexpr (with_tangent) {
      const Lanes bend = -1.5 * d.narrowing / d.C.C11; // d2C22/dC11^2
      const Lanes D = stress.D[0] + 2.0 * stress.D[3] * d.narrowing +
                      stress.D[1] * d.narrowing * d.narrowing + 0.5 * stress.S22 * bend;
      for (int i = 0; i < nodes * Dim; ++i)
        for (int j = 0; j <= i; ++j) {
          const Lanes both = point.gradient[i / Dim][0] * point.gradient[j / Dim][0];
          Lanes sum = 4.0 * D * d.along[i % Dim] * d.along[j % Dim];
          if (i % Dim == j % Dim) sum += S;
          tangent[i * (i + 1) / 2 + j] += both * sum;
        }
    }
    return false;
  }

  /// A film's sample as the rod's: across it is free of stress.
  static void relieve(MembraneSample& sample, const Deformation& d, int lane) {
    const double along = sample.S(0, 0) + sample.S(1, 1) * d.narrowing[lane];
    sample.S << along, 0, 0, 0;
    sample.tension = along < 0 ? materials::Tension::slack : materials::Tension::taut;
  }

  /// The film's second direction is drawn across the rod, in the plane across z where that can be.
  static Eigen::Matrix<double, 3, 2> gradient_of(const Deformation& d, int lane) {
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    for (int c = 0; c < Dim; ++c) along[c] = d.along[c][lane];
    Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(along);
    if (across.norm() < 1e-9 * along.norm()) across = Eigen::Vector3d::UnitX();
    Eigen::Matrix<double, 3, 2> F;
    F << along, across.normalized() * std::sqrt(d.C.C22[lane]);
    return F;
  }
};

} // namespace dielast::fem
