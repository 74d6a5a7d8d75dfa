// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/honeycomb_mesh.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

namespace dielast::fem::assembler_test {
namespace {

/// Film and walls of a honeycomb; some unknowns are held.
struct HoneycombCase {
  HoneycombCase(std::vector<int> columns, int wall_elements)
      : mesh(meshing::honeycomb_mesh({150 * std::numbers::pi / 180, std::move(columns), 8e-3},
                                     {.order = 2, .wall_elements = wall_elements})),
        model(test::unnumbered_model(
            mesh.node_count(), true,
            make_membrane_block(mesh, mesh.blocks[0], test::vhb(4, 2.5),
                                std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0),
                                Dimension::planar, 3),
            make_beam_block(mesh, mesh.blocks[1],
                            materials::rectangular_section({78e6, 0.36, 0.55}, 0.8e-3, 2e-3)))) {
    model->dofs.hold(mesh.node_sets.at("left_apex")[0], 1);
    for (const int c : {0, 1}) model->dofs.hold(mesh.node_sets.at("centre")[0], c);
    model->dofs.number();
    std::mt19937 random(91);
    state = model->initial_state();
    for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
      state.displacement[a].head<2>() = test::random_vector(random, 2, 5e-5);
      state.rotation[a] = rotation_of({0, 0, test::random_vector(random, 1, 0.1)[0]});
    }
    state.voltage = {5e3};
  }
  meshing::Mesh mesh;
  std::unique_ptr<Model> model;
  State state;
};

TEST(Assembler, equals_the_dense_sum_of_the_elements) {
  const HoneycombCase c({2, 1}, 2);
  const Model& model = *c.model;
  const int n = model.dofs.count(), free = model.dofs.free_count();
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  double energy = 0;
  for (const auto& block : model.blocks) { // every element into a place of its own, then summed by hand
    const int dofs = block->dofs_per_element(), packed = dofs * (dofs + 1) / 2,
              count = block->element_count();
    std::vector<int> equation(static_cast<std::size_t>(count * dofs)),
        slot(static_cast<std::size_t>(count * packed));
    std::iota(equation.begin(), equation.end(), 0);
    std::iota(slot.begin(), slot.end(), 0);
    std::vector<double> residual(equation.size(), 0), tangent(slot.size(), 0);
    energy +=
        block->evaluate(c.state, 0, count, {equation.data(), slot.data(), residual.data(), tangent.data()})
            .energy;
    std::vector<int> global(static_cast<std::size_t>(dofs));
    for (int e = 0; e < count; ++e) {
      block->element_equations(e, model.dofs, global);
      for (int i = 0, at = e * packed; i < dofs; ++i) {
        const bool present = global[i] != DofMap::absent;
        if (present) expected[global[i]] += residual[e * dofs + i];
        for (int j = 0; j <= i; ++j, ++at) {
          if (!present || global[j] == DofMap::absent) continue;
          K(global[i], global[j]) += tangent[at];
          if (i != j) K(global[j], global[i]) += tangent[at];
        }
      }
    }
  }
  Assembler assembler(model, 1);
  Eigen::VectorXd residual;
  EXPECT_NEAR(assembler.residual(c.state, residual).energy, energy, 1e-14 * std::abs(energy));
  assembler.tangent(c.state);
  EXPECT_LT((residual - expected).norm(), 1e-14 * expected.norm());
  EXPECT_LT((test::dense(assembler.matrix()) - K.topLeftCorner(free, free)).norm(), 1e-14 * K.norm());

  ASSERT_EQ(assembler.block_residuals().size(), 2U);
  EXPECT_LT((assembler.block_residuals()[0] + assembler.block_residuals()[1] - residual).norm(), 1e-15);
  const SparseSymmetric& matrix = assembler.matrix();
  for (int column = 0; column < matrix.size; ++column) {
    EXPECT_EQ(matrix.rows[matrix.column_start[column]], column);
    for (int k = matrix.column_start[column] + 1; k < matrix.column_start[column + 1]; ++k)
      EXPECT_LT(matrix.rows[k - 1], matrix.rows[k]);
  }
}

TEST(Assembler, gives_the_same_bits_with_any_number_of_threads) {
  const HoneycombCase c({7, 6, 7, 6, 7}, 14);
  ASSERT_GT(c.mesh.blocks[0].size(), 16000); // smaller models are left to one thread
  Assembler one(*c.model, 1);
  Eigen::VectorXd expected;
  const double energy = one.residual(c.state, expected).energy;
  one.tangent(c.state);
  for (const int threads : {2, 3}) {
    Assembler several(*c.model, threads);
    for (int repetition = 0; repetition < 3; ++repetition) {
      Eigen::VectorXd residual;
      EXPECT_EQ(several.residual(c.state, residual).energy, energy);
      several.tangent(c.state);
      EXPECT_TRUE(residual == expected) << threads << " threads";
      EXPECT_TRUE(several.matrix().values == one.matrix().values) << threads << " threads";
    }
  }
}

TEST(Assembler, residual_and_tangent_are_derivatives_in_shared_unknowns_too) {
  const meshing::Mesh mesh = test::distorted_square(2, 2);
  auto model = test::unnumbered_model(
      mesh.node_count(), false,
      make_membrane_block(mesh, mesh.blocks[0], test::vhb(), std::vector<int>(8, 0), Dimension::spatial, 3));
  for (const int c : {0, 2}) // neighbours and strangers
    for (const int a : {1, 4, 8}) model->dofs.share(0, a, c);
  model->dofs.number();
  State state = test::homogeneous(*model, mesh, Eigen::Vector3d(1.3, 1.1, 1).asDiagonal());
  std::mt19937 random(92);
  for (auto& u : state.displacement) u += test::random_vector(random, 3, 0.03);
  state.voltage = {5e3};
  test::expect_consistent_derivatives(*model, state, 0.3);
}

TEST(Assembler, an_unknown_without_elements_has_a_zero_diagonal) {
  const meshing::Mesh mesh = test::distorted_square(2, 1);
  auto model =
      test::unnumbered_model(mesh.node_count() + 1, true,
                             make_membrane_block(mesh, mesh.blocks[0], test::vhb(),
                                                 std::vector<int>(8, passive), Dimension::planar, 1));
  model->dofs.add(mesh.node_count(), 0);
  model->dofs.number();
  const int lonely = model->dofs.equation(mesh.node_count(), 0);
  Assembler assembler(*model, 1);
  assembler.tangent(model->initial_state());
  const SparseSymmetric& matrix = assembler.matrix();
  ASSERT_EQ(matrix.column_start[lonely + 1] - matrix.column_start[lonely], 1);
  EXPECT_EQ(matrix.rows[matrix.column_start[lonely]], lonely);
  EXPECT_EQ(matrix.values[matrix.column_start[lonely]], 0);
}

} // namespace
} // namespace dielast::fem::assembler_test
