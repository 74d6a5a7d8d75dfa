// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/instability.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "tests/fem/material_point_block.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::instability_test {
namespace {

LoadPath voltage_path(const Model& model, double volts) {
  const Loads rest = Loads::of(model.initial_state(), model.dofs);
  Loads full = rest;
  full.voltage[0] = volts;
  return linear_path(model.dofs, rest, full);
}

/// First change of the number of unstable modes on a path from rest, located.
std::vector<CriticalPoint> critical_points(Equilibrium& equilibrium, const LoadPath& path, int most,
                                           const ContinuationOptions& options = {}) {
  std::vector<CriticalPoint> found;
  auto progress = begin_continuation(equilibrium, path, equilibrium.model().initial_state(), 0, options);
  if (!progress) return found;
  ContinuationProgress before = *progress;
  ContinuationObserver observer;
  observer.on_accept = [&](const ContinuationProgress& at) {
    if (at.newton.unstable_modes != before.newton.unstable_modes)
      if (auto point = locate(equilibrium, path, before, at, options.newton)) found.push_back(*point);
    before = at;
    return static_cast<int>(found.size()) < most;
  };
  continuation(equilibrium, path, options, *progress, observer);
  return found;
}

TEST(Instability, limit_points_of_a_gent_film) {
  const auto model = test::material_point(100);
  Equilibrium equilibrium(*model, 1);
  const auto found = critical_points(equilibrium, voltage_path(*model, 1), 9);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].load_factor, 0.6893632220278523, 1e-12);
  EXPECT_NEAR(1 + found[0].state.displacement[0].x(), 1.2638044443828862, 1e-8);
  EXPECT_NEAR(found[1].load_factor, 0.27460055, 1e-8);
  EXPECT_NEAR(1 + found[1].state.displacement[0].x(), 5.07426, 1e-5);
  for (const CriticalPoint& point : found) EXPECT_EQ(point.kind, Instability::limit_point);
}

TEST(Instability, load_control_finds_the_limit_point_that_the_arc_length_finds) {
  for (const double J : {std::numeric_limits<double>::infinity(), 100.0}) {
    const auto model = test::material_point(J);
    Equilibrium equilibrium(*model, 1);
    const double exact = J == 100 ? 0.6893632220278523 : 0.6873648184993013;
    const LoadPath path = voltage_path(*model, 1);
    State state = model->initial_state();
    path.apply(state, 0.6);
    ASSERT_EQ(equilibrium.solve(state, {}).outcome, Outcome::converged);
    const auto point = locate_by_load_control(equilibrium, path, state, 0.6, 0.75, {});
    ASSERT_TRUE(point);
    EXPECT_EQ(point->kind, Instability::limit_point);
    EXPECT_NEAR(point->load_factor, exact, 1e-6 * exact);
    const auto along = critical_points(equilibrium, path, 1);
    ASSERT_EQ(along.size(), 1U);
    EXPECT_NEAR(along[0].load_factor, exact, 1e-10);
    int asked = 0;
    EXPECT_FALSE(
        locate_by_load_control(equilibrium, path, state, 0.6, 0.75, {}, false, [&] { return ++asked < 3; }));
    EXPECT_EQ(asked, 3);
  }
}

class PullIn : public ::testing::Test {
 protected:
  static constexpr double side = 0.01;
  const meshing::Mesh mesh = test::distorted_square(4, 2, side);
  std::unique_ptr<Model> model = test::square_film(mesh, side, test::Held::at_corners);
  Equilibrium equilibrium{*model, 1};
  LoadPath path = voltage_path(*model, 30e3);
  /// Closed form (Zhao & Suo 2007).
  const double pull_in = 0.6873648184993013 * 1e-3 * std::sqrt(45e3 / 4e-11) / 30e3;
};

TEST_F(PullIn, is_at_the_closed_form_by_arc_length_and_by_load_control) {
  const auto along = critical_points(equilibrium, path, 1);
  ASSERT_EQ(along.size(), 1U);
  EXPECT_NEAR(along[0].load_factor, pull_in, 1e-9);
  EXPECT_EQ(along[0].kind, Instability::limit_point);

  State state = model->initial_state();
  path.apply(state, 0.7);
  ASSERT_EQ(equilibrium.solve(state, {}).outcome, Outcome::converged);
  const auto by_load = locate_by_load_control(equilibrium, path, state, 0.7, 0.8, {});
  ASSERT_TRUE(by_load);
  EXPECT_NEAR(by_load->load_factor, pull_in, 1e-6 * pull_in);
  EXPECT_EQ(by_load->kind, Instability::limit_point);
}

