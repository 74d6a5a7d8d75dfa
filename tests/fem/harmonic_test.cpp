// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/harmonic.hpp"

#include "fem/elements/point_mass_block.hpp"
#include "fem/linear/response_basis.hpp"
#include "tests/fem/diaphragm.hpp"
#include "tests/fem/sample_meshes.hpp"

namespace dielast::fem::harmonic_test {
namespace {

using Complex = Linearisation::Complex;

/// Square film, its edge pulled unevenly, under a voltage; relaxed.
struct PulledSquare {
  explicit PulledSquare(const MembraneSection& film)
      : model(test::square_film(mesh, 0.01, test::Held::along_edge, {}, film)) {}
  State pulled(Equilibrium& equilibrium, double stretch) const {
    State state = model->initial_state();
    state.voltage = {8e3};
    for (const int a : mesh.node_sets.at("edge")) {
      const auto n = static_cast<std::size_t>(a);
      const Eigen::Vector3d& X = mesh.nodes[n];
      state.displacement[n] = {(stretch - 1) * X.x() + 10 * X.y() * X.y(), (stretch - 0.9) * X.y(), 0};
    }
    state.scheme = materials::TimeScheme::relaxed();
    EXPECT_EQ(equilibrium.solve(state, {.tolerance = 1e-13}).outcome, Outcome::converged);
    return model->settled(std::move(state));
  }
  meshing::Mesh mesh = test::distorted_square(3, 1, 0.01);
  std::unique_ptr<Model> model;
};

// One backward Euler step has the tangent Z(1/dt), whatever the law and the dashpot.
TEST(Linearisation, is_the_tangent_of_a_backward_euler_step_at_real_s) {
  for (const bool nominal : {false, true}) {
    MembraneSection film = test::viscoelastic_vhb();
    if (!nominal) film.material.branches.pop_back();
    const PulledSquare square(film);
    square.model->known_inertia.emplace(); // none
    Equilibrium equilibrium(*square.model, 1);
    State state = square.pulled(equilibrium, 1.5);
    const Linearisation linear(equilibrium, state);
    EXPECT_EQ(linear.rates_vary(), nominal);
    if (!nominal) {
      ASSERT_EQ(linear.rates().size(), 2U);
      EXPECT_NEAR(linear.rates()[0], 1 / 7.0, 1e-7);
      EXPECT_NEAR(linear.rates()[1], 1 / 0.5, 1e-7);
    }
    for (const double dt : {1e-2, 0.7, 30.0}) {
      state.scheme = materials::TimeScheme::backward_euler(dt);
      equilibrium.assembler().tangent(state);
      const std::vector<double>& K = equilibrium.assembler().matrix().values;
      const std::vector<Complex> Z = linear.dynamic_stiffness(1 / dt);
      const double stiffest = *std::ranges::max_element(K);
      for (std::size_t i = 0; i < K.size(); ++i)
        EXPECT_NEAR(Z[i].real(), K[i], 1e-8 * stiffest) << nominal << dt << " " << i;
    }
  }
}

TEST(Linearisation, refuses_dashpots_that_flow_and_wrinkles) {
  MembraneSection film = test::viscoelastic_vhb();
  const PulledSquare square(film);
  Equilibrium equilibrium(*square.model, 1);
  State flowing = square.pulled(equilibrium, 1.5);
  flowing.history = square.model->initial_state().history;
  EXPECT_THROW(Linearisation(equilibrium, flowing), std::domain_error);

  film.tension_field = true;
  const PulledSquare slack(film);
  Equilibrium of_slack(*slack.model, 1);
  EXPECT_NO_THROW(Linearisation(of_slack, slack.pulled(of_slack, 1.5)));
  State state = slack.model->initial_state();
  for (std::size_t a = 0; a < slack.mesh.nodes.size(); ++a)
    state.displacement[a] = Eigen::Vector3d(0.3 * slack.mesh.nodes[a].x(), -0.3 * slack.mesh.nodes[a].y(), 0);
  state.scheme = materials::TimeScheme::relaxed();
  state = slack.model->settled(std::move(state));
  EXPECT_THROW(Linearisation(of_slack, state), std::domain_error);
}

/// A square film that stays a square: side a (1 + u/a), one unknown u, with a mass, a branch and a circuit.
struct Oscillator {
  static constexpr double side = 0.01, H = 1e-3, mu = 45e3, eps = 4e-11, branch = 30e3, eta = 200;
  static constexpr double mass = 0.02, damping = 0.3, R = 2e8, G = 1e-10;

