// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/sheet_conduction.hpp"

#include "fem/equilibrium/tangent_check.hpp"
#include "fem/paths/energy_balance.hpp"
#include "fem/paths/ramp.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"
#include "tests/fem/timed_run.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::fem::sheet_conduction_test {
namespace {

/// A square film, held at its left edge, whose electrode is connected at the corner there.
class ResistingFilm : public testing::Test {
 protected:
  static constexpr double side = 0.01, volts = 12e3, resistance = 1e6;
  static constexpr double tau = resistance * (4e-11 / 1e-3) * side * side;
  const meshing::Mesh mesh = test::distorted_square(4, 2, side);

  std::unique_ptr<Model> film(bool sheet, std::optional<Circuit> circuit = {},
                              const MembraneSection& section = test::vhb()) const {
    auto model = test::unnumbered_model(
        mesh.node_count(), true,
        make_membrane_block(mesh, mesh.blocks[0], section, std::vector<int>(32, 0), Dimension::planar, 3));
    if (sheet) model->ports[0].sheet = {.resistance = resistance, .terminal = {0}, .voltage_scale = volts};
    model->ports[0].circuit = circuit;
    model->place_histories();
    for (int a = 0; a < mesh.node_count(); ++a)
      if (mesh.nodes[static_cast<std::size_t>(a)].x() == 0) model->dofs.hold(a, 0);
    model->dofs.hold(0, 1);
    model->dofs.number();
    model->length_scale = side / 4;
    model->extent = side;
    return model;
  }
  static Circuit source() {
    return {.resistance = resistance / 2,
            .leakage = 1 / (20 * resistance),
            .current_limit = volts / resistance,
            .charge_scale = 1e-7};
  }
  static LoadPath step_voltage() {
    LoadPath path;
    path.apply = [](State& state, double) {
      (state.supply[0] == Supply::voltage ? state.voltage : state.source) = {volts};
    };
    return path;
  }
  static RampOptions options(double duration) {
    return {.newton = {.tolerance = 1e-10},
            .increments = 8,
            .duration = duration,
            .time_tolerance = 1e-4,
            .first_time_step = 1e-3 * tau};
  }
  static const SheetPoint& point(const Model& model, Eigen::Index a) {
    return model.ports.sheet_points()[static_cast<std::size_t>(a)];
  }
  /// A state in which nothing is in balance.
  State disturbed(const Model& model) const {
    std::mt19937 random(3);
    State state = model.initial_state();
    for (auto& u : state.displacement) u.head<2>() = test::random_vector(random, 2, 0.02 * side);
    state.voltage = {volts};
    state.sheet_drop =
        test::random_vector(random, static_cast<Eigen::Index>(model.ports.sheet_points().size()), volts / 3);
    return state;
  }
};

Eigen::VectorXd sheet_charges(const Model& model, const State& state) {
  Eigen::VectorXd q = model.sheet_matrices(state).capacitance;
  for (Eigen::Index a = 0; a < q.size(); ++a) q[a] *= state.voltage[0] - state.sheet_drop[a];
  return q;
}

TEST_F(ResistingFilm, its_conductances_are_those_of_the_current_surface) {
  MembraneSection section = test::vhb(1.3, 0.9);
  const auto model = film(true, {}, section);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.topLeftCorner<2, 2>() << 1.4, 0.3, -0.2, 0.8;
  const State state = test::homogeneous(*model, mesh, F);
  const Eigen::Vector2d slope(3, -2); // V/m in the current plane
  Eigen::VectorXd V(static_cast<Eigen::Index>(model->ports.sheet_points().size()));
  for (Eigen::Index a = 0; a < V.size(); ++a) {
    const auto node = static_cast<std::size_t>(point(*model, a).node);
    V[a] = slope.dot((mesh.nodes[node] + state.displacement[node]).head<2>());
  }
  double power = 0;
  for (const auto& entry : model->sheet_matrices(state).conductance)
    power += V[entry.row()] * entry.value() * V[entry.col()];
  const double area = side * side * F.determinant();
  EXPECT_NEAR(power, slope.squaredNorm() * area / resistance, 1e-12 * power);
}

TEST_F(ResistingFilm, charges_forces_and_tangent_belong_to_one_energy) {
  const auto model = film(true);
  Equilibrium equilibrium(*model, 1);
  const State state = disturbed(*model);
  const TangentCheck check = check_tangent(equilibrium, state, 1e-3 * side, 4);
  EXPECT_LT(check.residual, 1e-8);
  EXPECT_LT(check.tangent, 1e-6);
  const Eigen::VectorXd q = sheet_charges(*model, state);
  Eigen::VectorXd unused;
  for (const Eigen::Index a : {0, 7, 12}) {
    const double h = volts / 10;
    State more = state, less = state;
    more.sheet_drop[a] += h;
    less.sheet_drop[a] -= h;
    const double slope =
        (equilibrium.internal_force(more, unused).energy - equilibrium.internal_force(less, unused).energy) /
        (2 * h);
    EXPECT_NEAR(slope, q[a], 1e-9 * q.cwiseAbs().maxCoeff());
  }
  double integral = 0;
  for (const MembraneSample& s : model->sample(state).film)
    integral += 4e-11 * s.voltage * s.volume * (s.F.transpose() * s.F).determinant() / (1e-3 * 1e-3);
  EXPECT_NEAR(q.sum(), integral, 1e-12 * integral);
  EXPECT_NEAR(model->charges(state, false).charge[0], integral, 1e-12 * integral);
}

TEST_F(ResistingFilm, what_the_source_gives_is_stored_or_leaks) {
  const auto model = film(true, {source()});
  Equilibrium equilibrium(*model, 1);
  State start = model->initial_state();
  start.supply[0] = Supply::circuit;
  const RampOptions timed = options(20 * tau);
  RampProgress progress = RampProgress::begin(start, model->dofs, timed);
  int times = 0, limited = 0;
  Eigen::VectorXd q_before =
                      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model->ports.sheet_points().size())),
                  q_older = q_before;
  RampObserver observer;
  observer.on_accept = [&](const RampProgress& at, const Increment&) {
    const State& state = at.points.back().state;
    const Eigen::VectorXd q = sheet_charges(*model, state);
    EXPECT_NEAR(q.sum(), model->charges(state, false).charge[0], 1e-12 * q.sum());
    if (const History& past = *state.history; past.step > 0) {
      const auto scheme = past.step_before > 0 ? materials::TimeScheme::bdf2(past.step, past.step_before)
                                               : materials::TimeScheme::backward_euler(past.step);
      const double current = source().current(volts, state.voltage[0]);
      Eigen::VectorXd entering = (scheme.a0 * q - scheme.h1 * q_before - scheme.h2 * q_older) / scheme.dt;
      for (Eigen::Index a = 0; a < q.size(); ++a)
        entering[a] += point(*model, a).leakage * (state.voltage[0] - state.sheet_drop[a]);
      for (const auto& entry : model->sheet_matrices(state).conductance)
        entering[entry.row()] -= entry.value() * state.sheet_drop[entry.col()];
      for (Eigen::Index a = 0; a < q.size(); ++a)
        EXPECT_NEAR(entering[a], point(*model, a).at_terminal ? current : 0, 1e-10 * volts / resistance)
            << state.time / tau << " " << a;
      limited += current == volts / resistance;
      ++times;
      q_older = q_before;
      q_before = q;
    }
    return true;
  };
  ASSERT_EQ(ramp(equilibrium, step_voltage(), timed, progress, observer).end, RampEnd::complete);
  EXPECT_GT(times, 20);
  EXPECT_GT(limited, 2);
  const State& end = progress.points.back().state;
  EXPECT_GT(end.displacement[24].norm(), 0.01 * side);
  EXPECT_GT(end.sheet_drop.maxCoeff(), 1e-3 * volts); // what leaks has to flow
}

