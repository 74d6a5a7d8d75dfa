// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/state_space.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/linear/balanced_truncation.hpp"
#include "tests/fem/diaphragm.hpp"
#include "tests/fem/material_point_block.hpp"
#include "tests/fem/sample_meshes.hpp"

#include <numbers>

namespace dielast::fem::state_space_test {
namespace {

/// The controlled diaphragm: 100 g, damped, 4.5 ms circuit, 0.1 Hz to 50 Hz.
class LinearDiaphragm : public ::testing::Test {
 protected:
  static test::DiaphragmData data(bool viscous, double density) {
    test::DiaphragmData data{.density = density,
                             .damping = 1.596,
                             .circuit = {{.resistance = 1.87e6, .leakage = 1e-9}},
                             .elements = 12};
    if (viscous)
      data.branches = {{materials::NeoHookean{15e3}, materials::Dashpot::log, 15e3 * 0.05},
                       {materials::Gent{5e3, 100}, materials::Dashpot::log, 5e3 * 3}};
    return data;
  }
  static std::vector<double> band() {
    std::vector<double> omega;
    for (int i = 0; i <= 60; ++i) omega.push_back(2 * std::numbers::pi * 0.1 * std::pow(500.0, i / 60.0));
    return omega;
  }
  static Channels channels(const test::Diaphragm& diaphragm) {
    return {{0}, Eigen::VectorXd::Unit(diaphragm.model.dofs.free_count(), diaphragm.plate).transpose(), {0}};
  }
};

// Plate on a film without mass: two states, the circuit's charge, and the film follows.
TEST_F(LinearDiaphragm, of_third_order_is_exact_without_branches_and_film_mass) {
  const test::Diaphragm diaphragm(data(false, 0));
  Equilibrium equilibrium(diaphragm.model, 1);
  const State rest = diaphragm.settled(equilibrium, 2500);
  const Linearisation linear(equilibrium, rest);
  const StateSpace model = state_space(equilibrium, rest, channels(diaphragm), {});
  ASSERT_EQ(model.order(), 3);
  EXPECT_LT(largest_error(model, linear, channels(diaphragm), band()), 1e-10);
  const StateSpace balanced = balanced_truncation(model, 3);
  EXPECT_LT(largest_error(balanced, linear, channels(diaphragm), band()), 1e-10);
  EXPECT_LT(eigenvalues(balanced.A).real().maxCoeff(), -5);
}

TEST_F(LinearDiaphragm, with_branches_is_as_good_as_its_order) {
  const test::Diaphragm diaphragm(data(true, 960));
  Equilibrium equilibrium(diaphragm.model, 1);
  const State rest = diaphragm.settled(equilibrium, 2500);
  const Linearisation linear(equilibrium, rest);
  const auto error = [&](const StateSpace& model) {
    return largest_error(model, linear, channels(diaphragm), band());
  };
  EXPECT_LT(error(state_space(equilibrium, rest, channels(diaphragm), {})), 1e-6);
  const StateSpace model =
      state_space(equilibrium, rest, channels(diaphragm), {.highest_frequency = 350}); // the plate's mode
  EXPECT_LT(error(model), 3e-4);
  const std::vector<double> most{4e-2, 1e-2, 3e-4}; // of orders 3, 4, 5
  for (std::size_t i = 0; i < most.size(); ++i) {
    const StateSpace reduced = balanced_truncation(model, static_cast<int>(i) + 3);
    ASSERT_EQ(reduced.order(), static_cast<Eigen::Index>(i) + 3);
    EXPECT_LT(error(reduced), most[i]);
    EXPECT_LT(eigenvalues(reduced.A).real().maxCoeff(), 0);
  }
}

TEST_F(LinearDiaphragm, is_driven_by_voltage_or_charge_without_a_circuit) {
  test::DiaphragmData without = data(true, 960);
  without.circuit.reset();
  const test::Diaphragm diaphragm(without);
  Equilibrium equilibrium(diaphragm.model, 1);
  State rest = diaphragm.settled(equilibrium, 2500);
  rest.charge = diaphragm.model.charges(rest, false).charge;
  for (const Supply supply : {Supply::voltage, Supply::charge}) {
    rest.supply = {supply};
    const StateSpace model = state_space(equilibrium, rest, channels(diaphragm), {});
    EXPECT_LT(largest_error(model, Linearisation(equilibrium, rest), channels(diaphragm), band()), 1e-6);
  }
}

// Two electrodes: one is driven, the other isolated but for its leak, whose charge is a state.
TEST(StateSpace, of_an_isolated_electrode_that_leaks_is_the_response) {
  const meshing::Mesh mesh = test::distorted_square(4, 2, 0.01);
  std::vector<int> electrodes(32, 0);
  std::fill(electrodes.begin() + 16, electrodes.end(), 1);
  const auto model = test::square_film(mesh, 0.01, test::Held::along_edge, electrodes);
  model->ports = {{"driven"}, {"leaking"}};
  model->ports[1].circuit = {.resistance = 1e6, .leakage = 1e-12};
  model->place_histories();
  model->known_inertia.emplace(); // none
  Equilibrium equilibrium(*model, 1);
  State state = model->initial_state();
  state.scheme = materials::TimeScheme::relaxed();
  state.voltage = {8e3, 6e3};
  ASSERT_EQ(equilibrium.solve(state, {.tolerance = 1e-13}).outcome, Outcome::converged);
  state = model->settled(std::move(state));
  state.charge = model->charges(state, false).charge;
  state.supply[1] = Supply::leak;
  const Channels channels{{0}, Eigen::MatrixXd::Identity(2, model->dofs.free_count()), {0, 1}};
  const StateSpace small = state_space(equilibrium, state, channels, {});
  ASSERT_EQ(small.order(), 1); // nothing has a mass
  const double rate = -small.A(0, 0), C = state.charge[1] / 6e3;
  EXPECT_GT(rate, 0.5 * 1e-12 / C);
  EXPECT_LT(rate, 1e-12 / C); // the film gives way
  const std::vector<double> omega{0.01 * rate, rate, 100 * rate};
  EXPECT_LT(largest_error(small, Linearisation(equilibrium, state), channels, omega), 1e-9);
}

TEST_F(LinearDiaphragm, has_none_where_rates_vary_or_nothing_is_stable) {
  test::DiaphragmData nominal = data(true, 960);
  nominal.branches[0].dashpot = materials::Dashpot::nominal;
  const test::Diaphragm diaphragm(nominal);
  Equilibrium equilibrium(diaphragm.model, 1);
  const State rest = diaphragm.settled(equilibrium, 2500);
  EXPECT_THROW(state_space(equilibrium, rest, channels(diaphragm), {}), std::domain_error);

  auto film = test::material_point(std::numeric_limits<double>::infinity());
  Eigen::SparseMatrix<double> mass(1, 1);
  mass.insert(0, 0) = 1;
  film->known_inertia = Inertia{mass, Eigen::SparseMatrix<double>(1, 1)};
  Equilibrium of_film(*film, 1);
  State state = film->initial_state();
  state.displacement[0].x() = 0.5;
  state.voltage[0] = test::equilibrium_voltage(std::numeric_limits<double>::infinity(), 1.5);
  EXPECT_THROW(state_space(of_film, state, {{0}, Eigen::MatrixXd::Ones(1, 1), {}}, {}), std::domain_error);
}

// Other coordinates of the states, their signs included, make no other model; a nearly undamped mode gives
// two states of one singular value.
TEST(BalancedTruncation, tells_one_model_whatever_the_states_were) {
  StateSpace model{Eigen::MatrixXd::Zero(5, 5), Eigen::VectorXd::Zero(5), Eigen::RowVectorXd::Zero(5),
                   Eigen::MatrixXd::Zero(1, 1)};
  model.A.diagonal() << -1, -10, -1e-8, -1e-8, -3;
  model.A(2, 3) = 7;
  model.A(3, 2) = -7;
  model.B << 1, 0.2, 1e-3, 0, 0.5;
  model.C << 1, 0.1, 1, 1, -0.3;
  std::mt19937 random(3);
  const StateSpace whole = balanced_truncation(model, 4);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::MatrixXd any =
        Eigen::MatrixXd::NullaryExpr(5, 5, [&] { return std::normal_distribution()(random); });
    const Eigen::MatrixXd T = symmetric_eigen(any + any.transpose()).vectors;
    const StateSpace turned{T.transpose() * model.A * T, T.transpose() * model.B, model.C * T, model.D};
    const StateSpace other = balanced_truncation(turned, 4);
    EXPECT_LT((other.A - whole.A).norm(), 1e-5 * whole.A.norm());
    EXPECT_LT((other.B - whole.B).norm(), 1e-5 * whole.B.norm());
    EXPECT_LT((other.C - whole.C).norm(), 1e-5 * whole.C.norm());
  }
}

// G = 1/(s + 1) + 0.02/(s + 10) + an undamped mode that nothing reaches.
TEST(BalancedTruncation, keeps_what_is_reached_and_seen) {
  StateSpace model{Eigen::MatrixXd::Zero(4, 4), Eigen::VectorXd::Zero(4), Eigen::RowVectorXd::Zero(4),
                   Eigen::MatrixXd::Constant(1, 1, 0.3)};
  model.A(0, 0) = -1;
  model.A(1, 1) = -10;
  model.A(2, 3) = 7;
  model.A(3, 2) = -7;
  model.B << 1, 0.2, 0, 0;
  model.C << 1, 0.1, 1, 1;
  const auto G = [](std::complex<double> s) { return 1.0 / (s + 1.0) + 0.02 / (s + 10.0) + 0.3; };
  const StateSpace two = balanced_truncation(model, 3), one = balanced_truncation(model, 1);
  EXPECT_EQ(two.order(), 2);
  EXPECT_EQ(one.order(), 1);
  for (const double omega : {0.0, 0.5, 3.0, 40.0}) {
    const std::complex<double> s(0, omega);
    EXPECT_LT(std::abs(two.transfer(s)(0, 0) - G(s)), 1e-6);
    EXPECT_LT(std::abs(one.transfer(s)(0, 0) - G(s)), 2e-3 + 1e-6);
  }
  EXPECT_NEAR(one.A(0, 0), -1, 0.02);
  model.A(0, 0) = 0.1;
  EXPECT_THROW(balanced_truncation(model, 1), std::domain_error);
}

} // namespace
} // namespace dielast::fem::state_space_test
