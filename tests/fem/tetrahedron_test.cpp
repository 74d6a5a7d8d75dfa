// SPDX-License-Identifier: GPL-3.0-or-later
// Solids of 10-node tetrahedra: what solid_element_test.cpp asks of triangles.
#include "fem/solids/tetrahedron.hpp"
#include "meshing/solids/extruded.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_solids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dielast::fem::tetrahedron_test {
namespace {

meshing::Mesh drawn_out(const meshing::Mesh& drawing, const std::vector<double>& levels) {
  return meshing::extruded(
      drawing, levels, [](const Eigen::Vector3d& x, double z) { return Eigen::Vector3d(x.x(), x.y(), z); },
      "low", "high");
}

/// The unit cube, its inner corners moved at random, sides straight.
meshing::Mesh distorted_cube(int n, double distortion = 0.2) {
  std::vector<double> levels;
  for (int i = 0; i <= n; ++i) levels.push_back(static_cast<double>(i) / n);
  meshing::Mesh mesh = drawn_out(test::distorted_square(n, 2, 1, 0), levels);
  std::mt19937 random(7);
  const meshing::CellBlock& block = mesh.blocks[0];
  std::vector<bool> is_corner(mesh.nodes.size());
  for (int c = 0; c < block.size(); ++c)
    for (const int node : block.cell(c).first(4)) is_corner[static_cast<std::size_t>(node)] = true;
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    if (is_corner[a] && mesh.nodes[a].minCoeff() > 1e-9 && mesh.nodes[a].maxCoeff() < 1 - 1e-9)
      mesh.nodes[a] += test::random_vector(random, 3, distortion / n);
  constexpr std::array<std::array<std::size_t, 2>, 6> sides{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  for (int c = 0; c < block.size(); ++c)
    for (std::size_t s = 0; s < 6; ++s) {
      const auto nodes = block.cell(c);
      const auto [a, b] = sides[s];
      mesh.nodes[static_cast<std::size_t>(nodes[4 + s])] =
          (mesh.nodes[static_cast<std::size_t>(nodes[a])] + mesh.nodes[static_cast<std::size_t>(nodes[b])]) /
          2;
    }
  return mesh;
}

/// Curved tetrahedra.
meshing::Mesh curved_cube() {
  meshing::Mesh mesh = distorted_cube(2, 0.15);
  std::mt19937 random(5);
  for (auto& x : mesh.nodes) x += test::random_vector(random, 3, 0.02);
  return mesh;
}

TEST(Tetrahedron, rule_and_shapes_are_exact) {
  double one = 0, x = 0, xy = 0, xx = 0;
  for (const auto& [at, weight] : tetrahedron_rule()) {
    one += weight;
    x += weight * at.x();
    xy += weight * at.x() * at.y();
    xx += weight * at.z() * at.z();
  }
  EXPECT_NEAR(one, 1.0 / 6, 1e-15);
  EXPECT_NEAR(x, 1.0 / 24, 1e-15);
  EXPECT_NEAR(xy, 1.0 / 120, 1e-15);
  EXPECT_NEAR(xx, 1.0 / 60, 1e-15);
  const Eigen::Vector3d at(0.2, 0.3, 0.1);
  constexpr double step = 1e-6;
  EXPECT_NEAR(tetrahedron_shape<10>(at).sum(), 1, 1e-15);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d by = step * Eigen::Vector3d::Unit(i);
    const Eigen::Vector<double, 10> slope =
        (tetrahedron_shape<10>(at + by) - tetrahedron_shape<10>(at - by)) / (2 * step);
    EXPECT_LT((tetrahedron_slope<10>(at).col(i) - slope).norm(), 1e-9);
  }
}

TEST(Tetrahedron, residual_and_tangent_are_the_derivatives_of_the_energy) {
  std::vector<SolidSection> sections = test::various_sections();
  SolidSection& ogden = sections.emplace_back(test::solid_section());
  ogden.material.law = materials::Ogden{{4e4, 1e4}, {1.3, 5.0}};
  ogden.normal = Eigen::Vector3d(1, 2, 2) / 3;
  const meshing::Mesh mesh = curved_cube();
  for (const bool potential : {false, true}) {
    const auto model = test::solid_model(mesh, sections, potential, Dimension::spatial);
    test::expect_consistent_derivatives(*model, test::random_solid_state(*model, mesh, Dimension::spatial),
                                        0.1, 1e-8);
  }
}

TEST(Tetrahedron, charges_are_the_derivatives_of_the_energy) {
  const meshing::Mesh mesh = curved_cube();
  for (const bool potential : {false, true}) {
    const auto model = test::solid_model(mesh, {test::solid_section()}, potential, Dimension::spatial);
    test::expect_charges_are_derivatives(*model, test::random_solid_state(*model, mesh, Dimension::spatial));
  }
}

TEST(Tetrahedron, rigid_motions_change_nothing) {
  const meshing::Mesh mesh = curved_cube();
  const auto model = test::solid_model(mesh, {test::solid_section()}, true, Dimension::spatial);
  test::expect_rigid_motion_changes_nothing(
      *model, mesh, test::random_solid_state(*model, mesh, Dimension::spatial),
      Eigen::Quaterniond(Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 2, -1).normalized())), {3, -2, 1});
}

