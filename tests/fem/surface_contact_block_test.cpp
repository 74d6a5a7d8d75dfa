// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/surface_contact_block.hpp"

#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dielast::fem::surface_contact_block_test {
namespace {

constexpr double thickness = 0.2, stiffness = 5;

/// A bent surface of two sides along x, and one of a side above it, both curved; `up` is y, of revolution z.
struct Surfaces {
  explicit Surfaces(const Eigen::Vector2d& place, bool of_revolution = false, double foot = 0) {
    const Eigen::Vector3d up = of_revolution ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
    const auto add = [&](double u, double v) {
      mesh.nodes.emplace_back(u * Eigen::Vector3d::UnitX() + v * up);
      return mesh.node_count() - 1;
    };
    const auto type = of_revolution ? meshing::CellType::meridian3 : meshing::CellType::line3;
    for (const auto& [u, v] :
         {std::pair{2.0, 0.0}, {1.0, 0.1}, {1.5, 0.1}, {0.02, 0.0}, {0.5, 0.12}}) // right to left
      add(u, v);
    lower = {type, {0, 1, 2, 1, 3, 4}};
    for (const auto& [u, v] : {std::pair{0.0, 0.05}, {0.8, 0.0}, {0.4, -0.03}})
      add(place.x() + u, place.y() + v);
    upper = {type, {5, 6, 7}};
    SurfaceContact contact{{"lower", "upper"},
                           {lower, upper},
                           of_revolution ? std::nullopt : std::optional(0.7),
                           {thickness, stiffness, foot}};
    const Dimension dimension = of_revolution ? Dimension::axisymmetric : Dimension::planar;
    model = test::unnumbered_model(mesh.node_count(), dimension,
                                   make_surface_contact_block(mesh, std::move(contact)));
    for (int n = 0; n < mesh.node_count(); ++n)
      for (const int c : {0, of_revolution ? 2 : 1}) model->dofs.add(n, c);
    model->dofs.number();
  }
  const ContactBlock& block() const { return dynamic_cast<const ContactBlock&>(*model->blocks[0]); }
  Evaluation drawn() const {
    return block().evaluate(model->initial_state(), 0, block().element_count(), {});
  }

