// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/inertia.hpp"
#include "meshing/meridian.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::film_mass_test {
namespace {

/// Twice the kinetic energy of the velocities v(X), J.
double v_M_v(const meshing::Mesh& mesh, Dimension dimension, const MembraneSection& section, int points,
             const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& v) {
  const auto model = test::free_model(
      mesh.node_count(), dimension,
      make_membrane_block(mesh, mesh.blocks[0], section,
                          std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), passive),
                          dimension, points));
  Eigen::VectorXd velocity(model->dofs.count());
  for (int a = 0; a < mesh.node_count(); ++a)
    for (int c = 0; c < 3; ++c)
      if (const int e = model->dofs.equation(a, c); e != DofMap::absent)
        velocity[e] = v(mesh.nodes[static_cast<std::size_t>(a)])[c];
  const Inertia inertia = Inertia::of(model->blocks, model->dofs);
  const Eigen::SparseMatrix<double> M = inertia.mass, turned = M.transpose();
  EXPECT_EQ((M - turned).norm(), 0);
  return velocity.dot(M * velocity);
}

// rho = 960 kg/m^3, H = 1 mm, drawn 2 x 1.5 times as large: 0.32 kg/m^2 of the drawing.
constexpr double areal_mass = 0.32;

TEST(FilmMass, of_triangles_is_exact_for_linear_velocities) {
  for (const int order : {1, 2})
    for (const Dimension dimension : {Dimension::planar, Dimension::spatial}) {
      const meshing::Mesh mesh = test::distorted_square(3, order, 2.0);
      const MembraneSection section = test::vhb(2, 1.5);
      const auto of = [&](const auto& v) { return v_M_v(mesh, dimension, section, order == 1 ? 1 : 3, v); };
      EXPECT_NEAR(of([](const Eigen::Vector3d&) { return Eigen::Vector3d(1, 0, 0); }), 4 * areal_mass, 1e-14);
      // int (1 + 3 x - y)^2 + (2 y)^2 over a square of side 2 (and z: x^2)
      const double in_plane = 4 * (1 + 9 * 4.0 / 3 + 4.0 / 3 + 6 - 2 - 6) + 16 * 4.0 / 3, across = 16.0 / 3;
      EXPECT_NEAR(of([](const Eigen::Vector3d& X) {
                    return Eigen::Vector3d(1 + 3 * X.x() - X.y(), 2 * X.y(), X.x());
                  }),
                  areal_mass * (in_plane + (dimension == Dimension::spatial ? across : 0)), 1e-13);
    }
}

TEST(FilmMass, of_meridians_is_exact_for_linear_velocities) {
  for (const int order : {1, 2}) {
    const meshing::Mesh mesh = meshing::annulus_meridian(0.5, 2, 5, order, 3);
    const MembraneSection section = test::vhb(2, 1.5);
    const auto of = [&](const auto& v) {
      return v_M_v(mesh, Dimension::axisymmetric, section, order == 1 ? 2 : 3, v);
    };
    constexpr double pi = std::numbers::pi;
    EXPECT_NEAR(of([](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 0, 1); }),
                pi * (4 - 0.25) * areal_mass, 1e-14);
    // 2 pi int r^2 + (1 - 2 r)^2 r dr
    const auto primitive = [](double r) {
      return 5 * std::pow(r, 4) / 4 - 4 * std::pow(r, 3) / 3 + r * r / 2;
    };
    EXPECT_NEAR(of([](const Eigen::Vector3d& X) { return Eigen::Vector3d(X.x(), 0, 1 - 2 * X.x()); }),
                2 * pi * areal_mass * (primitive(2) - primitive(0.5)), 1e-13);
  }
}

} // namespace
} // namespace dielast::fem::film_mass_test
