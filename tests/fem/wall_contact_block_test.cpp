// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/wall_contact_block.hpp"

#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::fem::wall_contact_block_test {
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
        make_wall_contact_block(mesh, {{2, {0, 1, ContactPair::none}, width, 0.7}}, {thickness, 5}));
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

/// A beam bent to a parabola, y = height 4 x (1 - x), whose nodes are 0, 1 and 2, and a node 3 at `tip`.
struct Bent {
  meshing::Mesh mesh;
  std::unique_ptr<Model> model;

  explicit Bent(const Eigen::Vector2d& tip, double height = 0.25) {
    mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {tip.x(), tip.y(), 0}, {tip.x(), tip.y() + 1, 0}};
    mesh.blocks = {{meshing::CellType::line3, {0, 1, 2}}};
    meshing::CellBlock other{meshing::CellType::line2, {3, 4}};
    model = test::free_model(
        5, true, make_beam_block(mesh, mesh.blocks[0], test::uneven_section(), Eigen::Vector3d::UnitZ()),
        make_beam_block(mesh, other, test::uneven_section(), Eigen::Vector3d::UnitZ()),
        make_wall_contact_block(mesh, {{3, {0, 1, 2}, width, 0.7}}, {thickness, 5}));
  }
  double energy() const { return model->blocks[2]->evaluate(model->initial_state(), 0, 1, {}).energy; }
};

TEST(WallContactBlock, residual_and_tangent_at_a_bent_beam_are_the_derivatives_of_the_energy) {
  std::mt19937 random(4);
  for (const Eigen::Vector2d& tip :
       {Eigen::Vector2d(0.4, 0.63), {0.7, -0.2}, {-0.3, 0.25}, {1.25, 0.35}, {0.8, 0.55}}) {
    const Bent walls(tip);
    ASSERT_GT(walls.energy(), 0);
    State state = walls.model->initial_state();
    for (auto& u : state.displacement) u.head<2>() = test::random_vector(random, 2, 0.01);
    test::expect_consistent_derivatives(*walls.model, state, 0.02, 1e-7);
  }
}

/// At 0.1 above the parabola's quarter, along its normal: not that of the chords.
TEST(WallContactBlock, gap_is_that_to_the_bent_centreline) {
  const Eigen::Vector2d on(0.25, 0.1875), normal = Eigen::Vector2d(-0.5, 1).normalized();
  const Bent walls(on + (width + 0.1) * normal);
  EXPECT_NEAR(walls.energy(), 5 * 0.7 * 0.1 * 0.1 * std::log(2.0), 1e-12);
  EXPECT_NEAR(contact_force(*walls.model, walls.model->initial_state()),
              5 * 0.7 * (0.2 * std::log(2.0) + 0.1), 1e-12);
}

/// A wall of two beams with an angle between them, (-1, bend) to (0, 0) to (1, bend), above which there is a
/// node.
struct Bend {
  meshing::Mesh mesh;
  std::unique_ptr<Model> model;

  Bend(double bend, const Eigen::Vector2d& tip) {
    mesh.nodes = {{-1, bend, 0}, {0, 0, 0}, {1, bend, 0}, {tip.x(), tip.y(), 0}, {tip.x(), tip.y() + 1, 0}};
    mesh.blocks = {{meshing::CellType::line2, {0, 1, 1, 2, 3, 4}}};
    constexpr int none = ContactPair::none;
    model = test::free_model(
        5, true, make_beam_block(mesh, mesh.blocks[0], test::uneven_section(), Eigen::Vector3d::UnitZ()),
        make_wall_contact_block(
            mesh,
            {{3, {0, 1, none}, width, 0.7}, {3, {1, 2, none}, width, 0.7}, {3, {1, none, none}, width, -0.7}},
            {thickness, 5}));
  }
  double energy() const { return model->blocks[1]->evaluate(model->initial_state(), 0, 3, {}).energy; }
};

/// Along a straight wall the barrier does not tell where a beam ends, nor around a corner.
TEST(WallContactBlock, end_that_two_beams_share_counts_once) {
  const double one = 5 * 0.7 * 0.15 * 0.15 * std::log(4.0), above = width + 0.05;
  for (const double x : {-0.4, -0.1, -0.01, 0.0, 0.03, 0.2})
    EXPECT_NEAR(Bend(0, {x, above}).energy(), one, 1e-12) << x;
  for (const double angle : {-0.3, 0.0, 0.2})
    EXPECT_NEAR(Bend(-0.5, {above * std::sin(angle), above * std::cos(angle)}).energy(), one, 1e-12) << angle;
  EXPECT_GT(Bend(0.5, {0, 0.4}).energy(), 0); // in a corner both beams push
}

TEST(WallContactBlock, residual_and_tangent_at_a_shared_end_are_the_derivatives_of_the_energy) {
  std::mt19937 random(4);
  for (const Eigen::Vector2d& tip : {Eigen::Vector2d(0.05, 0.34), {-0.05, 0.36}, {0.3, 0.2}}) {
    const Bend walls(-0.5, tip);
    ASSERT_GT(walls.energy(), 0);
    State state = walls.model->initial_state();
    for (auto& u : state.displacement) u.head<2>() = test::random_vector(random, 2, 0.005);
    test::expect_consistent_derivatives(*walls.model, state, 0.02, 1e-7);
  }
}

/// The way of a wall through another ends before their faces meet; beside it, or away from it, it is free.
TEST(WallContactBlock, way_ends_before_faces_meet) {
  const Bent walls({0.5, 1}, 0.25);
  const State from = walls.model->initial_state();
  const auto way = [&](const Eigen::Vector2d& tip, double bow) {
    State to = from;
    to.displacement[3].head<2>() = tip;
    to.displacement[2].y() = bow;
    const double part = free_way(*walls.model, from, to);
    for (auto& u : to.displacement) u *= part;
    EXPECT_TRUE(walls.model->blocks[2]->evaluate(to, 0, 1, {}).feasible);
    return part;
  };
  const double gap = 0.75 - width;
  EXPECT_NEAR(way({0, -2}, 0), 0.9 * gap / 2, 0.02 * gap); // all the way through
  EXPECT_NEAR(way({0, -1}, 1), 0.9 * gap / 2, 0.02 * gap); // and half of it by the other
  EXPECT_EQ(way({0, -0.5 * gap}, 0), 1);
  EXPECT_EQ(way({0, 2}, 0), 1);
  EXPECT_EQ(way({3, -0.5}, 0), 1);
}

} // namespace
} // namespace dielast::fem::wall_contact_block_test
