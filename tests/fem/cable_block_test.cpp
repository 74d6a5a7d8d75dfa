// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/cable_block.hpp"

#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace dielast::fem::cable_block_test {
namespace {

/// Three cables in space, straight or bent where they have a node between their ends.
meshing::Mesh net(meshing::CellType type, bool bent) {
  meshing::Mesh mesh{.nodes = {{0, 0, 0}, {1.1, 0.1, 0.2}, {0.2, 0.9, -0.1}},
                     .blocks = {{type, {0, 1, 1, 2, 2, 0}}},
                     .node_sets = {},
                     .cell_sets = {}};
  if (type == meshing::CellType::line2) return mesh;
  mesh.blocks[0].nodes = {0, 1, 3, 1, 2, 4, 2, 0, 5};
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 0}})
    mesh.nodes.emplace_back((mesh.nodes[a] + mesh.nodes[b]) / 2 +
                            (bent ? Eigen::Vector3d(0.05, -0.04, 0.1) : Eigen::Vector3d::Zero()));
  return mesh;
}

std::unique_ptr<Model> model_of(const meshing::Mesh& mesh, const CableSection& section, bool straight) {
  return test::free_model(mesh.node_count(), false,
                          make_cable_block(mesh, mesh.blocks[0], section, straight, {0, 1, 2}));
}

TEST(Cable, ResidualAndTangentAreTheDerivativesOfTheEnergy) {
  using meshing::CellType;
  for (const double crimp : {0.01, 5.0}) // straight fibres, and all of them on the way there
    for (const auto& [type, straight] :
         {std::pair{CellType::line2, false}, {CellType::line3, false}, {CellType::line3, true}}) {
      const meshing::Mesh mesh = net(type, !straight);
      const auto model = model_of(mesh, {2, crimp, 1.5, 0}, straight);
      std::mt19937 random(3);
      for (int sample = 0; sample < 3; ++sample) {
        State state = model->initial_state();
        for (auto& u : state.displacement) u = test::random_vector(random, 3, 0.05);
        test::expect_consistent_derivatives(*model, state, 0.1);
      }
    }
}

double energy(const Model& model, const State& state) {
  Eigen::VectorXd residual;
  return Assembler(model, 1).residual(state, residual).energy;
}

TEST(Cable, PullsByItsLawAndResistsNothingElse) {
  meshing::Mesh mesh = net(meshing::CellType::line2, false);
  mesh.nodes = {{0, 0, 0}, {3, 0, 4}, {100, 0, 0}};
  mesh.blocks[0].nodes = {0, 1};
  const CableSection section{200, 0.02, 1.25, 0}; // 4 m at rest
  const auto model = model_of(mesh, section, false);
  const auto pull_at = [&](double length) { // of the end, along the cable
    State state = model->initial_state();
    state.displacement[1] = (length / 5 - 1) * mesh.nodes[1];
    Eigen::VectorXd residual;
    Assembler(*model, 1).residual(state, residual);
    const Eigen::Vector3d force(residual[model->dofs.equation(1, 0)], residual[model->dofs.equation(1, 1)],
                                residual[model->dofs.equation(1, 2)]);
    EXPECT_NEAR(force.dot(mesh.nodes[1]) / 5, force.norm(), 1e-13 * 200);
    return force.norm();
  };
  EXPECT_NEAR(pull_at(5), 200 * (0.25 - 0.01), 1e-11);
  EXPECT_NEAR(pull_at(4.04), 200 * 0.01 * 0.01 / 0.04, 1e-11);
  EXPECT_EQ(pull_at(3.99), 0);
  EXPECT_EQ(pull_at(0), 0);
  // the work on the way to 5 m is what it stores: 4 m (int of the tension over the strain)
  EXPECT_NEAR(energy(*model, model->initial_state()), 4 * 200 * (0.24 * 0.24 / 2 + 0.02 * 0.02 / 24), 1e-11);
}

TEST(Cable, RigidMotionsCostNothing) {
  for (const bool straight : {true, false}) {
    const meshing::Mesh mesh = net(meshing::CellType::line3, !straight);
    const auto model = model_of(mesh, {2, 0.01, 1.5, 0}, straight);
    State moved = model->initial_state();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, 3).normalized()));
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      moved.displacement[n] = turn * mesh.nodes[n] + Eigen::Vector3d(1, -2, 3) - mesh.nodes[n];
    const double drawn = energy(*model, model->initial_state());
    EXPECT_NEAR(energy(*model, moved), drawn, 1e-12 * drawn);
  }
}

TEST(Cable, HasTheMassOfItsLengthAtRest) {
  for (const bool straight : {true, false}) {
    const meshing::Mesh mesh = net(meshing::CellType::line3, false);
    const auto model = model_of(mesh, {2, 0.01, 1.25, 0.3}, straight);
    double length = 0, mass = 0;
    for (int e = 0; e < 3; ++e) {
      const auto ends = mesh.blocks[0].cell(e);
      length +=
          (mesh.nodes[static_cast<std::size_t>(ends[1])] - mesh.nodes[static_cast<std::size_t>(ends[0])])
              .norm();
      std::array<double, 45> packed{};
      model->blocks[0]->add_mass(e, packed);
      for (int i = 0; i < 9; i += 3)
        for (int j = 0; j < 9; j += 3)
          mass +=
              packed[static_cast<std::size_t>(std::max(i, j) * (std::max(i, j) + 1) / 2 + std::min(i, j))];
    }
    EXPECT_NEAR(mass, 0.3 * length / 1.25, 1e-13);
  }
}

TEST(Cable, OfNoLengthIsRejected) {
  meshing::Mesh mesh = net(meshing::CellType::line2, false);
  mesh.nodes[1] = mesh.nodes[0];
  EXPECT_THROW(model_of(mesh, {2, 0.01, 1, 0}, false), std::invalid_argument);
}

} // namespace
} // namespace dielast::fem::cable_block_test
