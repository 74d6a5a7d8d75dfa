// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/algebra/small_matrices.hpp"
#include "materials/laws/plane_stress.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::materials {

/// What a film without bending stiffness does: it carries tension in both directions, in one (wrinkled), or
/// in none (slack); or the field pulls it wider without limit, whatever the wrinkles take up.
enum class Tension { taut, wrinkled, slack, lost };

struct TensionField {
  Tension tension = Tension::taut;
  MembranePotential<double> potential;
  InPlaneC<double> natural; ///< C of the film itself: wider than the given C where it wrinkles
  /// d/dC of any function q(natural) is carry * dq/dnatural, in (C11, C22, C12).
  Eigen::Matrix3d carry = Eigen::Matrix3d::Identity();
  /// By how much `natural`, (C11, C22, C12), follows forces on it, as dPsi/dC is one, while C stays: what the
  /// wrinkles take up.
  Eigen::Matrix3d give = Eigen::Matrix3d::Zero();
};

namespace tension_field {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

inline Vector3 first(const MembranePotential<double>& p) { return {p.first[0], p.first[1], p.first[2]}; }

inline Matrix3 second(const MembranePotential<double>& p) {
  const auto& s = p.second;
  Matrix3 D;
  D << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
  return D;
}

/// S = 2 dPsi/dC
inline Eigen::Matrix2d stress(const MembranePotential<double>& p) {
  return Eigen::Matrix2d{{2 * p.first[0], p.first[2]}, {p.first[2], 2 * p.first[1]}};
}

inline InPlaneC<double> plus(const InPlaneC<double>& C, const Eigen::Vector2d& a) {
  return {C.C11 + a[0] * a[0], C.C22 + a[1] * a[1], C.C12 + a[0] * a[1]};
}

/// Smallest principal value and its direction.
struct Smallest {
  double value;
  Eigen::Vector2d direction;
};
inline Smallest smallest(const Eigen::Matrix2d& S) {
  const double mean = (S(0, 0) + S(1, 1)) / 2, half = (S(0, 0) - S(1, 1)) / 2;
  const double radius = std::sqrt(half * half + S(0, 1) * S(0, 1));
  if (radius == 0) return {mean, {0, 1}};
  const Eigen::Vector2d largest =
      half > 0 ? Eigen::Vector2d(half + radius, S(0, 1)) : Eigen::Vector2d(S(0, 1), radius - half);
  const Eigen::Vector2d along = largest.normalized();
  return {mean - radius, {-along[1], along[0]}};
}

/// Newton step -D^-1 g, with concave directions turned downhill.
template<int N>
Eigen::Vector<double, N> downhill(const Eigen::Matrix<double, N, N>& D, const Eigen::Vector<double, N>& g) {
  if (const auto L = cholesky_factor(D)) {
    const auto lower = L->template triangularView<Eigen::Lower>();
    return -lower.transpose().solve(lower.solve(g));
  }
  const auto [values, axes] = symmetric_eigen(D);
  const Eigen::Vector<double, N> stiffness = values.cwiseAbs();
  return -axes * (axes.transpose() * g).cwiseQuotient(stiffness.cwiseMax(1e-9 * stiffness.maxCoeff()));
}

/// A wider film, or none where no finite width will do: `found` is false.
struct Widened {
  bool found;
  InPlaneC<double> C;
  MembranePotential<double> psi;
};

constexpr double widest = 1e8;     ///< of tr C: beyond, nothing takes the compression up
constexpr double exact = 1e-13;    ///< stress that counts as none, of the stiffness
constexpr double rounding = 1e-13; ///< of the energy, over the stiffness
/// What dashpots take up in a short time has more rounding than the film's energy. Where a step promises no
/// more than this, forces that fall by half tell.
constexpr double much_rounding = 1e-5;

/// Whether a step leads on that changes the energy by `change` and was to change it by `foretold`; `whole`:
/// that of a strain of one.
inline bool falls(double change, double foretold, double whole, double force, double force_before) {
  if (change <= rounding * whole) return true;
  return std::max(change, -foretold) <= much_rounding * whole && force <= force_before / 2;
}

/// C + b v v^T with next to no stress along the unit vector v; in compression at `taut`.
template<class Potential>
Widened widened_along(const Potential& psi, const InPlaneC<double>& C, const MembranePotential<double>& taut,
                      const Eigen::Vector2d& v) {
  const Vector3 n(v[0] * v[0], v[1] * v[1], v[0] * v[1]); // dC/db, C12 once
  const double size = C.trace();
  const auto at = [&](double b) {
    return InPlaneC<double>{C.C11 + b * n[0], C.C22 + b * n[1], C.C12 + b * n[2]};
  };
  double b = 0, low = 0, high = std::numeric_limits<double>::infinity();
  MembranePotential<double> p = taut;
  for (int i = 0; i < 100 && b < widest * size; ++i) {
    const double slope = first(p).dot(n), curvature = n.dot(second(p) * n);
    // Beyond a stretch limit, where slopes mean nothing, counts as too wide: the root lies before it.
    (slope < 0 && std::isfinite(p.value) ? low : high) = b;
    const double newton = b - slope / curvature, end = std::min(high, b + 3 * (size + b));
    const bool near = curvature > 0 && std::abs(newton - b) <= 0.1 * b;
    if (near || (newton > low && newton < end))
      b = newton;
    else
      b = std::isinf(high) ? end : (low + high) / 2;
    p = psi(at(b));
    if (near && std::isfinite(p.value)) return {true, at(b), p};
  }
  return {false, C, taut};
}

/// Minimum of Psi(C + a a^T) over a, from the widened film `from` and its a. The direction of a changes only
/// where branches were loaded along other axes than C's.
template<class Potential>
Widened settled_wrinkle(const Potential& psi, const InPlaneC<double>& C, Widened from, Eigen::Vector2d& a) {
  const double size = C.trace();
  for (int i = 0; i < 60; ++i) {
    const Matrix3 D = second(from.psi);
    const Eigen::Matrix2d S = stress(from.psi);
    const Eigen::Vector2d gradient = S * a;
    if (gradient.norm() <= exact * D.norm() * a.norm() * size) return from;
    Eigen::Matrix<double, 3, 2> M; // d(a a^T)/da
    M << 2 * a[0], 0, 0, 2 * a[1], a[1], a[0];
    Eigen::Vector2d step = downhill<2>(M.transpose() * D * M + S, gradient);
    const bool last = step.norm() <= 1e-8 * a.norm();
    const double whole = D.norm() * size * size;
    for (int halving = 0; halving < 40; ++halving, step /= 2) {
      const InPlaneC<double> there = plus(C, a + step);
      const MembranePotential<double> trial = psi(there);
      if (!(last || falls(trial.value - from.psi.value, gradient.dot(step), whole,
                          (stress(trial) * (a + step)).norm(), gradient.norm())))
        continue;
      a += step;
      from = {true, there, trial};
      break;
    }
    if (last) return from;
  }
  from.found = false;
  return from;
}

/// The film without any stress, from the state `from`.
template<class Potential>
Widened natural_state(const Potential& psi, Widened from) {
  const double size = from.C.trace();
  for (int i = 0; i < 100 && from.C.trace() < widest * size; ++i) {
    const Matrix3 D = second(from.psi);
    const Vector3 g = first(from.psi);
    if (g.norm() <= exact * D.norm() * size) return from;
    Vector3 step = downhill<3>(D, g);
    const bool last = step.norm() <= 1e-8 * from.C.trace();
    const double whole = D.norm() * size * size;
    for (int halving = 0; halving < 40; ++halving, step /= 2) {
      const InPlaneC<double> there{from.C.C11 + step[0], from.C.C22 + step[1], from.C.C12 + step[2]};
      if (!(there.C11 > 0 && there.det() > 0)) continue;
      const MembranePotential<double> trial = psi(there);
      if (!(last || falls(trial.value - from.psi.value, g.dot(step), whole, first(trial).norm(), g.norm())))
        continue;
      from = {true, there, trial};
      break;
    }
    if (last) return from;
  }
  from.found = false;
  return from;
}

} // namespace tension_field

