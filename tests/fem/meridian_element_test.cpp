// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"
#include "materials/laws/dual.hpp"
#include "meshing/meridian.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_models.hpp"
#include "tests/materials/law_examples.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::meridian_element_test {
namespace {

/// A dome of 6 elements from the radius 1.4 to the axis, middle nodes off the middle.
meshing::Mesh dome(int order) {
  meshing::Mesh mesh = meshing::disc_meridian(1.4, 0.7, 6, order);
  std::mt19937 random(5);
  for (int a = 0; a < mesh.node_count(); ++a) {
    Eigen::Vector3d& X = mesh.nodes[static_cast<std::size_t>(a)];
    if (a > 6) X.x() += test::random_vector(random, 1, 0.03)[0];
    X.z() = 0.4 * std::cos(X.x()) + 0.05 * std::sin(5 * X.x());
  }
  return mesh;
}

/// Wider, higher and shaken, with 7.5 kV across the 1 mm film.
State random_state(const Model& model, const meshing::Mesh& mesh, std::mt19937& random, double wider = 1.3) {
  State state = test::homogeneous(model, mesh, Eigen::Vector3d(wider, 1, 1.8).asDiagonal());
  for (auto& u : state.displacement) {
    const Eigen::VectorXd shake = test::random_vector(random, 2, 0.02);
    u += Eigen::Vector3d(shake[0], 0, 0.1 + shake[1]);
  }
  state.voltage = {7.5e3};
  return state;
}

std::unique_ptr<Model> film(const meshing::Mesh& mesh, const MembraneSection& section) {
  std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks[0].size()), 0);
  electrodes[1] = electrodes[4] = passive;
  const bool quadratic = mesh.blocks[0].type == meshing::CellType::meridian3;
  return test::free_model(mesh.node_count(), Dimension::axisymmetric,
                          make_membrane_block(mesh, mesh.blocks[0], section, electrodes,
                                              Dimension::axisymmetric, quadratic ? 3 : 2));
}

class MeridianElement : public testing::TestWithParam<int> {
 protected:
  const meshing::Mesh mesh = dome(GetParam());
  std::mt19937 random{21};
};

TEST_P(MeridianElement, derivatives_are_consistent_for_every_law) {
  std::apply(
      [&](const auto&... law) {
        (
            [&] {
              SCOPED_TRACE(law.name);
              MembraneSection section = test::vhb(1.3, 0.9);
              section.material.law = law;
              const auto model = film(mesh, section);
              test::expect_consistent_derivatives(*model, random_state(*model, mesh, random), 0.1, 1e-8);
            }(),
            ...);
      },
      materials::test::examples);
}

TEST_P(MeridianElement, derivatives_are_consistent_with_branches_frozen_relaxed_and_in_time) {
  const auto model = film(mesh, test::viscoelastic_vhb());
  State state = random_state(*model, mesh, random);
  state.scheme = materials::TimeScheme::backward_euler(0.7);
  test::expect_consistent_derivatives(*model, state, 0.1, 1e-8);
  State next = random_state(*model, mesh, random, 1.5);
  next.history = model->advanced_history(state);
  for (const auto scheme : {materials::TimeScheme::bdf2(1.0, 0.7), materials::TimeScheme::frozen(),
                            materials::TimeScheme::relaxed()}) {
    next.scheme = scheme;
    test::expect_consistent_derivatives(*model, next, 0.1, 1e-8);
  }
}

TEST_P(MeridianElement, derivatives_are_consistent_where_hoops_wrinkle) {
  for (MembraneSection section : {test::vhb(), test::viscoelastic_vhb()}) {
    section.tension_field = true;
    const auto model = film(mesh, section);
    State state = random_state(*model, mesh, random, 0.3);
    for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
      state.displacement[a].z() -= 3 * mesh.nodes[a].x(); // steeper: tight along the meridian
    state.scheme = materials::TimeScheme::backward_euler(0.7);
    for (const MembraneSample& s : model->sample(state).film)
      EXPECT_EQ(s.tension, materials::Tension::wrinkled);
    test::expect_consistent_derivatives(*model, state, 0.1, 1e-8);
  }
}

TEST_P(MeridianElement, charges_are_the_derivatives_of_the_energy_in_the_voltage) {
  for (const double electrostriction : {0.0, -0.05}) {
    MembraneSection section = test::vhb(1.3, 0.9);
    section.material.dielectric.electrostriction = electrostriction;
    const auto model = film(mesh, section);
    const State state = random_state(*model, mesh, random);
    const Charges charges = model->charges(state, true);
    Equilibrium equilibrium(*model, 1);
    const auto at = [&](double volts, Eigen::VectorXd& force) {
      State there = state;
      there.voltage = {volts};
      return equilibrium.internal_force(there, force).energy;
    };
    // the energy is quadratic in the voltage: differences of any step are exact
    Eigen::VectorXd above, below;
    const double high = at(9.5e3, above), low = at(5.5e3, below);
    EXPECT_NEAR(-(high - low) / 4e3, charges.charge[0], 1e-11 * charges.charge[0]);
    EXPECT_NEAR(charges.charge[0], charges.capacitance[0] * 7.5e3, 1e-14 * charges.charge[0]);
    EXPECT_LT(((above - below) / 4e3 + charges.coupling[0]).norm(), 1e-10 * charges.coupling[0].norm());
  }
}