/// Free film with an electrode in its middle: the rim holds it back.
class PartialElectrode : public ::testing::Test {
 protected:
  static constexpr double side = 0.01;
  const meshing::Mesh mesh = test::distorted_square(6, 2, side);
  std::unique_ptr<Model> model = [this] {
    std::vector<int> electrodes(72, passive);
    for (std::size_t e = 0; e < electrodes.size(); ++e) {
      const std::size_t row = e / 12, column = e / 2 % 6;
      if (row >= 1 && row < 5 && column >= 1 && column < 5) electrodes[e] = 0;
    }
    auto m = test::square_film(mesh, side, test::Held::at_corners, electrodes);
    m->length_scale = side / 6;
    return m;
  }();
  Equilibrium equilibrium{*model, 1};
  LoadPath path = voltage_path(*model, 40e3);
};

TEST_F(PartialElectrode, arc_length_and_load_control_find_the_same_critical_voltage) {
  const auto along = critical_points(equilibrium, path, 1);
  ASSERT_EQ(along.size(), 1U);
  EXPECT_LT(std::abs(along[0].mode.eigenvalue), 1e-8);
  State state = model->initial_state();
  ASSERT_EQ(equilibrium.solve(state, {}).outcome, Outcome::converged);
  const auto by_load = locate_by_load_control(equilibrium, path, state, 0, along[0].load_factor * 1.1, {});
  ASSERT_TRUE(by_load);
  EXPECT_EQ(by_load->kind, along[0].kind);
  EXPECT_NEAR(by_load->load_factor, along[0].load_factor, 1e-6 * along[0].load_factor);
  EXPECT_EQ(along[0].kind, Instability::limit_point);
  EXPECT_GT(along[0].load_factor * 40e3, 0.6873648184993013 * 1e-3 * std::sqrt(45e3 / 4e-11)); // stiffer
}

/// A column under a dead force.
class EulerColumn : public ::testing::Test {
 protected:
  const meshing::Mesh mesh = test::line(8, 2, [](double s) { return Eigen::Vector3d(s, 0, 0); });
  std::unique_ptr<Model> model = test::column(mesh);
  Equilibrium equilibrium{*model, 1};
  const double euler = std::numbers::pi * std::numbers::pi / 4;
  const int tip = mesh.node_count() - 1;
  LoadPath path = [this] {
    const Loads rest = Loads::of(model->initial_state(), model->dofs);
    Loads full = rest;
    full.dead_force[model->dofs.equation(tip, 0)] = -2 * euler;
    return linear_path(model->dofs, rest, full);
  }();
};

TEST_F(EulerColumn, buckles_at_eulers_load_in_a_bifurcation) {
  const auto along = critical_points(equilibrium, path, 1);
  ASSERT_EQ(along.size(), 1U);
  EXPECT_EQ(along[0].kind, Instability::bifurcation);
  EXPECT_NEAR(along[0].load_factor, 0.5, 1e-4);
  const auto mode = displacements(model->dofs, along[0].state, along[0].mode.direction);
  for (int a = 0; a <= tip; ++a) // 1 - cos(pi x / 2)
    EXPECT_NEAR(std::abs(mode[a].y()), 1 - std::cos(std::numbers::pi / 2 * mesh.nodes[a].x()), 1e-3);

  State state = model->initial_state();
  const auto by_load = locate_by_load_control(equilibrium, path, state, 0, 0.7, {});
  ASSERT_TRUE(by_load);
  EXPECT_EQ(by_load->kind, Instability::bifurcation);
  EXPECT_NEAR(by_load->load_factor, along[0].load_factor, 1e-6);
}

// A thousandth below its critical load next to no force takes the column back to its place.
TEST_F(EulerColumn, is_not_balanced_yet_where_it_is_off_along_its_soft_mode) {
  const auto along = critical_points(equilibrium, path, 1);
  ASSERT_EQ(along.size(), 1U);
  State straight = model->initial_state();
  path.apply(straight, 0.999 * along[0].load_factor);
  ASSERT_EQ(equilibrium.solve(straight, {}).outcome, Outcome::converged);
  const Eigen::VectorXd& mode = along[0].mode.direction;
  const double off = 1e-7 / mode.cwiseAbs().maxCoeff();
  State state = straight;
  model->dofs.advance(state, mode, off);
  Balance balance;
  equilibrium.balance(state, balance);
  EXPECT_LT(balance.norm, 1e-8 * balance.scale);
  ASSERT_EQ(equilibrium.solve(state, {.tolerance = 1e-8}).outcome, Outcome::converged);
  EXPECT_LT(model->dofs.increment(straight, state).cwiseAbs().maxCoeff(), 1e-8);
}

