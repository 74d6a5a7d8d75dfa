// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"

#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::equilibrium_test {
namespace {

/// Film strip of 10 mm side whose width is kept (pure shear), pulled along x by dead forces on its right
/// edge: P = mu (lambda - lambda^-3).
class PureShear : public ::testing::Test {
 protected:
  static constexpr double side = 0.01;
  const meshing::Mesh mesh = test::distorted_square(1, 1, side);
  std::unique_ptr<Model> model = [this] {
    auto m = test::unnumbered_model(
        4, true,
        make_membrane_block(mesh, mesh.blocks[0], test::vhb(), std::vector<int>(2, 0), Dimension::planar, 1));
    for (const int a : {0, 1, 2, 3}) m->dofs.hold(a, 1);
    for (const int a : {0, 2}) m->dofs.hold(a, 0);
    m->dofs.number();
    m->length_scale = m->extent = side;
    return m;
  }();
  Equilibrium equilibrium{*model, 1};

  State pulled_to(double lambda) {
    State state = model->initial_state();
    const double force = 45e3 * (lambda - std::pow(lambda, -3)) * 1e-3 * side;
    for (const int a : {1, 3}) state.dead_force[model->dofs.equation(a, 0)] = force / 2;
    return state;
  }
};

TEST_F(PureShear, dead_forces_are_balanced_and_reactions_hold_them) {
  State state = pulled_to(2);
  ASSERT_EQ(equilibrium.solve(state, {}).outcome, Outcome::converged);
  EXPECT_NEAR(state.displacement[1].x(), side, 1e-9 * side);
  EXPECT_NEAR(state.displacement[3].x(), side, 1e-9 * side);
  Eigen::VectorXd force;
  equilibrium.internal_force(state, force);
  EXPECT_LT((force - state.dead_force).head(2).norm(), 1e-9 * force.norm());
  const double left = force[model->dofs.equation(0, 0)] + force[model->dofs.equation(2, 0)];
  EXPECT_NEAR(left, -45e3 * (2 - 0.125) * 1e-3 * side, 1e-9);
}

// The first Newton step of this compression turns the film over: it must be shortened, not taken.
TEST_F(PureShear, a_trial_that_inverts_the_film_is_backed_off) {
  State state = pulled_to(0.5);
  double shortest = 1;
  const NewtonResult result = equilibrium.solve(
      state, {}, [&](const Iteration& i) { shortest = i.number ? std::min(shortest, i.step_length) : 1; });
  ASSERT_EQ(result.outcome, Outcome::converged);
  EXPECT_LT(shortest, 1);
  EXPECT_NEAR(state.displacement[1].x(), -0.5 * side, 1e-9 * side);
}

TEST_F(PureShear, an_inverted_start_is_infeasible_and_left_alone) {
  State state = model->initial_state();
  state.displacement[1].x() = state.displacement[3].x() = -1.5 * side;
  const auto before = state.displacement;
  EXPECT_EQ(equilibrium.solve(state, {}).outcome, Outcome::infeasible);
  EXPECT_EQ(state.displacement, before);
}

TEST_F(PureShear, too_few_iterations_are_reported) {
  State state = pulled_to(3);
  const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-9, .max_iterations = 1});
  EXPECT_EQ(result.outcome, Outcome::not_converged);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_GT(result.residual, 1e-9);
}

TEST_F(PureShear, converges_quadratically_and_a_solution_needs_no_iteration) {
  State state = pulled_to(1.5);
  std::vector<double> residuals;
  const NewtonOptions tight{.tolerance = 1e-14, .max_iterations = 20};
  ASSERT_EQ(
      equilibrium.solve(state, tight, [&](const Iteration& i) { residuals.push_back(i.residual); }).outcome,
      Outcome::converged);
  for (std::size_t i = 0; i + 1 < residuals.size(); ++i) {
    if (residuals[i] > 1e-2) continue;
    EXPECT_LT(residuals[i + 1], std::max(residuals[i] * residuals[i], 1e-14));
  }
  EXPECT_EQ(equilibrium.solve(state, {}).iterations, 0);
  EXPECT_GT(equilibrium.timings().iterations, 0);
}

TEST_F(PureShear, an_unloaded_film_is_in_equilibrium) {
  State state = model->initial_state();
  const NewtonResult result = equilibrium.solve(state, {});
  EXPECT_EQ(result.outcome, Outcome::converged);
  EXPECT_LE(result.iterations, 1);
}

TEST(Column, straight_equilibrium_beyond_its_buckling_load_has_a_negative_pivot_for_each_mode) {
  const meshing::Mesh mesh = test::line(10, 2, [](double s) { return Eigen::Vector3d(s, 0, 0); });
  for (const bool planar : {true, false}) {
    const auto model = test::column(mesh, planar);
    Equilibrium equilibrium(*model, 1);
    const double euler = std::numbers::pi * std::numbers::pi / 4;
    for (const auto& [load, modes] : {std::pair{0.99, 0}, {1.01, 1}, {8.9, 1}, {9.1, 2}}) {
      State state = model->initial_state();
      state.dead_force[model->dofs.equation(mesh.node_count() - 1, 0)] = -load * euler;
      NewtonResult result;
      for (int repetition = 0; repetition < 2; ++repetition) { // the second time from the loaded state
        state.displacement.back().x() *= repetition ? 1 + 1e-6 : 1;
        result = equilibrium.solve(state, {.tolerance = 1e-10, .max_iterations = 25});
      }
      ASSERT_EQ(result.outcome, Outcome::converged) << load;
      EXPECT_EQ(result.negative_pivots, planar ? modes : 2 * modes) << load;
    }
  }
}

TEST(Column, without_a_support_finds_no_equilibrium) {
  const meshing::Mesh mesh = test::line(3, 1, [](double s) { return Eigen::Vector3d(s, 0, 0); });
  const auto model = test::free_model(mesh.node_count(), true,
                                      make_beam_block(mesh, mesh.blocks[0], test::uneven_section()));
  Equilibrium equilibrium(*model, 1);
  State state = model->initial_state();
  state.dead_force[model->dofs.equation(mesh.node_count() - 1, 0)] = 1;
  EXPECT_NE(equilibrium.solve(state, {}).outcome, Outcome::converged);
}

} // namespace
} // namespace dielast::fem::equilibrium_test
