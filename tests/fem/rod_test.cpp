// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/dual.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::rod_test {
namespace {

constexpr double width = 0.1; // m

MembraneSection roll(double prestretch = 1.2) {
  MembraneSection section = test::vhb(prestretch, 1);
  section.width = width;
  return section;
}

/// Five rods of about 1 m between four points, none of which is at rest anywhere.
meshing::Mesh net() {
  return {.nodes = {{0, 0, 0}, {1.1, 0.1, 0}, {0.2, 0.9, 0}, {1.3, 1.2, 0}},
          .blocks = {{meshing::CellType::rod2, {0, 1, 1, 2, 2, 0, 1, 3, 2, 3}}},
          .node_sets = {},
          .cell_sets = {}};
}

State shaken(const Model& model, bool planar, std::mt19937& random) {
  State state = model.initial_state();
  for (auto& u : state.displacement) {
    u = test::random_vector(random, 3, 0.2);
    if (planar) u.z() = 0;
  }
  state.voltage = {7.5e3};
  return state;
}

std::unique_ptr<Model> model_of(const meshing::Mesh& mesh, const MembraneSection& section, bool planar,
                                const std::vector<int>& electrodes) {
  return test::free_model(
      mesh.node_count(), planar,
      make_membrane_block(mesh, mesh.blocks[0], section, electrodes, test::dimension(planar), 1));
}

TEST(Rod, ResidualAndTangentAreTheDerivativesOfTheEnergy) {
  const meshing::Mesh mesh = net();
  for (const bool planar : {true, false}) {
    const auto model = model_of(mesh, roll(), planar, {0, passive, 0, passive, 0});
    std::mt19937 random(3);
    for (int sample = 0; sample < 3; ++sample)
      test::expect_consistent_derivatives(*model, shaken(*model, planar, random), 0.3);
  }
}

/// Energy of one rod in dual numbers, from the solid's law at the stretches lambda, lambda^-1/2, lambda^-1/2.
materials::Dual<6> rod_energy(const meshing::Mesh& mesh, const State& state, double prestretch, double k) {
  using Unknowns = materials::Dual<6>;
  std::array<std::array<Unknowns, 3>, 2> x;
  for (std::size_t a = 0; a < 2; ++a)
    for (int c = 0; c < 3; ++c)
      x[a][static_cast<std::size_t>(c)] =
          Unknowns::variable(mesh.nodes[a][c] + state.displacement[a][c], static_cast<int>(a) * 3 + c);
  Unknowns square;
  for (std::size_t c = 0; c < 3; ++c) square += (x[1][c] - x[0][c]) * (x[1][c] - x[0][c]);
  const double length = (mesh.nodes[1] - mesh.nodes[0]).norm() / prestretch;
  const Unknowns stretch = sqrt(square) / length;
  const double mu = std::get<materials::NeoHookean>(roll().material.law).shear_modulus;
  const double volume = roll().thickness * width * length;
  return volume * (0.5 * mu * (stretch * stretch + 2.0 / stretch - 3.0) - 0.5 * k * stretch);
}

TEST(Rod, EnergyResidualAndTangentEqualDualNumbers) {
  meshing::Mesh mesh = net();
  mesh.nodes.resize(2);
  mesh.blocks[0].nodes = {0, 1};
  const auto model = model_of(mesh, roll(), false, {0});
  Assembler assembler(*model, 1);
  std::mt19937 random(31);
  for (int sample = 0; sample < 20; ++sample) {
    const State state = shaken(*model, false, random);
    const double field = state.voltage[0] / roll().thickness;
    const double k = roll().material.dielectric.permittivity * field * field;
    test::expect_equal(assembler, state, rod_energy(mesh, state, 1.2, k));
  }
}

TEST(Rod, HoldsTheChargeOfItsStretchedArea) {
  const meshing::Mesh mesh = net();
  const auto model = model_of(mesh, roll(), true, {passive, 0, passive, passive, passive});
  std::mt19937 random(5);
  const State state = shaken(*model, true, random);
  const double drawn = (mesh.nodes[2] - mesh.nodes[1]).norm();
  const double now = (mesh.nodes[2] + state.displacement[2] - mesh.nodes[1] - state.displacement[1]).norm();
  const Charges charges = model->charges(state, false);
  const double capacitance =
      roll().material.dielectric.permittivity * width * drawn / 1.2 / roll().thickness * (1.2 * now / drawn);
  EXPECT_NEAR(charges.capacitance[0], capacitance, 1e-12 * capacitance);
  EXPECT_NEAR(charges.charge[0], 7.5e3 * capacitance, 1e-9 * capacitance);
}

/// All its branches are stretched as the rod is: what is stored and turned into heat is that of a cylinder,
/// the same in every direction across.
TEST(Rod, ItsBranchesRelaxAsACylinderDoes) {
  meshing::Mesh mesh = net();
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}};
  mesh.blocks[0].nodes = {0, 1};
  MembraneSection section = roll(1);
  constexpr double modulus = 30e3, time = 0.5;
  section.material.branches = {{materials::NeoHookean{modulus}, materials::Dashpot::log, modulus * time}};
  const auto model = model_of(mesh, section, true, {passive});
  State state = model->initial_state();
  state.displacement[1].x() = 0.8; // at once, then held
  constexpr double dt = 0.002;
  double viscous = 1; // stretch of the dashpot: eta d(ln viscous)/dt = stress of its spring over 3
  Assembler assembler(*model, 1);
  for (int step = 0; step < 200; ++step) {
    state.scheme =
        step == 0 ? materials::TimeScheme::backward_euler(dt) : materials::TimeScheme::bdf2(dt, dt);
    const State arrived = model->settled(state);
    state.history = arrived.history;
  }
  constexpr int fine = 200000;
  for (int step = 0; step < fine; ++step) {
    const auto rate = [&](double v) {
      const double e = 1.8 / v;
      return v * (e * e - 1 / e) / (3 * time);
    };
    const double h = 200 * dt / fine, k1 = rate(viscous), k2 = rate(viscous + h * k1 / 2);
    viscous += h * k2;
  }
  const double stored = model->energies(state).branches;
  const double elastic = 1.8 / viscous;
  const double expected = 0.5 * modulus * (elastic * elastic + 2 / elastic - 3) * width * section.thickness;
  EXPECT_NEAR(stored, expected, 1e-4 * expected);
}

} // namespace
} // namespace dielast::fem::rod_test