TEST_P(MeridianElement, a_translation_along_the_axis_is_a_rigid_motion) {
  const auto model = film(mesh, test::vhb(1.3, 0.9));
  const State state = random_state(*model, mesh, random);
  State lifted = state;
  Eigen::VectorXd along = Eigen::VectorXd::Zero(model->dofs.count());
  for (int a = 0; a < mesh.node_count(); ++a) {
    lifted.displacement[static_cast<std::size_t>(a)].z() += 3;
    along[model->dofs.equation(a, 2)] = 1;
  }
  Assembler assembler(*model, 1);
  Eigen::VectorXd force, there;
  const double energy = assembler.residual(state, force).energy;
  EXPECT_NEAR(assembler.residual(lifted, there).energy, energy, 1e-13 * std::abs(energy));
  EXPECT_LT((there - force).norm(), 1e-13 * force.norm());
  EXPECT_LT(std::abs(force.dot(along)), 1e-13 * force.norm());
  assembler.tangent(state);
  const Eigen::MatrixXd K = test::dense(assembler.matrix());
  EXPECT_LT((K * along).norm(), 1e-13 * K.norm());
}

// A flat film pulled at its rim alike in all directions is under one stress, voltage or not.
TEST_P(MeridianElement, an_equal_biaxial_film_is_in_equilibrium_and_found_from_a_perturbed_start) {
  meshing::Mesh flat = meshing::disc_meridian(0.02, 0.01, 7, GetParam());
  for (std::size_t a = 1; a < 7; ++a) flat.nodes[a].x() += test::random_vector(random, 1, 0.0008)[0];
  if (GetParam() == 2)
    for (std::size_t e = 0; e < 7; ++e) flat.nodes[8 + e] = (flat.nodes[e] + flat.nodes[e + 1]) / 2;
  auto model = test::unnumbered_model(flat.node_count(), Dimension::axisymmetric,
                                      make_membrane_block(flat, flat.blocks[0], test::vhb(2, 2),
                                                          std::vector<int>(7, 0), Dimension::axisymmetric,
                                                          GetParam() == 2 ? 3 : 2));
  for (const int c : {0, 2}) model->dofs.hold(flat.node_sets.at("rim").front(), c);
  model->dofs.hold(flat.node_sets.at("centre").front(), 0);
  model->dofs.number();
  model->length_scale = model->extent = 0.02;
  Equilibrium equilibrium(*model, 1);
  State exact = test::homogeneous(*model, flat, Eigen::Vector3d(1.25, 1.25, 1).asDiagonal());
  exact.voltage = {3e3};
  Eigen::VectorXd force;
  equilibrium.internal_force(exact, force);
  EXPECT_LT(force.head(model->dofs.free_count()).norm(), 1e-14 * force.norm());

  State state = exact;
  for (int a = 0; a < flat.node_count(); ++a)
    for (const int c : {0, 2})
      if (model->dofs.equation(a, c) < model->dofs.free_count())
        state.displacement[static_cast<std::size_t>(a)][c] += test::random_vector(random, 1, 1e-4)[0];
  const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-13});
  ASSERT_EQ(result.outcome, Outcome::converged);
  EXPECT_EQ(result.negative_pivots, 0);
  for (std::size_t a = 0; a < flat.nodes.size(); ++a)
    EXPECT_LT((state.displacement[a] - exact.displacement[a]).norm(), 1e-12 * 0.02);
  // neo-Hookean: S = mu (1 - l^-6) - k l^2
  const double l = 2.5, S = 45e3 * (1 - std::pow(l, -6)) - 4e-11 * 9e12 * l * l;
  for (const MembraneSample& s : model->sample(state).film)
    EXPECT_LT((s.S - S * Eigen::Matrix2d::Identity()).norm(), 1e-11 * S);
}

INSTANTIATE_TEST_SUITE_P(, MeridianElement, testing::Values(1, 2),
                         [](const auto& one) { return "order_" + std::to_string(one.param); });