/// Relaxed (tension-field) energy of any membrane potential Psi(C) (Pipkin 1986, IMA J. Appl. Math. 36;
/// Steigmann 1990): fine wrinkles widen the film by a (x) a without cost,
///   Psi_r(C) = min over a of Psi(C + a a^T),
/// so that no principal stress is negative; where both would be, the film is slack and Psi_r is the minimum
/// of Psi. The field is part of Psi, so that wrinkles of a charged film are wider than those of an uncharged
/// one. `psi(C)` returns a MembranePotential<double>. The derivatives are exact: stress of the widened film,
/// tangent condensed over a.
template<class Potential>
TensionField relax(const Potential& psi, const InPlaneC<double>& C, const MembranePotential<double>& taut) {
  using namespace tension_field;
  const Smallest compressed = smallest(stress(taut));
  // Rounding leaves a little compression in a film at rest: it is taut, with the stiffness of a film.
  if (!(compressed.value < -1e-12 * second(taut).norm() * C.trace())) return {Tension::taut, taut, C};

  const TensionField lost{Tension::lost, taut, C};
  Widened film = widened_along(psi, C, taut, compressed.direction);
  if (!film.found) return lost;
  Eigen::Vector2d a = std::sqrt(film.C.trace() - C.trace()) * compressed.direction;
  film = settled_wrinkle(psi, C, film, a);
  if (!film.found) return lost;

  const Matrix3 D = second(film.psi);
  const Eigen::Vector2d v = a.normalized(), e(-v[1], v[0]);
  const double tension = e.dot(stress(film.psi) * e);
  if (tension < -1e-9 * D.norm() * C.trace()) {
    film = natural_state(psi, film);
    if (!film.found) return lost;
    return {Tension::slack, {film.psi.value, {}, {}}, film.C, Matrix3::Zero(), second(film.psi).inverse()};
  }
  // Stationary in the width b = a a and in the direction of a: A is their stiffness, the direction's over b,
  // which is regular where b vanishes.
  Eigen::Matrix<double, 3, 2> N;
  N << v[0] * v[0], 2 * v[0] * e[0], v[1] * v[1], 2 * v[1] * e[1], v[0] * v[1], v[0] * e[1] + v[1] * e[0];
  Eigen::Matrix2d A = N.transpose() * D * N;
  A(1, 1) += std::max(tension, 0.0) / a.squaredNorm();
  const Matrix3 give = N * A.inverse() * N.transpose(), carry = Matrix3::Identity() - D * give;
  const Matrix3 tangent = carry * D;
  MembranePotential<double> relaxed = film.psi;
  for (std::size_t p = 0; p < 6; ++p)
    relaxed.second[p] = tangent(component_pairs[p][0], component_pairs[p][1]);
  return {Tension::wrinkled, relaxed, film.C, carry, give};
}

} // namespace dielast::materials
