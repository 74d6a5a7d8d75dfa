// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"
#include "fem/solids/solid_block.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace dielast::fem {
namespace {

constexpr double incompressible = std::numeric_limits<double>::infinity();

SolidSection vhb(double bulk_modulus = incompressible) {
  return {.material = test::vhb().material, .bulk_modulus = bulk_modulus, .width = 0.7, .thickness = 0.2};
}

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

/// Some elements passive; of two materials where there are two. With the potential as unknown, the electrode
/// is at the node 0 and the ground at the node 3.
std::unique_ptr<Model> solid_model(const meshing::Mesh& mesh, const std::vector<SolidSection>& sections,
                                   bool potential, Dimension dimension) {
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
      mesh.node_count(), dimension,
      make_solid_block(mesh, std::move(cells), sections, std::move(potentials), dimension));
}

/// Stretched and shaken, with random pressures and potentials, under voltage.
State random_state(const Model& model, const meshing::Mesh& mesh, Dimension dimension) {
  std::mt19937 random(21);
  State state = model.initial_state();
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    const Eigen::Vector3d& X = mesh.nodes[a];
    state.displacement[a] = 0.15 * X + test::random_vector(random, 3, 0.02);
    state.displacement[a][dimension == Dimension::axisymmetric ? 1 : 2] = 0;
  }
  for (double& scalar : state.scalar) scalar = 2e4 * std::uniform_real_distribution<double>(-1, 1)(random);
  state.voltage = {2e4};
  state.scheme = materials::TimeScheme::backward_euler(0.3);
  return state;
}

TEST(Solid, residual_and_tangent_are_the_derivatives_of_the_energy) {
  SolidSection viscoelastic = vhb(1e6);
  viscoelastic.material.branches = {{materials::Gent{20e3, 80}, materials::Dashpot::log, 20e3 * 7}};
  SolidSection compressible = vhb();
  compressible.material.law = materials::StVenantKirchhoff{1e5, 0.3};
  for (const Dimension dimension : {Dimension::planar, Dimension::axisymmetric})
    for (const bool potential : {false, true}) {
      const meshing::Mesh mesh = curved_mesh(dimension);
      const auto model = solid_model(mesh, {vhb(), viscoelastic, compressible}, potential, dimension);
      test::expect_consistent_derivatives(*model, random_state(*model, mesh, dimension), 0.1, 1e-8);
    }
}

/// Charges are minus the derivatives of the energy in the voltage, and theirs those of the charge.
TEST(Solid, charges_are_the_derivatives_of_the_energy) {
  for (const Dimension dimension : {Dimension::planar, Dimension::axisymmetric})
    for (const bool potential : {false, true}) {
      const meshing::Mesh mesh = curved_mesh(dimension);
      const auto model = solid_model(mesh, {vhb()}, potential, dimension);
      const State state = random_state(*model, mesh, dimension);
      Assembler assembler(*model, 1);
      Eigen::VectorXd up, down;
      constexpr double step = 10;
      State more = state, less = state;
      more.voltage[0] += step;
      less.voltage[0] -= step;
      const double change = assembler.residual(more, up).energy - assembler.residual(less, down).energy;
      const Charges charges = model->charges(state, true);
      const double Q = charges.charge[0];
      EXPECT_NEAR(Q, -change / (2 * step), 1e-7 * std::abs(Q));
      EXPECT_NEAR(charges.capacitance[0],
                  (model->charges(more, false).charge[0] - model->charges(less, false).charge[0]) /
                      (2 * step),
                  1e-9 * charges.capacitance[0]);
      const Eigen::VectorXd coupling = -(up - down) / (2 * step);
      EXPECT_LT((charges.coupling[0] - coupling).norm(), 1e-7 * coupling.norm());
    }
}