/// Energy of one meridian in dual numbers: shape functions as Lagrange's products differentiated by dual
/// numbers too, the film's energy from its law and its area.
template<int Nodes>
materials::Dual<2 * Nodes> meridian_energy(const meshing::Mesh& mesh, const MembraneSection& section,
                                           const State& state) {
  using Unknowns = materials::Dual<2 * Nodes>;
  using Line = materials::Dual<1>;
  constexpr std::array<double, 3> places{-1, 1, 0};
  const double far = std::sqrt(3.0 / 5), near = 1 / std::sqrt(3.0);
  const std::vector<std::array<double, 2>> rule =
      Nodes == 2 ? std::vector<std::array<double, 2>>{{-near, 1}, {near, 1}}
                 : std::vector<std::array<double, 2>>{{-far, 5.0 / 9}, {0, 8.0 / 9}, {far, 5.0 / 9}};
  Unknowns energy;
  for (const auto& [at, weight] : rule) {
    const Line xi = Line::variable(at, 0);
    double R = 0;
    Eigen::Vector2d dX = Eigen::Vector2d::Zero();
    Unknowns r, dr, dz;
    for (int a = 0; a < Nodes; ++a) {
      Line N(1.0);
      for (int b = 0; b < Nodes; ++b)
        if (b != a) N = N * ((xi - places[b]) / (places[a] - places[b]));
      const Eigen::Vector3d &X = mesh.nodes[a], x = X + state.displacement[a];
      const Unknowns x_a = Unknowns::variable(x.x(), 2 * a), z_a = Unknowns::variable(x.z(), 2 * a + 1);
      R += N.value * X.x();
      dX += N.gradient[0] * Eigen::Vector2d(X.x(), X.z());
      r += N.value * x_a;
      dr += N.gradient[0] * x_a;
      dz += N.gradient[0] * z_a;
    }
    const double S = dX.norm() / section.prestretch[0];
    R /= section.prestretch[1];
    const Unknowns along = (dr * dr + dz * dz) / (S * S), hoop = r * r / (R * R);
    const Unknowns area_square = along * hoop, trace = along + hoop;
    const Unknowns elastic =
        std::visit([&](const auto& law) { return materials::planar_energy(law, trace, area_square); },
                   section.material.law);
    const double field = state.voltage[0] / section.thickness;
    energy += 2 * std::numbers::pi * R * S * weight * section.thickness *
              (elastic - 0.5 * section.material.dielectric.permittivity * field * field * area_square);
  }
  return energy;
}

template<int Nodes>
void expect_dual_derivatives() {
  meshing::Mesh mesh{
      .nodes = {{0.8, 0, 0.3}, {0.3, 0, 0.5}, {0.5, 0, 0.45}},
      .blocks = {{Nodes == 2 ? meshing::CellType::meridian2 : meshing::CellType::meridian3, {}}},
      .node_sets = {},
      .cell_sets = {}};
  mesh.nodes.resize(Nodes);
  for (int a = 0; a < Nodes; ++a) mesh.blocks[0].nodes.push_back(a);
  MembraneSection section = test::vhb(1.3, 0.9);
  section.material.law = materials::Gent{45e3, 70};
  const auto model = test::free_model(
      Nodes, Dimension::axisymmetric,
      make_membrane_block(mesh, mesh.blocks[0], section, {0}, Dimension::axisymmetric, Nodes == 2 ? 2 : 3));
  Assembler assembler(*model, 1);
  std::mt19937 random(31);
  for (int sample = 0; sample < 20; ++sample) {
    const State state = random_state(*model, mesh, random);
    test::expect_equal(assembler, state, meridian_energy<Nodes>(mesh, section, state), 1e-13);
  }
}

TEST(Meridian, energy_residual_and_tangent_equal_dual_numbers) {
  expect_dual_derivatives<2>();
  expect_dual_derivatives<3>();
}

TEST(Meridian, a_film_beyond_the_axis_or_of_no_length_is_infeasible) {
  const meshing::Mesh mesh = dome(2);
  const auto model = film(mesh, test::vhb());
  Assembler assembler(*model, 1);
  Eigen::VectorXd residual;
  EXPECT_TRUE(assembler.residual(model->initial_state(), residual).feasible);
  const State beyond = test::homogeneous(*model, mesh, Eigen::Vector3d(-1, 1, 1).asDiagonal());
  EXPECT_FALSE(assembler.residual(beyond, residual).feasible);
  State folded = model->initial_state();
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    folded.displacement[a] = Eigen::Vector3d(1, 0, 0) - mesh.nodes[a];
  EXPECT_FALSE(assembler.residual(folded, residual).feasible);
}

TEST(Meridian, degenerate_drawings_are_rejected_by_name) {
  const auto refused = [](const meshing::Mesh& mesh, Dimension dimension = Dimension::axisymmetric) {
    try {
      make_membrane_block(mesh, mesh.blocks[0], test::vhb(), std::vector<int>(6, 0), dimension, 2);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  meshing::Mesh mesh = dome(1);
  EXPECT_EQ(refused(mesh), "");
  EXPECT_NE(refused(mesh, Dimension::planar), "");
  mesh.nodes[3] = mesh.nodes[2]; // no length
  EXPECT_NE(refused(mesh).find("meridian 2 "), std::string::npos) << refused(mesh);
  mesh = dome(1);
  mesh.nodes[5].x() = -0.4; // beyond the axis
  EXPECT_NE(refused(mesh).find("meridian 4 "), std::string::npos) << refused(mesh);
  mesh = dome(1);
  mesh.nodes[5].x() = 0; // the last one lies along the axis
  EXPECT_NE(refused(mesh).find("meridian 5 "), std::string::npos) << refused(mesh);
  mesh = dome(2);
  mesh.nodes[7 + 3] = mesh.nodes[3] + 0.1 * (mesh.nodes[3] - mesh.nodes[4]); // doubles back
  EXPECT_NE(refused(mesh).find("meridian 3 "), std::string::npos) << refused(mesh);
}

} // namespace
} // namespace dielast::fem::meridian_element_test
