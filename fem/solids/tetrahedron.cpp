// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solids/tetrahedron.hpp"

#include <cmath>

namespace dielast::fem {

namespace {

/// Corners between which the middle nodes lie.
constexpr std::array<std::array<int, 2>, 6> sides{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

Eigen::Vector4d barycentric(const Eigen::Vector3d& local) {
  return {1 - local.sum(), local.x(), local.y(), local.z()};
}

/// Gradients of the barycentric coordinates.
Eigen::Matrix<double, 4, 3> barycentric_slope() {
  Eigen::Matrix<double, 4, 3> slope;
  slope << -Eigen::RowVector3d::Ones(), Eigen::Matrix3d::Identity();
  return slope;
}

} // namespace

const std::array<TetrahedronPoint, 4>& tetrahedron_rule() {
  static const std::array<TetrahedronPoint, 4> rule = [] {
    const double far = (5 + 3 * std::sqrt(5.0)) / 20, near = (5 - std::sqrt(5.0)) / 20;
    std::array<TetrahedronPoint, 4> points;
    for (std::size_t p = 0; p < 4; ++p) {
      points[p] = {Eigen::Vector3d::Constant(near), 1.0 / 24};
      if (p > 0) points[p].local[static_cast<int>(p) - 1] = far;
    }
    return points;
  }();
  return rule;
}

template<>
Eigen::Vector4d tetrahedron_shape<4>(const Eigen::Vector3d& local) {
  return barycentric(local);
}

template<>
Eigen::Vector<double, 10> tetrahedron_shape<10>(const Eigen::Vector3d& local) {
  const Eigen::Vector4d l = barycentric(local);
  Eigen::Vector<double, 10> shape;
  for (int a = 0; a < 4; ++a) shape[a] = l[a] * (2 * l[a] - 1);
  for (int s = 0; s < 6; ++s) {
    const auto [a, b] = sides[static_cast<std::size_t>(s)];
    shape[4 + s] = 4 * l[a] * l[b];
  }
  return shape;
}

template<>
Eigen::Matrix<double, 4, 3> tetrahedron_slope<4>(const Eigen::Vector3d& /*everywhere*/) {
  return barycentric_slope();
}

template<>
Eigen::Matrix<double, 10, 3> tetrahedron_slope<10>(const Eigen::Vector3d& local) {
  const Eigen::Vector4d l = barycentric(local);
  const Eigen::Matrix<double, 4, 3> of_l = barycentric_slope();
  Eigen::Matrix<double, 10, 3> slope;
  for (int a = 0; a < 4; ++a) slope.row(a) = (4 * l[a] - 1) * of_l.row(a);
  for (int s = 0; s < 6; ++s) {
    const auto [a, b] = sides[static_cast<std::size_t>(s)];
    slope.row(4 + s) = 4 * (l[a] * of_l.row(b) + l[b] * of_l.row(a));
  }
  return slope;
}

const std::array<TetrahedronMassPoint, 15>& tetrahedron_mass_rule() {
  static const std::array<TetrahedronMassPoint, 15> rule = [] {
    std::array<TetrahedronMassPoint, 15> points{};
    std::size_t count = 0;
    // In barycentric coordinates; the four points of degree 2 lie at (far, near, near, near) and so on.
    const std::array<TetrahedronPoint, 4>& four = tetrahedron_rule();
    const double root = std::sqrt(5.0), near = (5 - root) / 20, far = (5 + 3 * root) / 20;
    const auto add = [&](const Eigen::Vector4d& at, double weight) {
      TetrahedronMassPoint& point = points.at(count++);
      point.shape = tetrahedron_shape<10>(at.tail<3>());
      for (std::size_t p = 0; p < 4; ++p)
        point.share[p] = weight / four[p].weight * (at[static_cast<int>(p)] - near) / (far - near);
    };
    add(Eigen::Vector4d::Constant(0.25), 0.030283678097089182);
    for (int i = 0; i < 4; ++i) {
      Eigen::Vector4d on_face = Eigen::Vector4d::Constant(1.0 / 3),
                      inside = Eigen::Vector4d::Constant(1.0 / 11);
      on_face[i] = 0;
      inside[i] = 8.0 / 11;
      add(on_face, 27.0 / 4480);
      add(inside, 0.011645249086028963);
    }
    constexpr double a = 0.066550153573664281;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) {
        Eigen::Vector4d at = Eigen::Vector4d::Constant(0.5 - a);
        at[i] = at[j] = a;
        add(at, 0.010949141561386449);
      }
    return points;
  }();
  return rule;
}

} // namespace dielast::fem
