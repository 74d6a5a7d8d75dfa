// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What tests ask of solids of triangles and of tetrahedra alike.

#include "fem/equilibrium/equilibrium.hpp"
#include "fem/solids/solid_block.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace dielast::fem::test {

constexpr double incompressible = std::numeric_limits<double>::infinity();
constexpr double solid_mu = 45e3;   ///< of vhb(), Pa
constexpr double solid_width = 0.7; ///< in plane strain, m

inline SolidSection solid_section(double bulk_modulus = incompressible) {
  return {.material = vhb().material, .bulk_modulus = bulk_modulus, .width = solid_width, .thickness = 0.2};
}

/// Incompressible, viscoelastic and nearly incompressible, of a compressible law.
inline std::vector<SolidSection> various_sections() {
  SolidSection viscoelastic = solid_section(1e6);
  viscoelastic.material.branches = {{materials::Gent{20e3, 80}, materials::Dashpot::log, 20e3 * 7}};
  SolidSection compressible = solid_section();
  compressible.material.law = materials::StVenantKirchhoff{1e5, 0.3};
  return {solid_section(), viscoelastic, compressible};
}

/// Some elements passive; of several materials where there are several. With the potential as unknown, the
/// electrode is at the node 0 and the ground at the node 3.
inline std::unique_ptr<Model> solid_model(const meshing::Mesh& mesh,
                                          const std::vector<SolidSection>& sections, bool potential,
                                          Dimension dimension) {
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
  return free_model(mesh.node_count(), dimension,
                    make_solid_block(mesh, std::move(cells), sections, std::move(potentials), dimension));
}

/// Stretched and shaken, with random pressures and potentials, under voltage.
inline State random_solid_state(const Model& model, const meshing::Mesh& mesh, Dimension dimension) {
  std::mt19937 random(21);
  State state = model.initial_state();
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    state.displacement[a] = 0.15 * mesh.nodes[a] + random_vector(random, 3, 0.02);
    if (dimension != Dimension::spatial)
      state.displacement[a][dimension == Dimension::axisymmetric ? 1 : 2] = 0;
  }
  for (double& scalar : state.scalar) scalar = 2e4 * std::uniform_real_distribution<double>(-1, 1)(random);
  state.voltage = {2e4};
  state.scheme = materials::TimeScheme::backward_euler(0.3);
  return state;
}

/// Charges are minus the derivatives of the energy in the voltage, and theirs those of the charge.
inline void expect_charges_are_derivatives(const Model& model, const State& state) {
  Assembler assembler(model, 1);
  Eigen::VectorXd up, down;
  constexpr double step = 10;
  State more = state, less = state;
  more.voltage[0] += step;
  less.voltage[0] -= step;
  const double change = assembler.residual(more, up).energy - assembler.residual(less, down).energy;
  const Charges charges = model.charges(state, true);
  EXPECT_NEAR(charges.charge[0], -change / (2 * step), 1e-7 * std::abs(charges.charge[0]));
  EXPECT_NEAR(charges.capacitance[0],
              (model.charges(more, false).charge[0] - model.charges(less, false).charge[0]) / (2 * step),
              1e-9 * charges.capacitance[0]);
  const Eigen::VectorXd coupling = -(up - down) / (2 * step);
  EXPECT_LT((charges.coupling[0] - coupling).norm(), 1e-7 * coupling.norm());
}

/// The energy of a moved state is the same number, and its forces turn with it.
inline void expect_rigid_motion_changes_nothing(const Model& model, const meshing::Mesh& mesh,
                                                const State& state, const Eigen::Quaterniond& Q,
                                                const Eigen::Vector3d& shift) {
  Assembler assembler(model, 1);
  Eigen::VectorXd before, after;
  const double energy = assembler.residual(state, before).energy;
  EXPECT_NEAR(assembler.residual(moved(state, mesh, Q, shift), after).energy, energy,
              1e-12 * std::abs(energy));
  const int directions = model.dofs.equation(0, 2) == DofMap::absent ? 2 : 3;
  Eigen::VectorXd expected = before;
  for (int n = 0; n < mesh.node_count(); ++n) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (int c = 0; c < directions; ++c) force[c] = before[model.dofs.equation(n, c)];
    force = Q * force;
    for (int c = 0; c < directions; ++c) expected[model.dofs.equation(n, c)] = force[c];
  }
  EXPECT_LT((after - expected).norm(), 1e-12 * before.norm());
}

/// One neo-Hookean section under no electrode, with what is held.
struct HeldSolid {
  using IsHeld = std::function<bool(const Eigen::Vector3d& X, int direction)>;