  explicit Oscillator(materials::Branch viscous) {
    MembraneSection film = test::vhb();
    film.material.branches = {std::move(viscous)};
    film.material.density = 0;
    model.blocks.push_back(make_membrane_block(mesh, mesh.blocks[0], film, {0, 0}, Dimension::planar, 1));
    model.blocks.push_back(make_point_mass_block({{1, 0, mass, damping}}));
    for (const auto& block : model.blocks) block->claim_dofs(model.dofs, Dimension::planar);
    for (const auto& [a, c] : {std::pair{0, 0}, {0, 1}, {1, 1}, {2, 0}}) model.dofs.hold(a, c);
    model.dofs.share(1, 0, 3, 0);
    model.dofs.share(1, 0, 3, 1);
    model.dofs.share(1, 0, 2, 1);
    model.dofs.number();
    model.ports[0].circuit = {.resistance = R, .leakage = G};
    model.place_histories();
    model.length_scale = model.extent = side;
  }
  State settled(Equilibrium& equilibrium, double volts) const {
    State state = model.initial_state();
    state.voltage = {volts * model.ports[0].circuit->steady_share()};
    state.scheme = materials::TimeScheme::relaxed();
    EXPECT_EQ(equilibrium.solve(state, {.tolerance = 1e-13}).outcome, Outcome::converged);
    state = model.settled(std::move(state));
    state.supply = {Supply::circuit};
    state.source = {volts};
    return state;
  }

