// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/dense_algebra.hpp"
#include "fem/elements/beam_block.hpp"
#include "fem/shells/shell_tables.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_shells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace dielast::fem::shell_element_test {
namespace {

using test::dome;
using test::flat_mesh;
using test::keep_spins;
using test::random_state;
using test::shell_model;
using test::two_layers;
using test::two_unstretched_layers;

TEST(Shell, residual_and_tangent_are_the_derivatives_of_the_energy) {
  for (const bool with_spins : {false, true}) {
    std::mt19937 random(21);
    for (const auto& [mesh, section] :
         {std::pair{flat_mesh(), two_layers()}, {dome(), two_unstretched_layers()}}) {
      const auto model = shell_model(mesh, section, with_spins);
      test::expect_consistent_derivatives(*model, random_state(*model, mesh, random), 0.1);
    }
  }
  // Elements whose nodes are of both kinds.
  const meshing::Mesh mesh = flat_mesh();
  const std::vector<int> charged(8, 0), not_charged(8, passive);
  const auto model = test::unnumbered_model(
      mesh.node_count(), false, make_shell_block(mesh, mesh.blocks[0], two_layers(), {charged, not_charged}));
  for (int n = 0; n < mesh.node_count(); n += 2) model->dofs.keep_spins(n);
  model->dofs.number();
  std::mt19937 random(21);
  test::expect_consistent_derivatives(*model, random_state(*model, mesh, random), 0.1);
}

TEST(Shell, nodes_tilt_but_where_it_is_folded_or_a_beam_meets_it) {
  meshing::Mesh mesh = test::distorted_square(2, 2);
  const auto kinds = [&](std::unique_ptr<ElementBlock> beam = nullptr) {
    auto model = test::unnumbered_model(
        mesh.node_count(), false,
        make_shell_block(mesh, mesh.blocks[0], {{{test::vhb().material, 0.05}}}, {std::vector<int>(8, 0)}));
    if (beam) {
      model->blocks.push_back(std::move(beam));
      model->blocks.back()->claim_dofs(model->dofs, Dimension::spatial);
    }
    model->dofs.number();
    return model;
  };
  const auto flat = kinds();
  EXPECT_EQ(flat->dofs.count(), 5 * mesh.node_count());
  const auto cell = mesh.blocks[0].cell(2);
  const std::set<int> on_beam{cell[0], cell[1], cell[3]};
  const auto stiffened = kinds(
      make_beam_block(mesh, {meshing::CellType::line3, {cell[0], cell[1], cell[3]}}, test::uneven_section()));
  for (int n = 0; n < mesh.node_count(); ++n) EXPECT_EQ(stiffened->dofs.tilts(n), !on_beam.contains(n));
  const Eigen::Quaterniond turn = rotation_of({0.7, -0.4, 0.2}); // flat film lies in any plane
  for (auto& x : mesh.nodes) x = turn * x + Eigen::Vector3d(30, 20, -10);
  EXPECT_EQ(kinds()->dofs.count(), 5 * mesh.node_count());
  const auto drawn = mesh.nodes;
  // The first triangle, turned about one of its sides, takes its neighbours' nodes along.
  const auto one = mesh.blocks[0].cell(0);
  const auto at = [&](int n) { return drawn[static_cast<std::size_t>(n)]; };
  const Eigen::Vector3d side = at(one[1]) - at(one[0]);
  for (const int n : {one[2], one[4], one[5]})
    mesh.nodes[static_cast<std::size_t>(n)] +=
        0.3 * side.cross(at(n) - at(one[0])).norm() * (turn * Eigen::Vector3d::UnitZ());
  const auto folded = kinds();
  int tilting = 0;
  for (int n = 0; n < mesh.node_count(); ++n) {
    int elements = 0;
    for (int e = 0; e < mesh.blocks[0].size(); ++e)
      elements += std::ranges::count(mesh.blocks[0].cell(e), n) > 0;
    if (std::ranges::count(one, n) > 0) {
      EXPECT_EQ(folded->dofs.tilts(n), elements == 1) << n;
    }
    tilting += folded->dofs.tilts(n);
  }
  EXPECT_GT(tilting, 0);
}

// Stretches along the sides and linear metrics are kept as they are, and so is the shear of a rigid plate.
TEST(ShellTables, reproduce_linear_fields) {
  const Eigen::Matrix<double, 3, 2> slope{{1.2, 0.3}, {-0.2, 0.8}, {0.5, 0.1}};
  const Eigen::Vector3d director(0.3, -0.4, 0.8);
  const std::array<Eigen::Vector2d, 6> place{{{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}};
  for (const ShellTables::Point& table : shell_tables().point) {
    Eigen::Vector3d metric = Eigen::Vector3d::Zero();
    Eigen::Vector2d shear = Eigen::Vector2d::Zero();
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b) {
        for (std::size_t c = 0; c < 3; ++c)
          metric[static_cast<Eigen::Index>(c)] +=
              table.metric[c][a][b] * (slope * place[a]).dot(slope * place[b]);
        for (std::size_t c = 0; c < 2; ++c)
          shear[static_cast<Eigen::Index>(c)] += table.shear[c][a][b] * (slope * place[a]).dot(director);
      }
    const Eigen::Matrix2d expected = slope.transpose() * slope;
    EXPECT_NEAR(metric[0], expected(0, 0), 1e-13);
    EXPECT_NEAR(metric[1], expected(1, 1), 1e-13);
    EXPECT_NEAR(metric[2], expected(0, 1), 1e-13);
    EXPECT_LT((shear - slope.transpose() * director).norm(), 1e-13);
  }
}

TEST(Shell, charges_are_the_slopes_of_the_energy_and_its_parts_add_up) {
  const meshing::Mesh mesh = flat_mesh();
  ShellSection section = two_layers();
  section.layers[1].material.branches.clear();
  const auto model = shell_model(mesh, section);
  std::mt19937 random(8);
  const State state = random_state(*model, mesh, random);
  Assembler assembler(*model, 1);
  Eigen::VectorXd here, there;
  const double energy = assembler.residual(state, here).energy;
  const Charges charges = model->charges(state, true);
  State other = state;
  const double step = 1e-3 * state.voltage[0];
  other.voltage[0] += step; // the energy and the forces are quadratic in the voltage
  const double slope = (assembler.residual(other, there).energy - energy) / step;
  EXPECT_NEAR(-slope, charges.charge[0] + charges.capacitance[0] * step / 2, 1e-9 * charges.charge[0]);
  const Eigen::VectorXd coupling = (here - there) / (step * (1 + step / (2 * state.voltage[0])));
  EXPECT_LT((coupling - charges.coupling[0]).norm(), 1e-8 * coupling.norm());
  EXPECT_NEAR(charges.charge[0], charges.capacitance[0] * state.voltage[0], 1e-12 * charges.charge[0]);
  const EnergyParts parts = model->energies(state);
  EXPECT_NEAR(parts.elastic - parts.electric, energy, 1e-12 * parts.elastic);
}

// 1/2 int rho |w x (x, y, Z)|^2 of rigid rotations about the origin, the layers' mass in its centre, and of
// translations. The nodes tilt, for all that they carry.
TEST(Shell, has_the_mass_of_its_layers_where_their_centre_is) {
  meshing::Mesh mesh = test::distorted_square(2, 2);
  const int drawn = mesh.node_count();
  const ShellSection section = two_layers();
  const auto model = test::shell_with_mass(mesh, section);
  const double lower = 0.05 / (1.5 * 1.1), upper = 0.1 / (1.2 * 0.9), mass = 960 * (lower + upper);
  const double lever = 0.02 / (1.2 * 0.9); // all have one density
  EXPECT_NEAR(ShellMass::of(section).per_area, mass, 1e-12 * mass);
  EXPECT_NEAR(ShellMass::of(section).lever, lever, 1e-15);
  ShellSection rounded = section;
  rounded.offset = 1e-8;
  EXPECT_EQ(ShellMass::of(rounded).lever, 0);
  const Eigen::SparseMatrix<double> J = model->dofs.jacobian(model->initial_state());
  const Eigen::SparseMatrix<double> M = J.transpose() * model->inertia().mass * J;
  const auto energy = [&](const Eigen::Vector3d& v, const Eigen::Vector3d& w) {
    Eigen::VectorXd velocity = Eigen::VectorXd::Zero(model->dofs.free_count());
    for (int n = 0; n < drawn; ++n) {
      EXPECT_TRUE(model->dofs.tilts(n));
      const auto at = static_cast<std::size_t>(n);
      for (int c = 0; c < 3; ++c) velocity[model->dofs.equation(n, c)] = (v + w.cross(mesh.nodes[at]))[c];
      for (int k = 0; k < 2; ++k)
        velocity[model->dofs.equation(n, DofMap::tilt + k)] = w.dot(model->dofs.tilt_axes()->at(at).col(k));
    }
    return velocity.dot(M * velocity) / 2;
  };
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(energy(Eigen::Vector3d::Unit(c), none), mass / 2, 1e-12 * mass);
  const Eigen::Vector3d w(0.7, -0.4, 0.5);
  Eigen::Matrix3d second; // moments of the unit square at height `lever`
  second << 1.0 / 3, 1.0 / 4, lever / 2, 1.0 / 4, 1.0 / 3, lever / 2, lever / 2, lever / 2, lever * lever;
  const double expected = mass / 2 * (w.squaredNorm() * second.trace() - w.dot(second * w));
  EXPECT_NEAR(energy(none, w), expected, 1e-12 * expected);
}

TEST(Shell, refuses_what_it_cannot_be) {
  const auto make = [](const meshing::Mesh& mesh, const ShellSection& section, std::size_t layers = 2) {
    const std::vector<int> none(static_cast<std::size_t>(mesh.blocks[0].size()), passive);
    return make_shell_block(mesh, mesh.blocks[0], section, std::vector(layers, none));
  };
  EXPECT_NO_THROW(make(flat_mesh(), two_layers()));
  EXPECT_THROW(make(test::distorted_square(2, 1), two_layers()), std::invalid_argument); // 3 nodes
  EXPECT_THROW(make(flat_mesh(), two_layers(), 1), std::invalid_argument);
  EXPECT_NO_THROW(make(dome(), two_unstretched_layers()));
  for (const bool of_a_layer : {false, true}) { // prestretched, and not flat
    ShellSection stretched = two_unstretched_layers();
    (of_a_layer ? stretched.layers[1].prestretch.emplace() : stretched.prestretch) = {1.1, 1};
    EXPECT_THROW(make(dome(), stretched), std::invalid_argument);
  }
  meshing::Mesh turned = flat_mesh();
  for (auto& x : turned.nodes) x.x() *= -1;
  EXPECT_THROW(make(turned, two_layers()), std::invalid_argument);
}

TEST(Shell, rigid_motion_makes_no_stress_and_keeps_the_energy_of_a_deformed_one) {
  const meshing::Mesh mesh = dome();
  const ShellSection section = two_unstretched_layers();
  for (const bool with_spins : {false, true}) {
    const auto model = shell_model(mesh, section, with_spins);
    Assembler assembler(*model, 1);
    Eigen::VectorXd here, there;
    const Eigen::Quaterniond Q = rotation_of({2, 1, -1.5});
    const State at_rest = model->initial_state();
    assembler.tangent(at_rest);
    const double stiffness = test::dense(assembler.matrix()).norm();
    assembler.residual(test::moved(at_rest, mesh, Q, {3, 4, 5}), here);
    EXPECT_LT(here.norm(), 1e-12 * stiffness);

    std::mt19937 random(4);
    const State state = random_state(*model, mesh, random);
    const State moved = test::moved(state, mesh, Q, {3, 4, 5});
    const double energy = assembler.residual(state, here).energy;
    EXPECT_NEAR(assembler.residual(moved, there).energy, energy, 1e-12 * std::abs(energy));
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
    for (int a = 0; a < mesh.node_count(); ++a) {
      Eigen::Vector3d f, g;
      for (int c = 0; c < 3; ++c) {
        f[c] = here[model->dofs.equation(a, c)];
        g[c] = there[model->dofs.equation(a, c)];
      }
      const Eigen::Vector3d m = model->dofs.spin(state, a, here);
      EXPECT_LT((g - Q * f).norm(), 1e-12 * here.norm());
      const auto n = static_cast<std::size_t>(a);
      force += f;
      moment += m + (mesh.nodes[n] + state.displacement[n]).cross(f);
    }
    EXPECT_LT(force.norm(), 1e-12 * here.norm());
    EXPECT_LT(moment.norm(), 1e-12 * here.norm());
  }
}

TEST(Shell, one_element_has_the_six_rigid_motions_and_no_other_modes_without_energy) {
  meshing::Mesh mesh = dome();
  mesh.blocks[0].nodes.resize(6);
  for (const bool with_spins : {false, true}) {
    const auto model = test::unnumbered_model(
        mesh.node_count(), false,
        make_shell_block(mesh, mesh.blocks[0], {{{test::vhb().material, 0.2}}}, {{0}}));
    if (with_spins) keep_spins(*model);
    model->dofs.number();
    Assembler assembler(*model, 1);
    assembler.tangent(model->initial_state());
    const Eigen::VectorXd values = symmetric_eigen(test::dense(assembler.matrix())).values;
    ASSERT_EQ(values.size(), with_spins ? 36 : 30);
    const double largest = values[values.size() - 1];
    EXPECT_LT(std::abs(values[5]), 1e-12 * largest);
    EXPECT_GT(values[6], 1e-6 * largest);
  }
}

} // namespace
} // namespace dielast::fem::shell_element_test
