// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/point_mass_block.hpp"
#include "meshing/middle_nodes.hpp"
#include "tests/fem/material_point_block.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"
#include "tests/fem/timed_run.hpp"

#include <cmath>

namespace dielast::fem::snap_in_time_test {
namespace {

constexpr double side = 0.01, modulus = 45e3, stretch_limit = 100;

/// A free square of a Gent film (J = 100) with its own mass that stays a square; a damper at its sides.
struct Square {
  explicit Square(double damping) {
    MembraneSection section = test::vhb();
    section.material.law = materials::Gent{modulus, stretch_limit};
    model = test::unnumbered_model(
        mesh.node_count(), true,
        make_membrane_block(mesh, mesh.blocks[0], section, {0, 0}, Dimension::planar, 1),
        make_point_mass_block({{.node = 1, .axis = 0, .damping = damping}}));
    // nodes 0 1 / 2 3 from the fixed corner
    for (const auto& [node, axis] : {std::pair{0, 0}, {0, 1}, {1, 1}, {2, 0}}) model->dofs.hold(node, axis);
    for (const auto& [node, axis] : {std::pair{2, 1}, {3, 0}, {3, 1}}) model->dofs.share(1, 0, node, axis);
    model->dofs.number();
    model->length_scale = model->extent = side;
    equilibrium = std::make_unique<Equilibrium>(*model, 1);
  }
  static double stretch(const State& state) { return 1 + state.displacement[1].x() / side; }
  /// From rest, the nominal field Phi/H sqrt(eps/mu) = `field` from the beginning.
  test::TimedRun switch_on(double field, double duration) {
    const State rest = model->initial_state();
    LoadPath path = test::constant_loads(model->dofs, rest);
    path.apply = [field](State& state, double) {
      state.voltage = {field * 1e-3 * std::sqrt(modulus / 4e-11)};
    };
    return test::run_in_time(*equilibrium, rest, path,
                             {.newton = {.tolerance = 1e-11},
                              .increments = 20,
                              .duration = duration,
                              .time_tolerance = 1e-5,
                              .first_time_step = 1e-6,
                              .inertia = true});
  }

  meshing::Mesh mesh = test::distorted_square(1, 1, side);
  std::unique_ptr<Model> model;
  std::unique_ptr<Equilibrium> equilibrium;
};

/// What a voltage that is switched on at once must reach to take the film past its barrier: the largest
/// field at which the energy W - k (l^4 - 1)/2 is zero at some stretch below `before`.
double dynamic_pull_in(double before) {
  double largest = 0;
  for (double l = 1.01; l < before; l += 1e-4) {
    const double I1 = 2 * l * l + std::pow(l, -4);
    const double stored = -stretch_limit * std::log(1 - (I1 - 3) / stretch_limit);
    largest = std::max(largest, std::sqrt(stored / (std::pow(l, 4) - 1)));
  }
  return largest;
}

TEST(SnapInTime, a_voltage_switched_on_pulls_the_film_in_below_the_limit_point) {
  const double threshold = dynamic_pull_in(3), at_rest = test::equilibrium_voltage(stretch_limit, 1.2638044);
  EXPECT_LT(threshold, 0.95 * at_rest);
  Square square(0);
  const auto farthest = [&](double field) {
    double highest = 0;
    for (const State& state : square.switch_on(field, 0.03).states)
      highest = std::max(highest, Square::stretch(state));
    return highest;
  };
  EXPECT_LT(farthest(0.995 * threshold), 2);
  EXPECT_GT(farthest(1.005 * threshold), 5);
}

TEST(SnapInTime, the_film_rings_about_the_far_branch_and_comes_to_rest_there) {
  Square square(0.05);
  const double peak = 1.2638044443828862, far = 7.026280627848488;
  const test::TimedRun run = square.switch_on(test::equilibrium_voltage(stretch_limit, peak), 0.5);
  int crossings = 0;
  for (std::size_t n = 1; n < run.states.size(); ++n)
    crossings += (Square::stretch(run.states[n - 1]) < far) != (Square::stretch(run.states[n]) < far);
  EXPECT_GT(crossings, 3);
  EXPECT_NEAR(Square::stretch(run.end()), far, 1e-6);
  EXPECT_LT(std::abs(run.balance.error()), 1e-2 * run.balance.work().electrical);
}

} // namespace
} // namespace dielast::fem::snap_in_time_test
