// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"
#include "materials/algebra/small_matrices.hpp"
#include "tests//fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

namespace dielast::fem::film_response_test {
namespace {

constexpr double side = 0.01;
const meshing::Mesh mesh = test::distorted_square(2, 2, side);

std::unique_ptr<Model> film(const MembraneSection& section, bool planar) {
  return test::free_model(
      mesh.node_count(), planar,
      make_membrane_block(mesh, mesh.blocks[0], section,
                          std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0),
                          test::dimension(planar), 3));
}

/// Charged and stretched, with some disorder.
State disturbed(const Model& model, std::mt19937& random, double stretch_x, double stretch_y) {
  State state = test::homogeneous(model, mesh, Eigen::Vector3d(stretch_x, stretch_y, 1).asDiagonal());
  for (auto& u : state.displacement) u.head<2>() += test::random_vector(random, 2, 0.01 * side);
  state.voltage = {3e3};
  return state;
}

class FilmWithBranches : public testing::TestWithParam<bool> {};

TEST_P(FilmWithBranches, has_consistent_derivatives_frozen_relaxed_and_in_time) {
  const auto model = film(test::viscoelastic_vhb(), GetParam());
  std::mt19937 random(5);
  State state = disturbed(*model, random, 1.3, 1.1);
  state.scheme = materials::TimeScheme::backward_euler(0.7);
  test::expect_consistent_derivatives(*model, state, side, 1e-8);
  state.history = model->advanced_history(state);
  State next = disturbed(*model, random, 1.5, 1.2);
  next.history = state.history;
  for (const auto scheme : {materials::TimeScheme::bdf2(1.0, 0.7), materials::TimeScheme::frozen(),
                            materials::TimeScheme::relaxed()}) {
    next.scheme = scheme;
    test::expect_consistent_derivatives(*model, next, side, 1e-8);
  }
}

// What branches do is kept at every point: it must not outlive anything that it depends on.
TEST_P(FilmWithBranches, is_that_of_the_state_whatever_was_asked_for_before) {
  const auto model = film(test::viscoelastic_vhb(), GetParam());
  std::mt19937 random(5);
  State state = disturbed(*model, random, 1.3, 1.1);
  state.scheme = materials::TimeScheme::backward_euler(0.7);
  state.history = model->advanced_history(state);
  State after = disturbed(*model, random, 1.4, 1.3);
  after.history = state.history;
  after.scheme = materials::TimeScheme::bdf2(0.5, 0.7);
  std::vector<State> states{state};
  const auto twice = model->advanced_history(after);
  History other_past = *twice, other = *twice;
  other_past.before.front() += 1e-3;
  other.now.front() += 1e-3;
  for (const History& history : {*state.history, *twice, other_past, other}) {
    after.history = std::make_shared<const History>(history);
    for (const auto scheme :
         {materials::TimeScheme::backward_euler(0.7), materials::TimeScheme::bdf2(1.0, 0.7),
          materials::TimeScheme::bdf2(1.0, 0.5), materials::TimeScheme::frozen()}) {
      after.scheme = scheme;
      if (scheme.h2 == 0 || history.step > 0) states.push_back(after);
    }
  }
  const auto values = [](const Model& of, const State& at) {
    Assembler assembler(of, 1);
    Eigen::VectorXd force;
    const double energy = assembler.residual(at, force).energy;
    assembler.tangent(at);
    return std::tuple(energy, force, assembler.matrix().values, of.advanced_history(at)->now);
  };
  std::vector<decltype(values(*model, state))> alone;
  for (const State& one : states) alone.push_back(values(*film(test::viscoelastic_vhb(), GetParam()), one));
  for (std::size_t i = 0; i < states.size(); ++i)
    for (std::size_t j = 0; j < states.size(); ++j) {
      EXPECT_TRUE(values(*model, states[i]) == alone[i]) << i;
      EXPECT_TRUE(values(*model, states[j]) == alone[j]) << j << " after " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(, FilmWithBranches, testing::Bool(),
                         [](const auto& one) { return one.param ? "planar" : "spatial"; });

TEST(RelaxedFilm, is_the_film_without_its_branches) {
  const auto without = film(test::vhb(), true);
  // the nominal dashpot keeps its spring across the axis in which it does not flow
  MembraneSection section = test::viscoelastic_vhb();
  section.material.branches.pop_back();
  const auto flowing = film(section, true);
  std::mt19937 random(5);
  State state = disturbed(*flowing, random, 1.3, 1.1);
  state.scheme = materials::TimeScheme::relaxed();
  State bare = state;
  bare.history = nullptr;
  Equilibrium one(*flowing, 1), other(*without, 1);
  Eigen::VectorXd f, g;
  one.internal_force(state, f);
  other.internal_force(bare, g);
  EXPECT_LT((f - g).norm(), 1e-14 * g.norm());
}

class WrinkledFilm : public testing::TestWithParam<bool> {};

TEST_P(WrinkledFilm, has_consistent_derivatives_and_no_compression) {
  MembraneSection section = test::vhb();
  section.tension_field = true;
  const auto model = film(section, GetParam());
  std::mt19937 random(5);
  const State state = disturbed(*model, random, 1.4, 0.7);
  test::expect_consistent_derivatives(*model, state, side, 1e-8);
  for (const MembraneSample& s : model->sample(state).film) {
    EXPECT_EQ(s.tension, materials::Tension::wrinkled);
    EXPECT_GT(s.widening, 1.05);
    const auto stress = materials::symmetric_eigen<2>(s.S);
    EXPECT_GT(stress.values[0], -1e-4 * stress.values[1]);
  }
}

TEST_P(WrinkledFilm, with_branches_too) {
  MembraneSection section = test::viscoelastic_vhb();
  section.tension_field = true;
  const auto model = film(section, GetParam());
  std::mt19937 random(5);
  State state = disturbed(*model, random, 1.4, 0.75);
  state.scheme = materials::TimeScheme::backward_euler(0.7);
  test::expect_consistent_derivatives(*model, state, side, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(, WrinkledFilm, testing::Bool(),
                         [](const auto& one) { return one.param ? "planar" : "spatial"; });

// Neo-Hookean natural width under voltage: lambda_2w = [mu/(lambda_1^2 (mu - k lambda_1^2))]^(1/4).
TEST(TensionField, is_as_wide_as_the_closed_form_says) {
  MembraneSection section = test::vhb();
  section.tension_field = true;
  const auto model = film(section, true);
  for (const double stretch : {1.1, 1.4}) {
    State state = test::homogeneous(*model, mesh, Eigen::Vector3d(stretch, 0.6, 1).asDiagonal());
    state.voltage = {12e3};
    const double k = 4e-11 * std::pow(12e3 / 1e-3, 2), mu = 45e3;
    const double width = std::pow(mu / (stretch * stretch * (mu - k * stretch * stretch)), 0.25);
    for (const MembraneSample& s : model->sample(state).film) EXPECT_NEAR(s.widening * 0.6, width, 1e-9);
  }
}

TEST(TensionField, is_lost_where_no_width_balances_the_field) {
  MembraneSection section = test::vhb();
  section.tension_field = true;
  const auto model = film(section, true);
  State state = test::homogeneous(*model, mesh, Eigen::Vector3d(1.6, 0.6, 1).asDiagonal());
  state.voltage = {25e3}; // k lambda_1^2 = 64 kPa > mu
  Equilibrium equilibrium(*model, 1);
  Eigen::VectorXd force;
  EXPECT_FALSE(equilibrium.internal_force(state, force).feasible);
}

TEST(TensionField, is_slack_without_tension_in_any_direction) {
  MembraneSection section = test::vhb();
  section.tension_field = true;
  const auto model = film(section, true);
  State state = test::homogeneous(*model, mesh, Eigen::Vector3d(0.9, 0.8, 1).asDiagonal());
  for (const MembraneSample& s : model->sample(state).film) {
    EXPECT_EQ(s.tension, materials::Tension::slack);
    EXPECT_NEAR(s.widening, 1 / (0.9 * 0.8), 1e-6);
    EXPECT_LT(s.S.norm(), 1e-5 * 45e3 * 10);
  }
}

TEST(Charges, are_the_derivatives_of_the_energy_in_the_voltage) {
  for (const bool wrinkles : {false, true}) {
    MembraneSection section = test::vhb();
    section.tension_field = wrinkles;
    section.material.dielectric.electrostriction = -0.05;
    const auto model = film(section, false);
    std::mt19937 random(9);
    State state = disturbed(*model, random, 1.3, wrinkles ? 0.7 : 1.2);
    const Charges charges = model->charges(state, true);
    Equilibrium equilibrium(*model, 1);
    const auto at = [&](double volts, Eigen::VectorXd& force) {
      State there = state;
      there.voltage = {volts};
      return equilibrium.internal_force(there, force).energy;
    };
    Eigen::VectorXd above, below;
    const double step = 10, high = at(3e3 + step, above), low = at(3e3 - step, below);
    EXPECT_NEAR(-(high - low) / (2 * step), charges.charge[0], 1e-6 * charges.charge[0]);
    EXPECT_NEAR(charges.charge[0], model->charges(state, false).capacitance[0] * 3e3,
                1e-14 * charges.charge[0]);
    const auto charge_at = [&](double volts) {
      State there = state;
      there.voltage = {volts};
      return model->charges(there, false).charge[0];
    };
    const double per_volt = (charge_at(3e3 + step) - charge_at(3e3 - step)) / (2 * step);
    EXPECT_NEAR(charges.capacitance[0], per_volt, 1e-6 * per_volt);
    // dR/dPhi = -dQ/du
    EXPECT_LT(((above - below) / (2 * step) + charges.coupling[0]).norm(), 1e-5 * charges.coupling[0].norm());
  }
}

} // namespace
} // namespace dielast::fem::film_response_test