  meshing::Mesh mesh;
  meshing::CellBlock lower, upper;
  std::unique_ptr<Model> model;
};

TEST(SurfaceContactBlock, residual_and_tangent_are_the_derivatives_of_the_energy) {
  std::mt19937 random(4);
  for (const bool of_revolution : {false, true})
    for (const Eigen::Vector2d& place :
         {Eigen::Vector2d(0.55, 0.24), {0.15, 0.22}, {1.1, 0.23}, {1.7, 0.1}, {2.05, 0.05}}) {
      const Surfaces surfaces(place, of_revolution);
      ASSERT_GT(surfaces.drawn().energy, 0);
      State state = surfaces.model->initial_state();
      for (auto& u : state.displacement) {
        const Eigen::VectorXd by = test::random_vector(random, 2, 0.01);
        u.x() = by[0];
        u[of_revolution ? 2 : 1] = by[1];
      }
      test::expect_consistent_derivatives(*surfaces.model, state, 0.01, 1e-6);
    }
}

/// Two straight sides beside one another: the whole length pushes with the barrier of the gap.
TEST(SurfaceContactBlock, pushes_with_the_barrier_of_the_gap) {
  meshing::Mesh mesh;
  mesh.nodes = {{3, 0, 0}, {0, 0, 0}, {1.5, 0, 0}, {1, 0.05, 0}, {2, 0.05, 0}, {1.5, 0.05, 0}};
  const meshing::CellType type = meshing::CellType::line3;
  const auto contact = make_surface_contact_block(
      mesh,
      {{"a", "b"}, {meshing::CellBlock{type, {0, 1, 2}}, {type, {3, 4, 5}}}, 0.7, {thickness, stiffness}});
  State state;
  state.displacement.assign(6, Eigen::Vector3d::Zero());
  const Barrier barrier{thickness, stiffness};
  const double upper =
      0.7 * 1 * barrier.at(0.05).value; // half of its energy; of what faces it the other half
  const double energy = contact->evaluate(state, 0, contact->element_count(), {}).energy;
  EXPECT_GT(energy, upper / 2 + 0.5 * upper / 2);
  NodalPressure pressure{std::vector<double>(6, 0), std::vector<double>(6, 0)};
  contact->add_pressure(state, pressure);
  for (std::size_t n = 3; n < 6; ++n)
    EXPECT_NEAR(pressure.force[n] / pressure.area[n], -barrier.at(0.05).slope, 1e-12 * stiffness);
  EXPECT_NEAR(pressure.area[3] + pressure.area[4] + pressure.area[5], 0.7, 1e-12);
  EXPECT_TRUE(contact->is_between("a") && contact->is_between("b") && !contact->is_between("c"));
}

/// Of revolution the areas are those of the full turn.
TEST(SurfaceContactBlock, has_the_area_of_the_full_turn) {
  const Surfaces surfaces({0.5, 0.3}, true);
  NodalPressure pressure{std::vector<double>(8, 0), std::vector<double>(8, 0)};
  surfaces.block().add_pressure(surfaces.model->initial_state(), pressure);
  double area = 0;
  for (std::size_t n = 5; n < 8; ++n) area += pressure.area[n];
  EXPECT_NEAR(area, 2 * std::numbers::pi * 0.9 * 0.8, 0.02 * area);
}

/// No way leads through: neither of a surface nor of a corner between the points of the other one.
TEST(SurfaceContactBlock, way_ends_before_surfaces_meet) {
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(0.55, 1), {1.13, 0.4}, {-0.7, 0.5}}) {
    const Surfaces surfaces(place);
    const State from = surfaces.model->initial_state();
    State to = from;
    for (std::size_t n = 5; n < 8; ++n) to.displacement[n] = {0.2, -2, 0};
    to.displacement[5].y() = -3;
    const double part = free_way(*surfaces.model, from, to);
    EXPECT_GT(part, 0);
    EXPECT_LT(part, 1);
    for (auto& u : to.displacement) u *= part;
    EXPECT_TRUE(surfaces.block().evaluate(to, 0, surfaces.block().element_count(), {}).feasible);
  }
  const Surfaces surfaces({0.55, 1});
  State away = surfaces.model->initial_state();
  for (std::size_t n = 5; n < 8; ++n) away.displacement[n] = {0.2, 1, 0};
  EXPECT_EQ(free_way(*surfaces.model, surfaces.model->initial_state(), away), 1);
}

/// A point passes from side to side: the energy changes without a step, nor its slope.
TEST(SurfaceContactBlock, is_smooth_where_pairs_change) {
  const Surfaces surfaces({-0.2, 0.22});
  State state = surfaces.model->initial_state();
  const auto energy = [&](double x) {
    for (std::size_t n = 5; n < 8; ++n) state.displacement[n].x() = x;
    return surfaces.block().evaluate(state, 0, surfaces.block().element_count(), {}).energy;
  };
  constexpr double h = 1e-4;
  double most = 0, previous = 0;
  for (int i = 1; i < 16000; ++i) {
    const double slope = (energy((i + 1) * h) - energy((i - 1) * h)) / (2 * h);
    if (i > 1) most = std::max(most, std::abs(slope - previous));
    previous = slope;
  }
  EXPECT_LT(most, 3e-3); // second derivatives of up to some tens over steps of h
}

TEST(SurfaceContactBlock, refuses_surfaces_with_a_common_node) {
  const Surfaces surfaces({0.5, 0.3});
  EXPECT_THROW(make_surface_contact_block(surfaces.mesh,
                                          {{"a", "b"}, {surfaces.lower, surfaces.lower}, 1.0, {0.1, 1}}),
               std::invalid_argument);
}

} // namespace
} // namespace dielast::fem::surface_contact_block_test