/// The capacitance with the potential in equilibrium is the charge that one volt brings.
TEST(Solid, capacitance_lets_the_potential_follow) {
  const meshing::Mesh mesh = curved_mesh(Dimension::planar);
  const auto model = solid_model(mesh, {vhb()}, true, Dimension::planar);
  State state = random_state(*model, mesh, Dimension::planar);
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
  const auto model = solid_model(mesh, {vhb()}, true, Dimension::planar);
  const State state = random_state(*model, mesh, Dimension::planar);
  const Eigen::Quaterniond Q(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ()));
  const State turned = test::moved(state, mesh, Q, {3, -2, 0});
  Assembler assembler(*model, 1);
  Eigen::VectorXd before, after;
  const double energy = assembler.residual(state, before).energy;
  EXPECT_NEAR(assembler.residual(turned, after).energy, energy, 1e-12 * std::abs(energy));
  Eigen::VectorXd expected = before;
  for (int n = 0; n < mesh.node_count(); ++n) {
    const int x = model->dofs.equation(n, 0), y = model->dofs.equation(n, 1);
    const Eigen::Vector3d force = Q * Eigen::Vector3d(before[x], before[y], 0);
    expected[x] = force.x();
    expected[y] = force.y();
  }
  EXPECT_LT((after - expected).norm(), 1e-12 * before.norm());
}

/// A model of one neo-Hookean section under no electrode, edges held where `held`.
struct Held {
  meshing::Mesh mesh;
  std::unique_ptr<Model> model;
  Held(meshing::Mesh drawn, double bulk_modulus, const std::function<bool(const Eigen::Vector3d&, int)>& held)
      : mesh(std::move(drawn)) {
    const auto count = static_cast<std::size_t>(mesh.blocks[0].size());
    SolidCells cells{mesh.blocks[0], std::vector<int>(count, passive), std::vector<int>(count, 0)};
    model = test::unnumbered_model(
        mesh.node_count(), Dimension::planar,
        make_solid_block(mesh, std::move(cells), {vhb(bulk_modulus)}, {}, Dimension::planar));
    for (int n = 0; n < mesh.node_count(); ++n)
      for (const int c : {0, 1})
        if (held(mesh.nodes[static_cast<std::size_t>(n)], c)) model->dofs.hold(n, c);
    model->dofs.number();
    model->extent = 1;
    model->length_scale = 0.1;
  }
};

/// Patch test: affine displacements of the edge give that deformation, and one pressure, everywhere.
TEST(Solid, distorted_patch_deforms_homogeneously) {
  for (const double bulk_modulus :
       {1e6, 1e9}) { // exactly incompressible and held all around, any pressure would do
    const auto on_edge = [](const Eigen::Vector3d& X, int) {
      return X.head<2>().minCoeff() < 1e-9 || X.head<2>().maxCoeff() > 1 - 1e-9;
    };
    Held patch(test::distorted_square(4, 2), bulk_modulus, on_edge);
    const double stretch = 1.4;
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F.topLeftCorner<2, 2>() << stretch, 0.3, 0, 1 / stretch;
    F(0, 0) *= 1 + 1e3 / bulk_modulus;
    const State exact = test::homogeneous(*patch.model, patch.mesh, F);
    State state = exact;
    std::mt19937 random(3);
    for (std::size_t n = 0; n < patch.mesh.nodes.size(); ++n)
      if (!on_edge(patch.mesh.nodes[n], 0))
        state.displacement[n].head<2>() += test::random_vector(random, 2, 0.01);
    Equilibrium equilibrium(*patch.model, 1);
    const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-11});
    ASSERT_EQ(result.outcome, Outcome::converged);
    EXPECT_EQ(result.unstable_modes, 0);
    for (std::size_t n = 0; n < patch.mesh.nodes.size(); ++n)
      EXPECT_LT((state.displacement[n] - exact.displacement[n]).norm(), 1e-11);
    const double pressure = -bulk_modulus * (F.determinant() - 1);
    for (const double p : state.scalar) EXPECT_NEAR(p, pressure, 1e-8 * std::abs(pressure));
  }
}

