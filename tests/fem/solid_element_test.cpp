// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_solids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dielast::fem::solid_element_test {
namespace {

/// Curved triangles on the unit square, in the plane of the model, off the axis.
meshing::Mesh curved_mesh(Dimension dimension, int n = 2) {
  meshing::Mesh mesh = test::distorted_square(n, 2);
  std::mt19937 random(5);
  for (auto& x : mesh.nodes) {
    x.head<2>() += test::random_vector(random, 2, 0.06 / n);
    if (dimension == Dimension::axisymmetric) x = {x.x() + 0.3, 0, x.y()};
  }
  return mesh;
}

TEST(Solid, residual_and_tangent_are_the_derivatives_of_the_energy) {
  for (const Dimension dimension : {Dimension::planar, Dimension::axisymmetric})
    for (const bool potential : {false, true}) {
      const meshing::Mesh mesh = curved_mesh(dimension);
      const auto model = test::solid_model(mesh, test::various_sections(), potential, dimension);
      test::expect_consistent_derivatives(*model, test::random_solid_state(*model, mesh, dimension), 0.1,
                                          1e-8);
    }
}

TEST(Solid, charges_are_the_derivatives_of_the_energy) {
  for (const Dimension dimension : {Dimension::planar, Dimension::axisymmetric})
    for (const bool potential : {false, true}) {
      const meshing::Mesh mesh = curved_mesh(dimension);
      const auto model = test::solid_model(mesh, {test::solid_section()}, potential, dimension);
      test::expect_charges_are_derivatives(*model, test::random_solid_state(*model, mesh, dimension));
    }
}

/// The capacitance with the potential in equilibrium is the charge that one volt brings.
TEST(Solid, capacitance_lets_the_potential_follow) {
  const meshing::Mesh mesh = curved_mesh(Dimension::planar);
  const auto model = test::solid_model(mesh, {test::solid_section()}, true, Dimension::planar);
  State state = test::random_solid_state(*model, mesh, Dimension::planar);
  const double capacitance = model->capacitance(state, 0);
  state.voltage = {1};
  model->balance_fields(state);
  EXPECT_NEAR(model->charges(state, false).charge[0], capacitance, 1e-12 * capacitance);
  EXPECT_LT(capacitance, 0.9 * model->charges(state, false).capacitance[0]);
  Assembler assembler(*model, 1); // and the potentials are in equilibrium
  Eigen::VectorXd force;
  assembler.residual(state, force);
  const int potentials = mesh.node_count() - 2;
  EXPECT_LT(force.tail(potentials).norm(), 1e-12 * force.norm());
}

TEST(Solid, rigid_motions_change_nothing) {
  const meshing::Mesh mesh = curved_mesh(Dimension::planar);
  const auto model = test::solid_model(mesh, {test::solid_section()}, true, Dimension::planar);
  test::expect_rigid_motion_changes_nothing(
      *model, mesh, test::random_solid_state(*model, mesh, Dimension::planar),
      Eigen::Quaterniond(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ())), {3, -2, 0});
}

/// Patch test: affine displacements of the edge give that deformation, and one pressure, everywhere.
TEST(Solid, distorted_patch_deforms_homogeneously) {
  for (const double bulk_modulus :
       {1e6, 1e9}) { // exactly incompressible and held all around, any pressure would do
    const test::HeldSolid patch(test::distorted_square(4, 2), Dimension::planar, bulk_modulus,
                                [](const Eigen::Vector3d& X, int) {
                                  return X.head<2>().minCoeff() < 1e-9 || X.head<2>().maxCoeff() > 1 - 1e-9;
                                });
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F.topLeftCorner<2, 2>() << 1.4, 0.3, 0, 1 / 1.4;
    F(0, 0) *= 1 + 1e3 / bulk_modulus;
    const double pressure = -bulk_modulus * (F.determinant() - 1);
    for (const double p : patch.expect_finds_its_way_back(F).scalar)
      EXPECT_NEAR(p, pressure, 1e-8 * std::abs(pressure));
  }
}

/// Exactly incompressible with one side free: the stress across it vanishes, which gives the pressure.
TEST(Solid, incompressible_patch_finds_its_pressure) {
  const test::HeldSolid patch(test::distorted_square(4, 2), Dimension::planar, test::incompressible,
                              [](const Eigen::Vector3d& X, int c) {
                                return c == 0 ? X.x() < 1e-9 || X.x() > 1 - 1e-9 : X.y() < 1e-9;
                              });
  constexpr double stretch = 1.4;
  const State state = patch.expect_finds_its_way_back(Eigen::Vector3d(stretch, 1 / stretch, 1).asDiagonal());
  const double square = 1 / (stretch * stretch), mean = (stretch * stretch + square + 1) / 3;
  for (const double p : state.scalar) EXPECT_NEAR(p, test::solid_mu * (square - mean), 1e-7 * test::solid_mu);
}

/// Cook's membrane, incompressible: a coarse mesh is as soft as a fine one.
TEST(Solid, cooks_membrane_does_not_lock) {
  const auto tip = [](int n) {
    const test::HeldSolid cook(
        test::cooks(test::distorted_square(n, 2, 1, 0)), Dimension::planar, test::incompressible,
        [](const Eigen::Vector3d& X, int) { return X.x() < 1e-9; }, 0.06);
    return test::cooks_deflection(cook, test::solid_width, [&](const Eigen::Vector3d& X) {
      return test::simpson_share((X.y() - 0.044) / 0.016, n);
    });
  };
  const double coarse = tip(4), middle = tip(8), fine = tip(16);
  EXPECT_GT(fine, 0.003);
  EXPECT_NEAR(coarse, fine, 0.04 * fine); // the clamped corners are singular
  EXPECT_NEAR(middle, fine, 0.012 * fine);
}

/// A column between guided ends is unstable from Euler's loads on. Its straight state is homogeneous.
TEST(Solid, column_buckles_at_eulers_loads) {
  constexpr double slenderness = 0.05; // height over length
  test::expect_eulers_loads({test::strip(24, 2, 1, slenderness), Dimension::planar, test::incompressible,
                             [](const Eigen::Vector3d& X, int c) {
                               return c == 0 ? X.x() < 1e-9 || X.x() > 1 - 1e-9 : X.head<2>().norm() < 1e-9;
                             }},
                            std::pow(std::numbers::pi * slenderness, 2) / 12);
}

} // namespace
} // namespace dielast::fem::solid_element_test