TEST_F(ResistingFilm, in_the_end_it_is_as_without_resistance) {
  const auto plain = film(false), model = film(true);
  Equilibrium without(*plain, 1), with(*model, 1);
  State expected = plain->initial_state();
  expected.voltage = {volts};
  ASSERT_EQ(without.solve(expected, {.tolerance = 1e-12}).outcome, Outcome::converged);
  const RampOptions timed = options(200 * tau);
  RampProgress progress = RampProgress::begin(model->initial_state(), model->dofs, timed);
  ASSERT_EQ(ramp(with, step_voltage(), timed, progress, {}).end, RampEnd::complete);
  State relaxed = model->initial_state();
  relaxed.scheme = materials::TimeScheme::relaxed();
  relaxed.voltage = {volts};
  ASSERT_EQ(with.solve(relaxed, {.tolerance = 1e-12}).outcome, Outcome::converged);
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    const Eigen::Vector3d& u = expected.displacement[a];
    EXPECT_LT((progress.points.back().state.displacement[a] - u).norm(), 1e-8 * side);
    EXPECT_LT((relaxed.displacement[a] - u).norm(), 1e-12 * side);
  }
}

TEST_F(ResistingFilm, energy_is_stored_or_turned_into_heat_in_the_electrode) {
  const auto model = film(true, {source()});
  Equilibrium equilibrium(*model, 1);
  LoadPath path;
  path.apply = [](State& state, double s) { state.source = {volts * s}; };
  std::vector<double> errors;
  for (const double tolerance : {1e-5, 1e-7}) {
    RampOptions timed = options(3 * tau);
    timed.time_tolerance = tolerance;
    State start = model->initial_state();
    start.supply[0] = Supply::circuit;
    RampProgress progress = RampProgress::begin(start, model->dofs, timed);
    EnergyBalance balance;
    balance.add(energy_point(equilibrium, start, 0));
    State last = start;
    RampObserver observer;
    observer.on_accept = [&](const RampProgress& at, const Increment& increment) {
      test::account(balance, equilibrium, last, at.points.back().state, increment);
      last = at.points.back().state;
      return true;
    };
    ASSERT_EQ(ramp(equilibrium, path, timed, progress, observer).end, RampEnd::complete);
    const Work work = balance.work();
    errors.push_back(balance.error() / work.electrical);
    EXPECT_GT(work.dissipated, 0.5 * work.electrical);
  }
  EXPECT_LT(errors[0], 1e-3);
  EXPECT_LT(errors[1], errors[0] / 5);
}

