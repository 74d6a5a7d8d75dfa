// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/ramp.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace dielast::fem::electrode_line_test {
namespace {

constexpr double length = 0.1, resistance = 1e6;
constexpr double tau = resistance * (4e-11 / 1e-3) * length * length; // Rs c L^2, s

/// A strip that is held still; its electrode resists the current and is connected at the left end.
std::unique_ptr<Model> resisting_strip(const meshing::Mesh& mesh, double volts) {
  auto model = test::unnumbered_model(
      mesh.node_count(), true,
      make_membrane_block(mesh, mesh.blocks[0], test::vhb(),
                          std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0),
                          Dimension::planar, 3));
  model->ports[0].sheet = {
      .resistance = resistance, .terminal = mesh.node_sets.at("left"), .voltage_scale = volts};
  model->place_histories();
  for (int a = 0; a < mesh.node_count(); ++a)
    for (const int c : {0, 1})
      if (a > 0 || c > 0) model->dofs.hold(a, c);
  model->dofs.number();
  model->length_scale = model->extent = length;
  return model;
}

/// V/V0 at the far end at t/tau, when V0 comes on at t = 0.
std::map<double, double> far_end(int n, int order, const RampOptions& options) {
  const meshing::Mesh mesh = test::strip(n, order, length, length / n);
  const auto model = resisting_strip(mesh, 1);
  Equilibrium equilibrium(*model, 1);
  LoadPath path;
  path.apply = [](State& state, double) { state.voltage = {1.0}; };
  RampProgress progress = RampProgress::begin(model->initial_state(), model->dofs, options);
  std::map<double, double> found;
  RampObserver observer;
  observer.on_accept = [&](const RampProgress& at, const Increment& increment) {
    const State& state = at.points.back().state;
    for (std::size_t a = 0; a < model->ports.sheet_points().size(); ++a)
      if (increment.lands &&
          mesh.nodes[static_cast<std::size_t>(model->ports.sheet_points()[a].node)].x() == length)
        found[state.time / tau] = state.voltage[0] - state.sheet_drop[static_cast<Eigen::Index>(a)];
    return true;
  };
  EXPECT_EQ(ramp(equilibrium, path, options, progress, observer).end, RampEnd::complete);
  return found;
}

/// 1 - sum_n 4/((2n+1) pi) sin((2n+1) pi/2) exp(-((2n+1) pi/2)^2 t/tau)
double exact(double t) {
  double V = 1;
  for (int n = 0; n < 40; ++n) {
    const double k = (2 * n + 1) * std::numbers::pi / 2;
    V -= 2 / k * std::sin(k) * std::exp(-k * k * t);
  }
  return V;
}

TEST(ElectrodeLine, charges_like_a_line_of_resistances_and_capacitances) {
  const std::map<double, double> reference{{0.05, 0.0031308045160052256}, {0.1, 0.0506946373155297},
                                           {0.2, 0.2276883931414092},     {0.5, 0.6292225702004761},
                                           {1.0, 0.892022955555891},      {2.0, 0.9908430097102392}};
  for (const int order : {1, 2}) {
    const auto found = far_end(
        160, order,
        {.increments = 40, .duration = 2 * tau, .time_tolerance = 1e-7, .first_time_step = 1e-4 * tau});
    for (const auto& [time, V] : reference) {
      const auto at = found.lower_bound(time - 1e-9);
      ASSERT_NE(at, found.end());
      EXPECT_NEAR(at->first, time, 1e-9);
      EXPECT_NEAR(at->second / V, 1, 0.005) << time << " order " << order;
    }
  }
}

TEST(ElectrodeLine, errors_are_of_second_order_in_space_and_time) {
  std::vector<double> errors;
  for (const int n : {8, 16})
    errors.push_back(
        far_end(n, 1, {.increments = 4000, .duration = 0.5 * tau, .time_tolerance = 1}).rbegin()->second -
        exact(0.5));
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.1);
  std::vector<double> values;
  for (const int steps : {20, 40, 80})
    values.push_back(
        far_end(16, 1, {.increments = steps, .duration = 0.5 * tau, .time_tolerance = 1}).rbegin()->second);
  EXPECT_NEAR(std::log2((values[0] - values[1]) / (values[1] - values[2])), 2, 0.25);
}

/// Voltages V(x) over the terminal's in steady flow are as said.
void expect_steady(const Model& model, const meshing::Mesh& mesh,
                   const std::function<double(double x)>& expected) {
  Equilibrium equilibrium(model, 1);
  State state = model.initial_state();
  state.scheme = materials::TimeScheme::relaxed();
  state.voltage = {1.0};
  ASSERT_EQ(equilibrium.solve(state, {}).outcome, Outcome::converged);
  for (std::size_t a = 0; a < model.ports.sheet_points().size(); ++a) {
    const double x = mesh.nodes[static_cast<std::size_t>(model.ports.sheet_points()[a].node)].x();
    EXPECT_NEAR(1 - state.sheet_drop[static_cast<Eigen::Index>(a)], expected(x), 1e-4);
  }
}

TEST(ElectrodeLine, what_leaks_in_steady_flow_leaves_less_voltage_far_away) {
  // V = V0 cosh((L - x)/l)/cosh(L/l), l^2 = 1/(Rs leakage per area)
  const meshing::Mesh mesh = test::strip(100, 1, length, length / 100);
  const auto model = resisting_strip(mesh, 1);
  const double per_area = 4 / (resistance * length * length);
  model->ports[0].circuit = {.resistance = 1, .leakage = per_area * length * length / 100};
  model->place_histories();
  expect_steady(*model, mesh, [](double x) { return std::cosh(2 * (1 - x / length)) / std::cosh(2); });
}

TEST(ElectrodeLine, a_disc_connected_at_its_rim_is_one_of_bessel_functions) {
  const meshing::Mesh mesh = [] {
    meshing::Mesh m = test::line(100, 2, [](double s) { return Eigen::Vector3d(length * s, 0, 0); });
    m.blocks[0].type = meshing::CellType::meridian3;
    return m;
  }();
  auto model = std::make_unique<Model>(
      Model{.dofs = DofMap(mesh.node_count()), .blocks = {}, .ports = {{"electrode"}}});
  model->blocks.push_back(make_membrane_block(mesh, mesh.blocks[0], test::vhb(), std::vector<int>(100, 0),
                                              Dimension::axisymmetric, 2));
  for (const auto& block : model->blocks) block->claim_dofs(model->dofs, Dimension::axisymmetric);
  const int rim = mesh.node_count() - 1;
  model->ports[0].sheet = {.resistance = resistance, .terminal = {rim}};
  const double area = std::numbers::pi * length * length;
  model->ports[0].circuit = {.resistance = 1, .leakage = 4 / (resistance * length * length) * area};
  model->place_histories();
  for (int a = 0; a < mesh.node_count(); ++a)
    for (const int c : {0, 2})
      if (a != 1 || c == 2) model->dofs.hold(a, c);
  model->dofs.number();
  model->length_scale = model->extent = length;
  expect_steady(*model, mesh,
                [](double r) { return std::cyl_bessel_i(0, 2 * r / length) / std::cyl_bessel_i(0, 2.0); });
}

} // namespace
} // namespace dielast::fem::electrode_line_test