/// Exactly incompressible with one side free: the stress across it vanishes, which gives the pressure.
TEST(Solid, incompressible_patch_finds_its_pressure) {
  const auto held = [](const Eigen::Vector3d& X, int c) {
    return c == 0 ? X.x() < 1e-9 || X.x() > 1 - 1e-9 : X.y() < 1e-9;
  };
  Held patch(test::distorted_square(4, 2), incompressible, held);
  constexpr double stretch = 1.4, mu = 45e3;
  State state = patch.model->initial_state();
  std::mt19937 random(3);
  for (std::size_t n = 0; n < patch.mesh.nodes.size(); ++n) {
    const Eigen::Vector3d& X = patch.mesh.nodes[n];
    state.displacement[n] = {(stretch - 1) * X.x(), held(X, 1) ? 0 : (1 / stretch - 1) * X.y(), 0};
    if (!held(X, 0) && !held(X, 1)) state.displacement[n].head<2>() += test::random_vector(random, 2, 0.01);
  }
  Equilibrium equilibrium(*patch.model, 1);
  const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-11});
  ASSERT_EQ(result.outcome, Outcome::converged);
  EXPECT_EQ(result.unstable_modes, 0);
  for (std::size_t n = 0; n < patch.mesh.nodes.size(); ++n)
    EXPECT_NEAR(state.displacement[n].y(), (1 / stretch - 1) * patch.mesh.nodes[n].y(), 1e-11);
  const double square = 1 / (stretch * stretch), mean = (stretch * stretch + square + 1) / 3;
  for (const double p : state.scalar) EXPECT_NEAR(p, mu * (square - mean), 1e-7 * mu);
}

/// Cook's membrane, incompressible: a coarse mesh is as soft as a fine one.
TEST(Solid, cooks_membrane_does_not_lock) {
  const auto tip = [](int n) {
    meshing::Mesh mesh = test::distorted_square(n, 2, 1, 0);
    for (auto& x : mesh.nodes) {
      const double s = x.x(), t = x.y();
      x = {0.048 * s, (1 - s) * 0.044 * t + s * (0.044 + 0.016 * t), 0};
    }
    Held cook(std::move(mesh), incompressible, [](const Eigen::Vector3d& X, int) { return X.x() < 1e-9; });
    cook.model->extent = 0.06;
    cook.model->length_scale = 0.06 / n;
    State state = cook.model->initial_state();
    double length = 0;
    int last = 0;
    for (int k = 0; k < cook.mesh.node_count(); ++k) { // consistent with a uniform shear of 2.5 kPa
      const Eigen::Vector3d& X = cook.mesh.nodes[static_cast<std::size_t>(k)];
      if (X.x() < 0.048 - 1e-9) continue;
      const double place = (X.y() - 0.044) / 0.016 * n;
      const bool middle = std::abs(place - std::round(place)) > 0.25, end = place < 0.1 || place > n - 0.1;
      const double share = (middle ? 4.0 : end ? 1.0 : 2.0) / 6 / n;
      state.dead_force[cook.model->dofs.equation(k, 1)] = 2500 * 0.016 * 0.7 * share;
      length += share;
      if (X.y() > 0.06 - 1e-9) last = k;
    }
    EXPECT_NEAR(length, 1, 1e-12);
    Equilibrium equilibrium(*cook.model, 1);
    const NewtonResult result = equilibrium.solve(state, {});
    EXPECT_EQ(result.outcome, Outcome::converged);
    EXPECT_EQ(result.unstable_modes, 0);
    return state.displacement[static_cast<std::size_t>(last)].y();
  };
  const double coarse = tip(4), middle = tip(8), fine = tip(16);
  EXPECT_GT(fine, 0.003);
  EXPECT_NEAR(coarse, fine, 0.04 * fine); // the clamped corners are singular
  EXPECT_NEAR(middle, fine, 0.012 * fine);
}

/// A column between guided ends is unstable from Euler's loads on: multipliers bring negative eigenvalues,
/// but no unstable modes. Its straight state is homogeneous.
TEST(Solid, column_buckles_at_eulers_loads) {
  constexpr double slenderness = 0.05, mu = 45e3; // height over length
  const auto held = [](const Eigen::Vector3d& X, int c) {
    return c == 0 ? X.x() < 1e-9 || X.x() > 1 - 1e-9 : X.head<2>().norm() < 1e-9;
  };
  Held column(test::strip(24, 2, 1, slenderness), incompressible, held);
  Equilibrium equilibrium(*column.model, 1);
  const double first = std::pow(std::numbers::pi * slenderness, 2) / 12; // strain
  for (const auto& [part, unstable] : {std::pair{0.95, 0}, {1.05, 1}, {3.8, 1}, {4.2, 2}}) {
    const double stretch = 1 - part * first, square = 1 / (stretch * stretch);
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F(0, 0) = stretch;
    F(1, 1) = 1 / stretch;
    State state = test::homogeneous(*column.model, column.mesh, F);
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