TEST_F(ResistingFilm, goes_on_from_its_history_alone) {
  const auto model = film(true, {source()}, test::viscoelastic_vhb());
  Equilibrium equilibrium(*model, 1);
  State start = model->initial_state();
  start.supply[0] = Supply::circuit;
  const RampOptions timed = options(3 * tau);
  RampProgress whole = RampProgress::begin(start, model->dofs, timed), part = whole;
  ASSERT_EQ(ramp(equilibrium, step_voltage(), timed, whole, {}).end, RampEnd::complete);
  int accepted = 0;
  RampObserver observer;
  observer.on_accept = [&](const RampProgress&, const Increment&) { return ++accepted < 9; };
  ASSERT_EQ(ramp(equilibrium, step_voltage(), timed, part, observer).end, RampEnd::stopped);
  for (PathPoint& point : part.points) point.state.sheet_drop = {};
  ASSERT_EQ(ramp(equilibrium, step_voltage(), timed, part, {}).end, RampEnd::complete);
  const State &a = whole.points.back().state, &b = part.points.back().state;
  EXPECT_EQ(a.displacement, b.displacement);
  EXPECT_EQ(a.voltage, b.voltage);
  EXPECT_EQ(a.sheet_drop, b.sheet_drop);
  EXPECT_GT(a.sheet_drop.maxCoeff(), 0.01 * volts);
}

