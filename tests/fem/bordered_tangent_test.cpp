// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/bordered_tangent.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/equilibrium/equilibrium.hpp"
#include "tests/fem/material_point_block.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::bordered_tangent_test {
namespace {

int negative_eigenvalues(const Eigen::MatrixXd& symmetric) {
  return static_cast<int>((symmetric_eigen(symmetric).values.array() < 0).count());
}

/// A square film with two electrodes, stretched and charged unevenly.
class TwoElectrodes : public ::testing::Test {
 protected:
  static constexpr double side = 0.01;
  const meshing::Mesh mesh = test::distorted_square(3, 2, side);
  std::unique_ptr<Model> model = [this] {
    std::vector<int> electrodes(18);
    for (std::size_t e = 0; e < electrodes.size(); ++e) electrodes[e] = e % 5 == 0 ? passive : e < 9 ? 0 : 1;
    auto m = test::square_film(mesh, side, test::Held::at_corners, electrodes);
    m->ports = {{"left"}, {"right"}};
    return m;
  }();
  Equilibrium equilibrium{*model, 1};
  const int size = model->dofs.free_count();

  State state_at(double volts) {
    std::mt19937 random(5);
    State state = test::homogeneous(*model, mesh, Eigen::Vector3d(1.3, 1.2, 1).asDiagonal());
    model->dofs.advance(state, test::random_vector(random, size, 0.02 * side), 1);
    state.voltage = {volts, 1.1 * volts};
    return state;
  }
  /// The whole bordered matrix: u, voltages of the isolated electrodes, s.
  Eigen::MatrixXd dense(const State& state, const PathBorder* path) {
    equilibrium.assembler().tangent(state);
    const Eigen::MatrixXd K = test::dense(equilibrium.assembler().matrix());
    const Charges charges = model->charges(state, true);
    const int all =
        size + static_cast<int>(std::ranges::count(state.supply, Supply::charge)) + (path ? 1 : 0);
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(all, all);
    full.topLeftCorner(size, size) = K;
    int at = size;
    for (const std::size_t e : {0, 1})
      if (state.supply[e] == Supply::charge) {
        full.col(at).head(size) = -charges.coupling[e].head(size);
        full.row(at).head(size) = -charges.coupling[e].head(size);
        full(at, at) = -charges.capacitance[e];
        ++at;
      }
    if (path) {
      full.col(at).head(size) = path->column;
      full.row(at).head(size) = path->row;
      full(at, at) = path->corner;
    }
    return full;
  }
};

TEST_F(TwoElectrodes, block_elimination_solves_the_whole_matrix_and_tells_its_inertia) {
  std::mt19937 random(8);
  const PathBorder path{test::random_vector(random, size), test::random_vector(random, size), 0.3};
  int unstable_films = 0;
  for (const double volts : {1e3, 15e3, 25e3})
    for (const Supply left : {Supply::voltage, Supply::charge})
      for (const Supply right : {Supply::voltage, Supply::charge})
        for (const PathBorder* border : {static_cast<const PathBorder*>(nullptr), &path}) {
          State state = state_at(volts);
          state.supply = {left, right};
          const Eigen::MatrixXd full = dense(state, border), symmetric = dense(state, nullptr);
          ASSERT_TRUE(equilibrium.factor(state, border));
          const int modes = negative_eigenvalues(full.topLeftCorner(size, size));
          unstable_films += modes > 0;
          EXPECT_EQ(equilibrium.tangent().negative_pivots(), modes);
          const auto isolated = static_cast<int>(std::ranges::count(state.supply, Supply::charge));
          EXPECT_EQ(equilibrium.tangent().unstable_modes(), negative_eigenvalues(symmetric) - isolated);

          Eigen::VectorXd right_side = Eigen::VectorXd::Zero(full.rows()), du;
          right_side.head(size) = test::random_vector(random, size);
          if (border) right_side[full.rows() - 1] = 0.7;
          const double ds = equilibrium.tangent().solve(right_side.head(size), du, border ? 0.7 : 0.0);
          const Eigen::VectorXd expected = full.partialPivLu().solve(right_side);
          EXPECT_LT((du - expected.head(size)).norm(), 1e-8 * expected.head(size).norm());
          if (border) {
            EXPECT_NEAR(ds, expected[full.rows() - 1], 1e-8 * std::abs(ds));
          }
        }
  EXPECT_GT(unstable_films, 0);
}

// mu = 1, permittivity 1: K = 0 at stretch 2^(1/3), where only the charge holds the film.
TEST(BorderedTangent, charge_holds_a_film_whose_tangent_at_fixed_voltage_vanishes) {
  const auto model = test::material_point(std::numeric_limits<double>::infinity());
  Equilibrium equilibrium(*model, 1);
  const double l = std::cbrt(2.0),
               phi = test::equilibrium_voltage(std::numeric_limits<double>::infinity(), l);
  for (const double offset : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-4, -1e-4}) {
    State state = model->initial_state();
    state.displacement[0].x() = l + offset - 1;
    state.voltage[0] = phi;
    state.supply[0] = Supply::charge;
    ASSERT_TRUE(equilibrium.factor(state)) << offset;
    EXPECT_EQ(equilibrium.tangent().unstable_modes(), 0) << offset;
    Eigen::VectorXd du;
    equilibrium.tangent().solve(Eigen::VectorXd::Ones(1), du);
    const double stretch = l + offset, coupling = 4 * phi * std::pow(stretch, 3);
    const double K = 2 + 10 * std::pow(stretch, -6) - 6 * phi * phi * stretch * stretch;
    EXPECT_NEAR(du[0], 1 / (K + coupling * coupling / std::pow(stretch, 4)), 1e-6 * du[0]) << offset;
  }
}

/// Pull-in of a free neo-Hookean film (Zhao & Suo 2007): with the charge held it is an ordinary state.
TEST(BorderedTangent, shifts_a_film_at_pull_in) {
  const double side = 0.01;
  const meshing::Mesh mesh = test::distorted_square(3, 1, side);
  const auto model = test::square_film(mesh, side, test::Held::at_corners);
  Equilibrium equilibrium(*model, 1);
  const double l = std::cbrt(2.0);
  State state = test::homogeneous(*model, mesh, Eigen::Vector3d(l, l, 1).asDiagonal());
  state.voltage[0] = 0.6873648184993013 * 1e-3 * std::sqrt(45e3 / 4e-11);
  state.supply[0] = Supply::charge;
  ASSERT_TRUE(equilibrium.factor(state));
  EXPECT_EQ(equilibrium.tangent().unstable_modes(), 0);
  equilibrium.assembler().tangent(state);
  const Eigen::MatrixXd K = test::dense(equilibrium.assembler().matrix());
  EXPECT_LT(symmetric_eigen(K).values.cwiseAbs().minCoeff(), 1e-12 * K.norm());
  const Charges charges = model->charges(state, true);
  const Eigen::VectorXd B = charges.coupling[0].head(K.rows());
  std::mt19937 random(3);
  const Eigen::VectorXd expected = test::random_vector(random, K.rows());
  const Eigen::VectorXd force = K * expected + B * (B.dot(expected) / charges.capacitance[0]);
  Eigen::VectorXd du;
  equilibrium.tangent().solve(force, du);
  EXPECT_LT((du - expected).norm(), 1e-10 * expected.norm());
}

} // namespace
} // namespace dielast::fem::bordered_tangent_test