// What Newton's first step leaves of a stiff direction is next to nothing of its force, and tells nothing of
// a soft one, in which that step went by a tangent with the stiff one's stress.
TEST_F(EulerColumn, is_not_balanced_yet_where_only_its_stiff_direction_is) {
  const auto bent = [&](double force) {
    State state = model->initial_state();
    state.dead_force[model->dofs.equation(tip, 1)] = force;
    EXPECT_EQ(equilibrium.solve(state, {.tolerance = 1e-12, .max_iterations = 60}).outcome,
              Outcome::converged);
    return state;
  };
  const State exact = bent(0.2);
  State state = bent(0.2 * (1 + 1e-5));
  state.dead_force = exact.dead_force;
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) state.displacement[a].x() += 1e-6 * mesh.nodes[a].x();
  ASSERT_EQ(equilibrium.solve(state, {}).outcome, Outcome::converged);
  EXPECT_LT(model->dofs.increment(exact, state).cwiseAbs().maxCoeff(), 1e-9);
}

// Elastica: the tip of a clamped column, slopes to 20 degrees at 1.015 and 40 at 1.063 times Euler's load
// (Timoshenko & Gere, art. 2.7); y of the tip 0.220 and 0.422 lengths.
TEST_F(EulerColumn, its_bent_branch_is_the_elastica) {
  const auto along = critical_points(equilibrium, path, 1);
  ASSERT_EQ(along.size(), 1U);
  for (const double side : {1.0, -1.0}) {
    auto branch = switch_branch(equilibrium, path, along[0], 0.05 * side, {});
    ASSERT_TRUE(branch);
    EXPECT_NEAR(branch->state.displacement[tip].y() * side, 0.05, 1e-3);
    EXPECT_GT(branch->load_factor, along[0].load_factor);
    EXPECT_EQ(branch->newton.unstable_modes, 0);
    const ContinuationOptions options{.highest = 1.063 / 2};
    EXPECT_EQ(continuation(equilibrium, path, options, *branch, {}), ContinuationEnd::reached_load);
    EXPECT_NEAR(side * branch->state.displacement[tip].y(), 0.422, 2e-3);
    EXPECT_EQ(branch->newton.unstable_modes, 0);
  }
}

// Stiff alike in both directions across, along any axis: of the two modes the one that moves its first
// prominent unknown most, forwards. What rounding makes of the pair differs with the axis.
TEST(Instability, of_twin_modes_one_is_chosen_by_the_order_of_the_unknowns) {
  for (const Eigen::Vector3d& along : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0),
                                       Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, -1, 0)}) {
    const meshing::Mesh mesh = test::line(8, 2, [&](double s) { return Eigen::Vector3d(s * along); });
    const auto model = test::column(mesh, false);
    model->length_scale = 1.0 / 8;
    Equilibrium equilibrium(*model, 1);
    const int tip = mesh.node_count() - 1;
    State state = model->initial_state();
    for (const double load : {0.5, 1 - 1e-9}) { // of Euler's
      for (int c = 0; c < 3; ++c)
        state.dead_force[model->dofs.equation(tip, c)] = -load * 2.4674011002723395 * along[c];
      ASSERT_EQ(equilibrium.solve(state, {.tolerance = 1e-12}).outcome, Outcome::converged);
      const auto mode = lowest_mode(equilibrium, state);
      ASSERT_TRUE(mode);
      const Eigen::Vector3d u =
          displacements(model->dofs, state, mode->direction)[static_cast<std::size_t>(tip)];
      const Eigen::Vector3d expected =
          std::abs(along.x()) > 0.5 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
      EXPECT_LT((u - expected).norm(), 1e-5) << along.transpose() << ": " << u.transpose();
    }
  }
}

TEST_F(EulerColumn, lowest_mode_is_that_of_the_dense_eigenproblem) {
  State state = model->initial_state();
  path.apply(state, 0.3);
  ASSERT_EQ(equilibrium.solve(state, {}).outcome, Outcome::converged);
  const auto mode = lowest_mode(equilibrium, state);
  ASSERT_TRUE(mode);
  equilibrium.assembler().tangent(state);
  const Eigen::MatrixXd K = test::dense(equilibrium.assembler().matrix());
  const Eigen::MatrixXd D = equilibrium.stiffness().asDiagonal();
  const Eigen::MatrixXd scale = equilibrium.stiffness().cwiseSqrt().cwiseInverse().asDiagonal();
  const double lowest = symmetric_eigen(scale * K * scale).values[0];
  EXPECT_NEAR(mode->eigenvalue, lowest, 1e-6 * lowest);
  const Eigen::VectorXd& x = mode->direction;
  EXPECT_LT((K * x - mode->eigenvalue * D * x).norm(), 1e-4 * mode->eigenvalue * (D * x).norm());
}

} // namespace
} // namespace dielast::fem::instability_test