TEST_F(ResistingFilm, charges_stay_where_no_time_passes) {
  const auto model = film(true);
  Equilibrium equilibrium(*model, 1);
  State state = model->initial_state();
  state.scheme = materials::TimeScheme::relaxed();
  state.voltage = {volts / 2};
  ASSERT_EQ(equilibrium.solve(state, {}).outcome, Outcome::converged);
  state = model->settled(state);
  const Eigen::VectorXd before = sheet_charges(*model, state);
  state.voltage = {volts};
  ASSERT_EQ(equilibrium.solve(state, {}).outcome, Outcome::converged);
  const Eigen::VectorXd after = sheet_charges(*model, state);
  for (Eigen::Index a = 0; a < before.size(); ++a)
    if (point(*model, a).at_terminal)
      EXPECT_GT(after[a], 1.5 * before[a]);
    else
      EXPECT_NEAR(after[a], before[a], 1e-12 * before.maxCoeff());
}

TEST_F(ResistingFilm, only_the_terminal_follows_a_jump_of_the_voltage_at_once_when_masses_rest) {
  const auto model = film(true);
  Equilibrium equilibrium(*model, 1);
  RampOptions timed = options(1e-2 * tau);
  timed.inertia = true;
  RampProgress progress = RampProgress::begin(model->initial_state(), model->dofs, timed);
  RampObserver observer;
  observer.on_accept = [](const RampProgress&, const Increment& increment) {
    return increment.load_factor > 0;
  };
  ASSERT_EQ(ramp(equilibrium, step_voltage(), timed, progress, observer).end, RampEnd::stopped);
  const State& state = progress.points.back().state;
  EXPECT_EQ(state.voltage[0], volts);
  const Eigen::VectorXd q = sheet_charges(*model, state);
  for (Eigen::Index a = 0; a < q.size(); ++a)
    EXPECT_NEAR(q[a], point(*model, a).at_terminal ? q.sum() : 0, 1e-12 * q.sum());
}

TEST_F(ResistingFilm, does_not_touch_electrodes_that_are_no_sheets) {
  std::vector<int> electrodes(32, 0);
  std::fill(electrodes.begin() + 16, electrodes.end(), 1);
  std::vector<State> states;
  for (const bool sheet : {false, true}) {
    const auto model = test::square_film(mesh, side, test::Held::along_edge, electrodes);
    model->ports = {{"plain"}, {"sheet"}};
    if (sheet) model->ports[1].sheet = {.resistance = resistance, .terminal = mesh.node_sets.at("edge")};
    model->place_histories();
    Equilibrium equilibrium(*model, 1);
    states.push_back(model->initial_state());
    states.back().scheme = materials::TimeScheme::relaxed();
    states.back().voltage = {volts, 0};
    ASSERT_EQ(equilibrium.solve(states.back(), {}).outcome, Outcome::converged);
  }
  EXPECT_EQ(states[0].displacement, states[1].displacement);
  EXPECT_GT(states[0].displacement[12].norm(), 0);
}

TEST_F(ResistingFilm, must_be_connected) {
  auto model = film(true);
  model->ports[0].sheet->terminal = {25}; // the middle of a side
  EXPECT_THROW(model->place_histories(), std::invalid_argument);
  model->ports[0].sheet->terminal.clear();
  EXPECT_THROW(model->place_histories(), std::invalid_argument);
  model->ports[0].sheet->terminal = {0};
  model->ports[0].sheet->resistance = 0;
  EXPECT_THROW(model->place_histories(), std::invalid_argument);

  std::vector<int> apart(32, passive);
  apart.front() = apart.back() = 0;
  auto parts = test::unnumbered_model(
      mesh.node_count(), true,
      make_membrane_block(mesh, mesh.blocks[0], test::vhb(), apart, Dimension::planar, 3));
  parts->ports[0].sheet = {.resistance = resistance, .terminal = {0}};
  parts->place_histories();
  parts->dofs.number();
  EXPECT_THROW(SheetConduction{*parts}, std::invalid_argument);
}

} // namespace
} // namespace dielast::fem::sheet_conduction_test