  meshing::Mesh mesh = test::distorted_square(1, 1, side);
  Model model{.dofs = DofMap(4), .blocks = {}, .ports = {{"film"}}};
};

// Pushed by a force: s dQ + G dPhi = 0 makes it as stiff as an isolated one where it is quick, as a
// grounded one where it is slow.
TEST(Harmonic, of_an_isolated_film_that_leaks_goes_from_given_charge_to_given_voltage) {
  const Oscillator oscillator({materials::NeoHookean{Oscillator::branch}, materials::Dashpot::log, 200});
  Equilibrium equilibrium(oscillator.model, 1);
  State state = oscillator.settled(equilibrium, 15e3);
  state.charge = oscillator.model.charges(state, false).charge;
  const HarmonicDrive push = HarmonicDrive::along(oscillator.model, 0);
  const auto moved = [&](Supply supply, double omega) {
    state.supply = {supply};
    return harmonic_response(Linearisation(equilibrium, state), push, std::vector{omega}).at(0);
  };
  state.supply = {Supply::leak};
  const Linearisation linear(equilibrium, state);
  ASSERT_EQ(linear.ports().at(0).conductance, 0);
  const double B = linear.ports()[0].coupling[0], C = linear.ports()[0].capacitance;
  const double middle = Oscillator::G / C;
  for (const double omega : {0.1 * middle, middle, 10 * middle}) {
    const Linearisation::Complex s(0, omega);
    const auto expected = 1.0 / (linear.dynamic_stiffness(s).at(0) + s * B * B / (s * C + Oscillator::G));
    const HarmonicResponse at = moved(Supply::leak, omega);
    EXPECT_LT(std::abs(at.displacement[0] - expected), 1e-12 * std::abs(expected));
    EXPECT_LT(std::abs(at.current[0]), 1e-12 * std::abs(s * at.charge[0]));
  }
  for (const auto& [supply, omega] : {std::pair{Supply::charge, 1e6 * middle}, {Supply::voltage, 0.0}}) {
    const auto like = moved(supply, omega).displacement[0];
    EXPECT_LT(std::abs(moved(Supply::leak, omega).displacement[0] - like), 1e-9 * std::abs(like));
  }
}

// Film W = mu/2 (2 l^2 + l^-4 - 3) - eps/2 (Phi/H)^2 l^4 per volume, l = 1 + u/a. A relaxed neo-Hookean
// branch adds 12 mu_b/l^2 s/(s + rate), rate = mu_b/eta (log) or 6 mu_b/(eta l^2) (nominal along both axes).
TEST(Harmonic, an_oscillator_with_branch_and_circuit_has_its_transfer_function) {
  using O = Oscillator;
  for (const auto dashpot : {materials::Dashpot::log, materials::Dashpot::nominal}) {
    const Oscillator oscillator({materials::NeoHookean{O::branch}, dashpot, O::eta});
    Equilibrium equilibrium(oscillator.model, 1);
    const State state = oscillator.settled(equilibrium, 15e3);
    const double l = 1 + state.displacement[1].x() / O::side, phi = state.voltage[0];
    ASSERT_NEAR(phi, 15e3 / (1 + O::R * O::G), 1e-3);
    ASSERT_GT(l, 1.02);
    const double volume = O::side * O::side * O::H, k = O::eps * std::pow(phi / O::H, 2);
    const double K = volume / (O::side * O::side) * (O::mu * (2 + 10 * std::pow(l, -6)) - 6 * k * l * l);
    const double capacitance = O::eps * volume / (O::H * O::H) * std::pow(l, 4);
    const double B = 4 * capacitance * phi / (l * O::side);
    const double K_b = volume / (O::side * O::side) * 12 * O::branch / (l * l);
    const double rate =
        dashpot == materials::Dashpot::log ? O::branch / O::eta : 6 * O::branch / (O::eta * l * l);

    const Linearisation linear(equilibrium, state);
    const std::vector<double> frequencies{0, 1, 20, 60, 500, 5000};
    const auto driven = harmonic_response(linear, HarmonicDrive::at_port(oscillator.model, 0), frequencies);
    const auto pushed = harmonic_response(linear, HarmonicDrive::along(oscillator.model, 0), frequencies);
    ASSERT_EQ(driven.size(), frequencies.size());
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      const Complex s(0, frequencies[i]);
      const Complex Z = K + K_b * s / (s + rate) + s * O::damping + s * s * O::mass;
      Eigen::Matrix2cd A;
      A << Z, -B, s * B, s * capacitance + O::G + 1 / O::R;
      const Eigen::Vector2cd x = A.partialPivLu().solve(Eigen::Vector2cd(0, 1 / O::R));
      const auto near = [](Complex a, Complex b) { return std::abs(a - b) <= 1e-8 * std::abs(b); };
      EXPECT_TRUE(near(driven[i].displacement[0], x[0])) << driven[i].displacement[0] << x[0] << i;
      EXPECT_TRUE(near(driven[i].voltage[0], x[1])) << i;
      EXPECT_TRUE(near(driven[i].current[0], (1.0 - x[1]) / O::R)) << i;
      const Eigen::Vector2cd y = A.partialPivLu().solve(Eigen::Vector2cd(1, 0));
      EXPECT_TRUE(near(pushed[i].displacement[0], y[0])) << i;
      EXPECT_TRUE(near(pushed[i].voltage[0], y[1])) << i;
    }
  }
}

TEST(Harmonic, at_frequency_zero_is_the_slope_of_the_static_curve) {
  const test::Diaphragm diaphragm({.circuit = {{.resistance = 1e6, .leakage = 1e-8}}});
  Equilibrium equilibrium(diaphragm.model, 1);
  const State state = diaphragm.settled(equilibrium, 4e3);
  const Linearisation linear(equilibrium, state);
  const double zero[] = {0};
  const auto response = harmonic_response(linear, HarmonicDrive::at_port(diaphragm.model, 0), zero).front();
  const double slope = (diaphragm.drop(diaphragm.settled(equilibrium, 4010)) -
                        diaphragm.drop(diaphragm.settled(equilibrium, 3990))) /
                       20;
  EXPECT_NEAR(-response.displacement[diaphragm.plate].real(), slope, 1e-4 * slope);
  EXPECT_NEAR(response.voltage[0].real(), 1 / (1 + 0.01), 1e-9);
  EXPECT_EQ(response.displacement[diaphragm.plate].imag(), 0);

  State kept = state; // charge given: dQ = 0 under a force
  kept.supply[0] = Supply::charge;
  const auto held = harmonic_response(Linearisation(equilibrium, kept),
                                      HarmonicDrive::along(diaphragm.model, diaphragm.plate), zero)
                        .front();
  EXPECT_LT(std::abs(held.charge[0]), 1e-12 * linear.ports()[0].capacitance * std::abs(held.voltage[0]));
  const auto free =
      harmonic_response(linear, HarmonicDrive::along(diaphragm.model, diaphragm.plate), zero).front();
  EXPECT_LT(held.displacement[diaphragm.plate].real(), free.displacement[diaphragm.plate].real());
}

// Film with mass and branches, of one rate each or with rates that vary: few factors give all responses, and
// what they give is the solution with the matrix itself.
TEST(ResponseBasis, gives_what_factoring_gives) {
  for (const bool nominal : {false, true}) {
    test::DiaphragmData data{
        .damping = 1.6,
        .branches = {{materials::NeoHookean{5e3},
                      nominal ? materials::Dashpot::nominal : materials::Dashpot::log, 15e3}},
        .circuit = {{.resistance = 1.87e6, .leakage = 1e-9}},
        .rings = 4};
    if (!nominal)
      data.branches.push_back({materials::NeoHookean{15e3}, materials::Dashpot::log, 15e3 * 0.05});
    const test::Diaphragm diaphragm(data);
    Equilibrium equilibrium(diaphragm.model, 1);
    const Linearisation linear(equilibrium, diaphragm.settled(equilibrium, 2500));
    ASSERT_EQ(linear.rates_vary(), nominal);
    ASSERT_FALSE(linear.terms().empty());
    Eigen::MatrixXd B(linear.stiffness().size, 3); // a port, nothing, a force on the plate
    B.col(0) = linear.ports()[0].coupling;
    B.col(1).setZero();
    B.col(2) = Eigen::VectorXd::Unit(B.rows(), diaphragm.plate);
    ResponseBasis basis(linear, B);
    ComplexSolver solver(linear.stiffness());
    const int count = 60;
    for (int i = 0; i < count; ++i) {
      const Complex s(0, i == 0 ? 0 : 0.5 * std::pow(2e3, (i * 17 % count) / (count - 1.0)));
      const auto found = basis.solve(s);
      ASSERT_TRUE(found);
      std::vector<Complex> Z = linear.dynamic_stiffness(s);
      ASSERT_TRUE(solver.factor(Z));
      const Eigen::MatrixXcd X = solver.solve(B.cast<Complex>());
      EXPECT_EQ(found->col(1).norm(), 0);
      for (const int c : {0, 2}) {
        EXPECT_LT((found->col(c) - X.col(c)).norm(), 1e-9 * X.col(c).norm()) << s;
        for (const int o : {0, 2}) {
          const Complex y = B.col(o).cast<Complex>().dot(X.col(c));
          EXPECT_LT(std::abs(B.col(o).cast<Complex>().dot(found->col(c)) - y), 1e-10 * std::abs(y)) << s;
        }
      }
    }
    EXPECT_GT(basis.factorisations(), 2);
    EXPECT_LT(basis.factorisations(), 20);
  }
}

TEST(ComplexSolver, solves_and_tells_singular_matrices) {
  const SparseSymmetric pattern{3, {0, 2, 4, 5}, {0, 1, 1, 2, 2}, std::vector<double>(5, 0.0)};
  ComplexSolver solver(pattern);
  std::vector<Complex> values{{0, 0}, {1, 2}, {3, -1}, {0, 1}, {2, 0}};
  ASSERT_TRUE(solver.factor(values));
  Eigen::Matrix3cd A;
  A << 0, Complex(1, 2), 0, Complex(1, 2), Complex(3, -1), Complex(0, 1), 0, Complex(0, 1), 2;
  Eigen::MatrixXcd B(3, 2);
  B << 1, Complex(0, 1), 2, -1, Complex(3, 1), 0;
  EXPECT_LT((A * solver.solve(B) - B).norm(), 1e-13);
  values = {{1, 0}, {1, 0}, {1, 0}, {0, 0}, {2, 0}};
  EXPECT_FALSE(solver.factor(values));
}

} // namespace
} // namespace dielast::fem::harmonic_test
