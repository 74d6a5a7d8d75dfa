// SPDX-License-Identifier: GPL-3.0-or-later
// Solids of 10-node tetrahedra: what solid_element_test.cpp asks of triangles.
#include "fem/equilibrium/equilibrium.hpp"
#include "fem/solids/solid_block.hpp"
#include "fem/solids/tetrahedron.hpp"
#include "meshing/solids/extruded.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace dielast::fem {
namespace {

constexpr double incompressible = std::numeric_limits<double>::infinity(), mu = 45e3;

SolidSection vhb(double bulk_modulus = incompressible) {
  return {.material = test::vhb().material, .bulk_modulus = bulk_modulus, .thickness = 0.2};
}

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

/// As solid_element_test.cpp has it: some elements passive, of several materials.
std::unique_ptr<Model> solid_model(const meshing::Mesh& mesh, const std::vector<SolidSection>& sections,
                                   bool potential) {
  SolidCells cells{mesh.blocks[0], {}, {}};
  for (int e = 0; e < cells.elements.size(); ++e) {
    cells.electrodes.push_back(e % 3 == 0 ? passive : 0);
    cells.sections.push_back(e % static_cast<int>(sections.size()));
  }
  std::vector<int> potentials;
  if (potential) {
    potentials.assign(mesh.nodes.size(), NodePotential::follows);
    potentials[0] = 0;
    potentials[3] = NodePotential::ground;
  }
  return test::free_model(
      mesh.node_count(), Dimension::spatial,
      make_solid_block(mesh, std::move(cells), sections, std::move(potentials), Dimension::spatial));
}

State random_state(const Model& model, const meshing::Mesh& mesh) {
  std::mt19937 random(21);
  State state = model.initial_state();
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    state.displacement[a] = 0.15 * mesh.nodes[a] + test::random_vector(random, 3, 0.02);
  for (double& scalar : state.scalar) scalar = 2e4 * std::uniform_real_distribution<double>(-1, 1)(random);
  state.voltage = {2e4};
  state.scheme = materials::TimeScheme::backward_euler(0.3);
  return state;
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
  SolidSection viscoelastic = vhb(1e6);
  viscoelastic.material.branches = {{materials::Gent{20e3, 80}, materials::Dashpot::log, 20e3 * 7}};
  SolidSection compressible = vhb();
  compressible.material.law = materials::StVenantKirchhoff{1e5, 0.3};
  SolidSection ogden = vhb();
  ogden.material.law = materials::Ogden{{4e4, 1e4}, {1.3, 5.0}};
  ogden.normal = Eigen::Vector3d(1, 2, 2) / 3;
  const meshing::Mesh mesh = curved_cube();
  for (const bool potential : {false, true}) {
    const auto model = solid_model(mesh, {vhb(), viscoelastic, compressible, ogden}, potential);
    test::expect_consistent_derivatives(*model, random_state(*model, mesh), 0.1, 1e-8);
  }
}

TEST(Tetrahedron, charges_are_the_derivatives_of_the_energy) {
  const meshing::Mesh mesh = curved_cube();
  for (const bool potential : {false, true}) {
    const auto model = solid_model(mesh, {vhb()}, potential);
    const State state = random_state(*model, mesh);
    Assembler assembler(*model, 1);
    Eigen::VectorXd up, down;
    constexpr double step = 10;
    State more = state, less = state;
    more.voltage[0] += step;
    less.voltage[0] -= step;
    const double change = assembler.residual(more, up).energy - assembler.residual(less, down).energy;
    const Charges charges = model->charges(state, true);
    EXPECT_NEAR(charges.charge[0], -change / (2 * step), 1e-7 * std::abs(charges.charge[0]));
    EXPECT_NEAR(charges.capacitance[0],
                (model->charges(more, false).charge[0] - model->charges(less, false).charge[0]) / (2 * step),
                1e-9 * charges.capacitance[0]);
    const Eigen::VectorXd coupling = -(up - down) / (2 * step);
    EXPECT_LT((charges.coupling[0] - coupling).norm(), 1e-7 * coupling.norm());
  }
}

TEST(Tetrahedron, rigid_motions_change_nothing) {
  const meshing::Mesh mesh = curved_cube();
  const auto model = solid_model(mesh, {vhb()}, true);
  const State state = random_state(*model, mesh);
  const Eigen::Quaterniond Q(Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 2, -1).normalized()));
  const State turned = test::moved(state, mesh, Q, {3, -2, 1});
  Assembler assembler(*model, 1);
  Eigen::VectorXd before, after;
  const double energy = assembler.residual(state, before).energy;
  EXPECT_NEAR(assembler.residual(turned, after).energy, energy, 1e-12 * std::abs(energy));
  Eigen::VectorXd expected = before;
  for (int n = 0; n < mesh.node_count(); ++n) {
    Eigen::Vector3d force;
    for (int c = 0; c < 3; ++c) force[c] = before[model->dofs.equation(n, c)];
    force = Q * force;
    for (int c = 0; c < 3; ++c) expected[model->dofs.equation(n, c)] = force[c];
  }
  EXPECT_LT((after - expected).norm(), 1e-12 * before.norm());
}

