// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/wall_contact_block.hpp"

#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::fem {
namespace {

constexpr double width = 0.3, thickness = 0.2;

/// A beam along x, whose nodes are 0 and 1, and the beginning of another one at `tip`, node 2.
struct Walls {
  meshing::Mesh mesh;
  std::unique_ptr<Model> model;

  explicit Walls(const Eigen::Vector2d& tip) {
    mesh.nodes = {{0, 0, 0}, {1, 0.1, 0}, {tip.x(), tip.y(), 0}, {tip.x(), tip.y() + 1, 0}};
    mesh.blocks = {{meshing::CellType::line2, {0, 1, 2, 3}}};
    model = test::free_model(
        4, true, make_beam_block(mesh, mesh.blocks[0], test::uneven_section(), Eigen::Vector3d::UnitZ()),
        make_wall_contact_block(mesh, {{2, {0, 1}, width, 0.7}}, {thickness, 5}));
  }
  Evaluation drawn() const { return model->blocks[1]->evaluate(model->initial_state(), 0, 1, {}); }
};

TEST(WallContactBlock, residual_and_tangent_are_the_derivatives_of_the_energy) {
  std::mt19937 random(4);
  for (const Eigen::Vector2d& tip : {Eigen::Vector2d(0.4, 0.45), {0.5, -0.3}, {-0.3, 0.2}, {1.25, 0.4}}) {
    const Walls walls(tip);
    ASSERT_GT(walls.drawn().energy, 0);
    State state = walls.model->initial_state();
    for (auto& u : state.displacement) u.head<2>() = test::random_vector(random, 2, 0.01);
    test::expect_consistent_derivatives(*walls.model, state, 0.02, 1e-7);
  }
}

/// -(g - d)^2 ln(g / d), Li et al. 2020, eq. 6, per length that the node stands for.
TEST(WallContactBlock, barrier_is_that_of_the_gap) {
  const Walls over({0.4, 0.04 + (width + 0.05) * std::sqrt(1.01)});
  EXPECT_NEAR(over.drawn().energy, 5 * 0.7 * 0.15 * 0.15 * std::log(4.0), 1e-12);
}

TEST(WallContactBlock, acts_from_its_thickness_on_and_never_lets_faces_meet) {
  EXPECT_EQ(Walls({0.4, 0.6}).drawn().energy, 0);
  EXPECT_TRUE(Walls({0.4, 0.6}).drawn().feasible);
  EXPECT_FALSE(Walls({0.4, 0.3}).drawn().feasible); // nearer than the walls are wide
  EXPECT_GT(Walls({0.4, 0.345}).drawn().energy, Walls({0.4, 0.36}).drawn().energy);
}

} // namespace
} // namespace dielast::fem