/// Without layers the axes do not matter; a model of the plane takes no tetrahedra.
TEST(Tetrahedron, is_in_space_only) {
  const meshing::Mesh mesh = distorted_cube(1, 0);
  const std::size_t count = static_cast<std::size_t>(mesh.blocks[0].size());
  const SolidCells cells{mesh.blocks[0], std::vector<int>(count, passive), std::vector<int>(count, 0)};
  EXPECT_THROW(make_solid_block(mesh, cells, {test::solid_section()}, {}, Dimension::planar),
               std::invalid_argument);
  meshing::Mesh inverted = mesh;
  for (auto& x : inverted.nodes) x.z() = -x.z();
  EXPECT_THROW(make_solid_block(inverted, cells, {test::solid_section()}, {}, Dimension::spatial),
               std::invalid_argument);
}

TEST(Tetrahedron, distorted_patch_deforms_homogeneously) {
  for (const double bulk_modulus : {1e6, 1e9}) {
    const test::HeldSolid patch(
        distorted_cube(3), Dimension::spatial, bulk_modulus,
        [](const Eigen::Vector3d& X, int) { return X.minCoeff() < 1e-9 || X.maxCoeff() > 1 - 1e-9; });
    Eigen::Matrix3d F;
    F << 1.4, 0.3, 0.1, 0, 0.9, -0.2, 0, 0, 1 / (1.4 * 0.9);
    F *= std::cbrt(1 + 1e3 / bulk_modulus);
    const double pressure = -bulk_modulus * (F.determinant() - 1);
    for (const double p : patch.expect_finds_its_way_back(F).scalar)
      EXPECT_NEAR(p, pressure, 1e-7 * std::abs(pressure));
  }
}

/// Pulled along x with free sides: the stress across them vanishes, which gives the pressure.
TEST(Tetrahedron, incompressible_patch_finds_its_pressure) {
  const test::HeldSolid patch(distorted_cube(3), Dimension::spatial, test::incompressible,
                              [](const Eigen::Vector3d& X, int c) {
                                return c == 0 ? X.x() < 1e-9 || X.x() > 1 - 1e-9 : X[c] < 1e-9;
                              });
  constexpr double stretch = 1.4, mu = test::solid_mu;
  const double across = 1 / std::sqrt(stretch), mean = (stretch * stretch + 2 / stretch) / 3;
  for (const double p :
       patch.expect_finds_its_way_back(Eigen::Vector3d(stretch, across, across).asDiagonal()).scalar)
    EXPECT_NEAR(p, mu * (1 / stretch - mean), 1e-7 * mu);
}