  HeldSolid(meshing::Mesh drawn, Dimension dimension, double bulk_modulus, IsHeld is_held, double size = 1)
      : mesh(std::move(drawn)), held(std::move(is_held)),
        directions(dimension == Dimension::spatial ? 3 : 2) {
    const auto count = static_cast<std::size_t>(mesh.blocks[0].size());
    SolidCells cells{mesh.blocks[0], std::vector<int>(count, passive), std::vector<int>(count, 0)};
    model = unnumbered_model(
        mesh.node_count(), dimension,
        make_solid_block(mesh, std::move(cells), {solid_section(bulk_modulus)}, {}, dimension));
    for (int n = 0; n < mesh.node_count(); ++n)
      for (int c = 0; c < directions; ++c)
        if (held(mesh.nodes[static_cast<std::size_t>(n)], c)) model->dofs.hold(n, c);
    model->dofs.number();
    model->extent = size;
    model->length_scale = 0.1 * size;
  }

  /// The equilibrium that is found from F with what is free shaken: stable, and F again.
  State expect_finds_its_way_back(const Eigen::Matrix3d& F) const {
    const State exact = homogeneous(*model, mesh, F);
    State state = exact;
    std::mt19937 random(3);
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      for (int c = 0; c < directions; ++c)
        if (!held(mesh.nodes[n], c)) state.displacement[n][c] += random_vector(random, 1, 0.01)[0];
    Equilibrium equilibrium(*model, 1);
    const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-11});
    EXPECT_EQ(result.outcome, Outcome::converged);
    EXPECT_EQ(result.unstable_modes, 0);
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      EXPECT_LT((state.displacement[n] - exact.displacement[n]).norm(), 1e-11);
    return state;
  }

  meshing::Mesh mesh;
  std::unique_ptr<Model> model;
  IsHeld held;
  int directions;
};

/// A column along x, homogeneously shortened by parts of Euler's first strain: multipliers bring negative
/// eigenvalues, but no unstable modes.
inline void expect_eulers_loads(const HeldSolid& column, double first_strain) {
  Equilibrium equilibrium(*column.model, 1);
  for (const auto& [part, unstable] : {std::pair{0.95, 0}, {1.05, 1}, {3.8, 1}, {4.2, 2}}) {
    const double stretch = 1 - part * first_strain, square = 1 / (stretch * stretch);
    const Eigen::Vector3d F(stretch, 1 / stretch, 1);
    State state = homogeneous(*column.model, column.mesh, F.asDiagonal());
    state.scalar.assign(state.scalar.size(), solid_mu * (square - (stretch * stretch + square + 1) / 3));
    Balance balance;
    equilibrium.balance(state, balance);
    EXPECT_LT(balance.norm, 1e-10 * balance.scale);
    ASSERT_TRUE(equilibrium.factor(state));
    EXPECT_EQ(equilibrium.tangent().unstable_modes(), unstable) << part;
  }
}

/// The share of a node in a load spread evenly over a side of 6-node elements' edges; `place` along it, 0..1.
inline double simpson_share(double place, int edges) {
  place *= edges;
  const bool middle = std::abs(place - std::round(place)) > 0.25, end = place < 0.1 || place > edges - 0.1;
  return (middle ? 4.0 : end ? 1.0 : 2.0) / 6 / edges;
}

/// Cook's membrane of a unit square, clamped at x = 0.
inline meshing::Mesh cooks(meshing::Mesh square) {
  for (auto& x : square.nodes) {
    const double s = x.x(), t = x.y();
    x = {0.048 * s, (1 - s) * 0.044 * t + s * (0.044 + 0.016 * t), x.z()};
  }
  return square;
}

/// Deflection of its upper corner at z = 0 under a uniform shear of 2.5 kPa; `share` of a node in it.
inline double cooks_deflection(const HeldSolid& cook, double width,
                               const std::function<double(const Eigen::Vector3d& X)>& share) {
  State state = cook.model->initial_state();
  double whole = 0;
  std::size_t corner = 0;
  for (std::size_t k = 0; k < cook.mesh.nodes.size(); ++k) {
    const Eigen::Vector3d& X = cook.mesh.nodes[k];
    if (X.x() < 0.048 - 1e-9) continue;
    whole += share(X);
    state.dead_force[cook.model->dofs.equation(static_cast<int>(k), 1)] = 2500 * 0.016 * width * share(X);
    if (X.y() > 0.06 - 1e-9 && X.z() < 1e-9) corner = k;
  }
  EXPECT_NEAR(whole, 1, 1e-12);
  Equilibrium equilibrium(*cook.model, 1);
  const NewtonResult result = equilibrium.solve(state, {});
  EXPECT_EQ(result.outcome, Outcome::converged);
  EXPECT_EQ(result.unstable_modes, 0);
  return state.displacement[corner].y();
}

} // namespace dielast::fem::test
