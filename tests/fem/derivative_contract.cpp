// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fem/derivative_contract.hpp"

#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::test {

namespace {

/// Derivative at 0 of a function of the step, by central differences of fourth order.
template<class Function>
auto derivative(const Function& f, double h) {
  using Value = decltype(f(h));
  return Value((8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h));
}

} // namespace

void expect_consistent_derivatives(const Model& model, const State& state, double length, double tolerance) {
  Assembler assembler(model, 1);
  const int n = model.dofs.free_count();
  ASSERT_EQ(n, model.dofs.count());
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(n); // of a step: displacements scale with length, spins do not
  for (int a = 0; a < model.dofs.node_count(); ++a)
    for (int c = 0; c < 3; ++c)
      if (const int e = model.dofs.equation(a, c); e != DofMap::absent) unit[e] = length;

  Eigen::VectorXd scratch;
  const auto moved_by = [&](const Eigen::VectorXd& direction, double step) {
    State there = state;
    model.dofs.advance(there, direction.cwiseProduct(unit), step);
    return there;
  };
  const auto energy = [&](const Eigen::VectorXd& direction, double step) {
    const Evaluation there = assembler.residual(moved_by(direction, step), scratch);
    EXPECT_TRUE(there.feasible);
    return there.energy;
  };
  const auto residual = [&](const Eigen::VectorXd& direction, double step) {
    assembler.residual(moved_by(direction, step), scratch);
    return Eigen::VectorXd(scratch.cwiseProduct(unit));
  };

  const Eigen::VectorXd at_state = residual(Eigen::VectorXd::Zero(n), 0);
  assembler.tangent(state);
  const Eigen::MatrixXd K = unit.asDiagonal() * dense(assembler.matrix()) * unit.asDiagonal();

  Eigen::VectorXd gradient(n);
  Eigen::MatrixXd slope(n, n);
  for (int i = 0; i < n; ++i) {
    const Eigen::VectorXd direction = Eigen::VectorXd::Unit(n, i);
    gradient[i] = derivative([&](double h) { return energy(direction, h); }, 1e-3);
    slope.col(i) = derivative([&](double h) { return residual(direction, h); }, 1e-3);
  }
  EXPECT_LT((gradient - at_state).norm(), tolerance * (at_state.norm() + 1e-3 * K.norm()));
  EXPECT_LT(((slope + slope.transpose()) / 2 - K).norm(), 2.5 * tolerance * K.norm());

  std::mt19937 random(3);
  for (int sample = 0; sample < 5; ++sample) {
    const Eigen::VectorXd v = random_vector(random, n).normalized();
    const auto second_difference = [&](double h) {
      return (energy(v, h) - 2 * energy(v, 0) + energy(v, -h)) / (h * h);
    };
    const double curvature = (4 * second_difference(4e-3) - second_difference(8e-3)) / 3;
    EXPECT_NEAR(curvature, v.dot(K * v), 1e-7 * K.norm());
  }
}

} // namespace dielast::fem::test