/// Cook's membrane, incompressible, 16 mm thick: a coarse mesh is as soft as a fine one.
TEST(Tetrahedron, cooks_membrane_does_not_lock) {
  const auto tip = [](int n) {
    std::vector<double> levels;
    for (int i = 0; i <= n / 2; ++i) levels.push_back(0.016 * 2 * i / n);
    const test::HeldSolid cook(
        test::cooks(drawn_out(test::distorted_square(n, 2, 1, 0), levels)), Dimension::spatial,
        test::incompressible, [](const Eigen::Vector3d& X, int) { return X.x() < 1e-9; }, 0.06);
    // Consistent where the side is of squares of two triangles.
    return test::cooks_deflection(cook, 0.016, [&](const Eigen::Vector3d& X) {
      return test::simpson_share((X.y() - 0.044) / 0.016, n) * test::simpson_share(X.z() / 0.016, n / 2);
    });
  };
  const double coarse = tip(2), middle = tip(4), fine = tip(8);
  EXPECT_GT(fine, 0.003);
  EXPECT_NEAR(coarse, fine, 0.12 * fine);
  EXPECT_NEAR(middle, fine, 0.03 * fine); // the clamped edge is singular
}

/// A block between plates that stick to it, pressed by a tenth: a coarse mesh stores nearly what a fine one
/// does.
TEST(Tetrahedron, compressed_block_does_not_lock) {
  const auto press = [](int n) {
    const test::HeldSolid block(
        distorted_cube(n, 0), Dimension::spatial, test::incompressible, [](const Eigen::Vector3d& X, int c) {
          return X.z() < 1e-9 || X.z() > 1 - 1e-9 || (c < 2 && X[c] < 1e-9); // a quarter
        });
    State state = block.model->initial_state();
    for (std::size_t k = 0; k < block.mesh.nodes.size(); ++k)
      state.displacement[k].z() = -0.1 * block.mesh.nodes[k].z();
    Equilibrium equilibrium(*block.model, 1);
    const NewtonResult result = equilibrium.solve(state, {});
    EXPECT_EQ(result.outcome, Outcome::converged);
    EXPECT_EQ(result.unstable_modes, 0);
    Assembler assembler(*block.model, 1);
    Eigen::VectorXd forces;
    return assembler.residual(state, forces).energy;
  };
  const double coarse = press(2), middle = press(3), fine = press(5);
  EXPECT_GT(coarse, fine * (1 - 1e-3));
  EXPECT_NEAR(coarse, fine, 0.08 * fine); // the plates' edges are singular
  EXPECT_NEAR(middle, fine, 0.02 * fine);
}

/// In space, but held along z.
TEST(Tetrahedron, column_buckles_at_eulers_loads) {
  constexpr double slenderness = 0.05;
  test::expect_eulers_loads({drawn_out(test::strip(24, 2, 1, slenderness), {0, 0.05}), Dimension::spatial,
                             test::incompressible,
                             [](const Eigen::Vector3d& X, int c) {
                               if (c == 2) return true;
                               return c == 0 ? X.x() < 1e-9 || X.x() > 1 - 1e-9 : X.head<2>().norm() < 1e-9;
                             }},
                            std::pow(std::numbers::pi * slenderness, 2) / 12);
}

/// Of a straight tetrahedron, over its mass: 1/70 at corners, 8/105 at middles, and so on (quadratic shape
/// functions, integrated exactly).
TEST(Tetrahedron, mass_is_consistent) {
  double corners = 0, middles = 0, across = 0, opposite = 0, all = 0, apart = 0;
  std::array<double, 4> shares{};
  for (const TetrahedronMassPoint& at : tetrahedron_mass_rule()) {
    double volume = 0;
    for (std::size_t p = 0; p < 4; ++p) {
      volume += at.share[p] / 4;
      shares[p] += at.share[p];
    }
    corners += volume * at.shape[0] * at.shape[0];
    middles += volume * at.shape[4] * at.shape[4];
    across += volume * at.shape[0] * at.shape[1];
    opposite += volume * at.shape[0] * at.shape[5];
    all += volume * at.shape.sum() * at.shape.sum();
    apart += volume * at.shape[4] * at.shape[9]; // middles of sides that do not meet
  }
  EXPECT_NEAR(corners, 6 / 420.0, 1e-14);
  EXPECT_NEAR(middles, 32 / 420.0, 1e-14);
  EXPECT_NEAR(across, 1 / 420.0, 1e-14);
  EXPECT_NEAR(opposite, -6 / 420.0, 1e-14);
  EXPECT_NEAR(apart, 8 / 420.0, 1e-14);
  EXPECT_NEAR(all, 1, 1e-14);
  for (const double share : shares) EXPECT_NEAR(share, 1, 1e-14);
}

} // namespace
} // namespace dielast::fem::tetrahedron_test