/// Without layers the axes do not matter; a model of the plane takes no tetrahedra.
TEST(Tetrahedron, is_in_space_only) {
  const meshing::Mesh mesh = distorted_cube(1, 0);
  const std::size_t count = static_cast<std::size_t>(mesh.blocks[0].size());
  const SolidCells cells{mesh.blocks[0], std::vector<int>(count, passive), std::vector<int>(count, 0)};
  EXPECT_THROW(make_solid_block(mesh, cells, {vhb()}, {}, Dimension::planar), std::invalid_argument);
  meshing::Mesh inverted = mesh;
  for (auto& x : inverted.nodes) x.z() = -x.z();
  EXPECT_THROW(make_solid_block(inverted, cells, {vhb()}, {}, Dimension::spatial), std::invalid_argument);
}

struct Held {
  meshing::Mesh mesh;
  std::unique_ptr<Model> model;
  Held(meshing::Mesh drawn, double bulk_modulus, const std::function<bool(const Eigen::Vector3d&, int)>& held,
       double size = 1)
      : mesh(std::move(drawn)) {
    const auto count = static_cast<std::size_t>(mesh.blocks[0].size());
    SolidCells cells{mesh.blocks[0], std::vector<int>(count, passive), std::vector<int>(count, 0)};
    model = test::unnumbered_model(
        mesh.node_count(), Dimension::spatial,
        make_solid_block(mesh, std::move(cells), {vhb(bulk_modulus)}, {}, Dimension::spatial));
    for (int n = 0; n < mesh.node_count(); ++n)
      for (const int c : {0, 1, 2})
        if (held(mesh.nodes[static_cast<std::size_t>(n)], c)) model->dofs.hold(n, c);
    model->dofs.number();
    model->extent = size;
    model->length_scale = 0.1 * size;
  }
};

TEST(Tetrahedron, distorted_patch_deforms_homogeneously) {
  for (const double bulk_modulus : {1e6, 1e9}) {
    const auto on_face = [](const Eigen::Vector3d& X, int) {
      return X.minCoeff() < 1e-9 || X.maxCoeff() > 1 - 1e-9;
    };
    Held patch(distorted_cube(3), bulk_modulus, on_face);
    Eigen::Matrix3d F;
    F << 1.4, 0.3, 0.1, 0, 0.9, -0.2, 0, 0, 1 / (1.4 * 0.9);
    F *= std::cbrt(1 + 1e3 / bulk_modulus);
    const State exact = test::homogeneous(*patch.model, patch.mesh, F);
    State state = exact;
    std::mt19937 random(3);
    for (std::size_t n = 0; n < patch.mesh.nodes.size(); ++n)
      if (!on_face(patch.mesh.nodes[n], 0)) state.displacement[n] += test::random_vector(random, 3, 0.01);
    Equilibrium equilibrium(*patch.model, 1);
    const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-11});
    ASSERT_EQ(result.outcome, Outcome::converged);
    EXPECT_EQ(result.unstable_modes, 0);
    for (std::size_t n = 0; n < patch.mesh.nodes.size(); ++n)
      EXPECT_LT((state.displacement[n] - exact.displacement[n]).norm(), 1e-11);
    const double pressure = -bulk_modulus * (F.determinant() - 1);
    for (const double p : state.scalar) EXPECT_NEAR(p, pressure, 1e-7 * std::abs(pressure));
  }
}

/// Pulled along x with free sides: the stress across them vanishes, which gives the pressure.
TEST(Tetrahedron, incompressible_patch_finds_its_pressure) {
  const auto held = [](const Eigen::Vector3d& X, int c) {
    return c == 0 ? X.x() < 1e-9 || X.x() > 1 - 1e-9 : X[c] < 1e-9;
  };
  Held patch(distorted_cube(3), incompressible, held);
  constexpr double stretch = 1.4;
  const Eigen::Vector3d F(stretch, 1 / std::sqrt(stretch), 1 / std::sqrt(stretch));
  const State exact = test::homogeneous(*patch.model, patch.mesh, F.asDiagonal());
  State state = exact;
  std::mt19937 random(3);
  for (std::size_t n = 0; n < patch.mesh.nodes.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (!held(patch.mesh.nodes[n], c)) state.displacement[n][c] += test::random_vector(random, 1, 0.01)[0];
  Equilibrium equilibrium(*patch.model, 1);
  const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-11});
  ASSERT_EQ(result.outcome, Outcome::converged);
  EXPECT_EQ(result.unstable_modes, 0);
  for (std::size_t n = 0; n < patch.mesh.nodes.size(); ++n)
    EXPECT_LT((state.displacement[n] - exact.displacement[n]).norm(), 1e-11);
  const double mean = (stretch * stretch + 2 / stretch) / 3;
  for (const double p : state.scalar) EXPECT_NEAR(p, mu * (1 / stretch - mean), 1e-7 * mu);
}

/// Cook's membrane, incompressible, 16 mm thick: a coarse mesh is as soft as a fine one.
TEST(Tetrahedron, cooks_membrane_does_not_lock) {
  const auto tip = [](int n) {
    std::vector<double> levels;
    for (int i = 0; i <= n / 2; ++i) levels.push_back(0.016 * 2 * i / n);
    meshing::Mesh mesh = drawn_out(test::distorted_square(n, 2, 1, 0), levels);
    for (auto& x : mesh.nodes) {
      const double s = x.x(), t = x.y();
      x = {0.048 * s, (1 - s) * 0.044 * t + s * (0.044 + 0.016 * t), x.z()};
    }
    Held cook(
        std::move(mesh), incompressible, [](const Eigen::Vector3d& X, int) { return X.x() < 1e-9; }, 0.06);
    State state = cook.model->initial_state();
    int last = 0;
    for (int k = 0; k < cook.mesh.node_count(); ++k) {
      const Eigen::Vector3d& X = cook.mesh.nodes[static_cast<std::size_t>(k)];
      if (X.x() < 0.048 - 1e-9) continue;
      // Simpson's weights along y and z: consistent where the side is of squares of six nodes.
      const auto share = [](double place, int parts) {
        place *= parts;
        const bool middle = std::abs(place - std::round(place)) > 0.25,
                   end = place < 0.1 || place > parts - 0.1;
        return (middle ? 4.0 : end ? 1.0 : 2.0) / 6 / parts;
      };
      state.dead_force[cook.model->dofs.equation(k, 1)] =
          2500 * 0.016 * 0.016 * share((X.y() - 0.044) / 0.016, n) * share(X.z() / 0.016, n / 2);
      if (X.y() > 0.06 - 1e-9 && X.z() < 1e-9) last = k;
    }
    Equilibrium equilibrium(*cook.model, 1);
    const NewtonResult result = equilibrium.solve(state, {});
    EXPECT_EQ(result.outcome, Outcome::converged);
    EXPECT_EQ(result.unstable_modes, 0);
    return state.displacement[static_cast<std::size_t>(last)].y();
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
    Held block(distorted_cube(n, 0), incompressible, [](const Eigen::Vector3d& X, int c) {
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

/// See solid_element_test.cpp; in space, but held along z.
TEST(Tetrahedron, column_buckles_at_eulers_loads) {
  constexpr double slenderness = 0.05;
  const auto held = [](const Eigen::Vector3d& X, int c) {
    if (c == 2) return true;
    return c == 0 ? X.x() < 1e-9 || X.x() > 1 - 1e-9 : X.head<2>().norm() < 1e-9;
  };
  Held column(drawn_out(test::strip(24, 2, 1, slenderness), {0, 0.05}), incompressible, held);
  Equilibrium equilibrium(*column.model, 1);
  const double first = std::pow(std::numbers::pi * slenderness, 2) / 12; // strain
  for (const auto& [part, unstable] : {std::pair{0.95, 0}, {1.05, 1}, {3.8, 1}, {4.2, 2}}) {
    const double stretch = 1 - part * first, square = 1 / (stretch * stretch);
    const Eigen::Vector3d F(stretch, 1 / stretch, 1);
    State state = test::homogeneous(*column.model, column.mesh, F.asDiagonal());
    state.scalar.assign(state.scalar.size(), mu * (square - (stretch * stretch + square + 1) / 3));
    Balance balance;
    equilibrium.balance(state, balance);
    EXPECT_LT(balance.norm, 1e-10 * balance.scale);
    ASSERT_TRUE(equilibrium.factor(state));
    EXPECT_EQ(equilibrium.tangent().unstable_modes(), unstable) << part;
  }
}

} // namespace
} // namespace dielast::fem
