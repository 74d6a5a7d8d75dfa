// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/plane_contact_block.hpp"

#include "fem/elements/point_mass_block.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/solids/solid_block.hpp"
#include "meshing/meridian.hpp"
#include "meshing/solids/sides.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"
#include "tests/fem/timed_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

namespace dielast::fem::plane_contact_block_test {
namespace {

constexpr double mu = 45e3;

/// Points above a plane that leans against y, at a quarter of the barrier's thickness.
struct Points {
  explicit Points(double friction, double gap = 0.05) {
    std::mt19937 random(3);
    PlaneContact contact{
        .normal = Eigen::Vector3d(0.3, 0.9, -0.2).normalized(), .barrier = {0.2, 7}, .friction = friction};
    for (int n = 0; n < 3; ++n) {
      const Eigen::Vector3d x = test::random_vector(random, 3);
      mesh.nodes.emplace_back(x + (gap - x.dot(contact.normal)) * contact.normal);
      contact.nodes.push_back(n);
      contact.areas.push_back(0.5 + n);
    }
    model = test::unnumbered_model(3, Dimension::spatial, make_plane_contact_block(mesh, std::move(contact)));
    for (int n = 0; n < 3; ++n)
      for (int c = 0; c < 3; ++c) model->dofs.add(n, c);
    model->dofs.number();
  }
  /// With the normal forces of the state as drawn, which touches, the nodes moved at random.
  State shaken(double amplitude) const {
    State state = model->initial_state();
    state.scheme = materials::TimeScheme::relaxed();
    state = model->settled(std::move(state));
    state.scheme = materials::TimeScheme::relaxed();
    std::mt19937 random(4);
    for (auto& u : state.displacement) u = test::random_vector(random, 3, amplitude);
    return state;
  }

  meshing::Mesh mesh;
  std::unique_ptr<Model> model;
};

/// Free, stuck, and sliding: there the tangent is firmer along the way.
TEST(PlaneContact, residual_and_tangent_are_the_derivatives_of_the_energy) {
  for (const double friction : {0.0, 0.4}) {
    const Points points(friction);
    test::expect_consistent_derivatives(*points.model, points.shaken(0.02), 0.02, 1e-7);
  }
  const Points points(0.02);
  const State state = points.shaken(0.02);
  Assembler assembler(*points.model, 1);
  Eigen::VectorXd residual, ahead;
  assembler.residual(state, residual);
  assembler.tangent(state);
  const Eigen::MatrixXd K = test::dense(assembler.matrix());
  for (int node = 0; node < 3; ++node) {
    const Eigen::Vector3d normal = Eigen::Vector3d(0.3, 0.9, -0.2).normalized(),
                          force = residual.segment<3>(3 * node),
                          friction = force - force.dot(normal) * normal;
    State further = state;
    further.displacement[static_cast<std::size_t>(node)] += 1e-6 * friction.normalized();
    assembler.residual(further, ahead);
    EXPECT_LT((ahead - residual).norm(), 1e-9 * friction.norm()); // no stiffness along its way
    const double firmer =
        friction.normalized().dot(K.block<3, 3>(3 * node, 3 * node) * friction.normalized());
    EXPECT_GT(firmer, 0);
    EXPECT_LT(firmer, friction.norm() / 0.005);
  }
}

/// Nodes stop at a tenth of their gap before the plane, and may leave it.
TEST(PlaneContact, way_ends_before_the_plane) {
  const Points points(0, 0.3);
  const Eigen::Vector3d down = -Eigen::Vector3d(0.3, 0.9, -0.2).normalized();
  const State from = points.model->initial_state();
  State to = from;
  to.displacement[1] = 0.6 * down;
  EXPECT_NEAR(free_way(*points.model, from, to), 0.9 * 0.3 / 0.6, 1e-12);
  to.displacement[1] = -0.6 * down;
  EXPECT_EQ(free_way(*points.model, from, to), 1);
  to.displacement[1] = 0.3001 * down;
  EXPECT_FALSE(points.model->blocks[0]->evaluate(to, 0, 3, {}).feasible);
}

/// A block of film's material, in plane strain on a plane.
struct Block {
  Block(meshing::Mesh of, double friction, double thickness) : mesh(std::move(of)) {
    for (int n = 0; n < mesh.node_count(); ++n) {
      const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(n)];
      if (x.y() < 1e-9) mesh.node_sets["bottom"].push_back(n);
      if (x.y() > 1 - 1e-9) mesh.node_sets["top"].push_back(n);
    }
    SolidCells cells{mesh.blocks[0], {}, {}};
    cells.electrodes.assign(static_cast<std::size_t>(cells.elements.size()), passive);
    cells.sections.assign(cells.electrodes.size(), 0);
    const SolidSection section{.material = test::vhb().material, .thickness = 1};
    bottom = surface_of(mesh, meshing::sides_at(mesh, "bottom", meshing::CellType::meridian3), 1);
    PlaneContact contact = bottom;
    contact.origin = {0, -thickness, 0};
    contact.barrier = {thickness, 0.03 * mu / thickness, 1};
    contact.friction = friction;
    model = test::unnumbered_model(mesh.node_count(), Dimension::planar,
                                   make_solid_block(mesh, cells, {section}, {}, Dimension::planar),
                                   make_plane_contact_block(mesh, std::move(contact)));
    model->extent = std::sqrt(2.0);
    model->length_scale = 0.3;
  }
  /// The sides of the top carry this traction, Pa.
  void press(State& state, const Eigen::Vector2d& traction) const {
    const PlaneContact top =
        surface_of(mesh, meshing::sides_at(mesh, "top", meshing::CellType::meridian3), 1);
    for (std::size_t i = 0; i < top.nodes.size(); ++i)
      for (int c = 0; c < 2; ++c)
        state.dead_force[model->dofs.equation(top.nodes[i], c)] = top.areas[i] * traction[c];
  }

  meshing::Mesh mesh;
  PlaneContact bottom;
  std::unique_ptr<Model> model;
};

/// Pressed uniformly and free to slide, a distorted mesh is deformed homogeneously: the plane bears the same
/// pressure everywhere.
TEST(PlaneContact, passes_the_patch_test) {
  Block block(test::distorted_square(3, 2), 0, 1e-3);
  block.model->dofs.hold(block.bottom.nodes.front(), 0);
  block.model->dofs.number();
  Equilibrium equilibrium(*block.model, 1);
  State state = block.model->initial_state();
  for (const double pressure : {0.02 * mu, 0.1 * mu, 0.2 * mu}) {
    block.press(state, {0, -pressure});
    ASSERT_EQ(equilibrium.solve(state, {.tolerance = 1e-12, .max_iterations = 60}).outcome,
              Outcome::converged);
    EXPECT_NEAR(contact_force(*block.model, state), pressure, 1e-9 * pressure);
  }
  const double sunk = state.displacement[static_cast<std::size_t>(block.bottom.nodes.front())].y();
  for (const int node : block.bottom.nodes)
    EXPECT_NEAR(state.displacement[static_cast<std::size_t>(node)].y(), sunk, 1e-6 * std::abs(sunk));
  for (const MembraneSample& sample : block.model->sample(state).film) {
    const Eigen::Matrix3d expected = -0.2 * mu / sample.solid->F(0, 0) * Eigen::Matrix3d::Identity();
    EXPECT_NEAR(sample.solid->cauchy(1, 1), expected(1, 1), 1e-6 * mu);
    EXPECT_NEAR(sample.solid->cauchy(0, 0), 0, 1e-6 * mu);
  }
}

/// Pressed on the plane, whose slope then grows: the block sticks until the slope is the coefficient.
TEST(PlaneContact, block_on_an_incline_sticks_and_slips_at_the_right_angle) {
  constexpr double friction = 0.3, pressure = 0.05 * mu;
  meshing::Mesh wide = test::distorted_square(3, 2);
  for (auto& x : wide.nodes) x.x() *= 3; // does not tip
  Block block(std::move(wide), friction, 1e-3);
  block.model->dofs.number();
  Equilibrium equilibrium(*block.model, 1);
  const auto climb = [&](double from, double to, State state) {
    LoadPath path;
    path.apply = [&, from, to](State& at, double s) {
      const double angle = from + s * (to - from), part = to > 0 ? 1 : s;
      block.press(at, part * pressure * Eigen::Vector2d(std::sin(angle), -std::cos(angle)));
    };
    const RampOptions options{.newton = {.tolerance = 1e-10, .max_iterations = 60},
                              .increments = to > 0 ? 50 : 4,
                              .smallest_increment = 1e-4};
    RampProgress progress = RampProgress::begin(state, block.model->dofs, options);
    const RampResult result = ramp(equilibrium, path, options, progress, {});
    const double reached = from + progress.load_factor * (to - from);
    return std::tuple(result.end, reached, progress.points.back().state);
  };
  const auto [put, level, down] = climb(0, 0, block.model->initial_state());
  ASSERT_EQ(put, RampEnd::complete);
  const double slope = std::atan(friction);
  const auto [sticks, below, there] = climb(0, 0.98 * slope, down);
  EXPECT_EQ(sticks, RampEnd::complete);
  EXPECT_GT(below, 0.97 * slope);
  const auto [slips, above, last] = climb(0.98 * slope, 1.1 * slope, there);
  EXPECT_EQ(slips, RampEnd::gave_up);
  EXPECT_NEAR(above, slope, 2e-3 * slope);
}

/// A mass that falls on the plane comes back with the energy that it had.
TEST(PlaneContact, bounce_conserves_the_energy) {
  constexpr double mass = 0.01, fall = 0.1, g = 9.81;
  const meshing::Mesh mesh{{{0, fall, 0}}, {}, {}, {}};
  PlaneContact contact{.nodes = {0}, .areas = {1e-4}, .barrier = {0.01, 1e9}};
  auto model = test::unnumbered_model(1, true, make_plane_contact_block(mesh, std::move(contact)),
                                      make_point_mass_block({{.node = 0, .axis = 1, .mass = mass}}));
  model->dofs.number();
  model->extent = fall;
  Equilibrium equilibrium(*model, 1);
  State start = model->initial_state();
  start.dead_force[0] = -mass * g;
  const test::TimedRun run = test::run_in_time(equilibrium, start, test::constant_loads(model->dofs, start),
                                               {.newton = {.tolerance = 1e-12},
                                                .increments = 10,
                                                .duration = 0.25,
                                                .time_tolerance = 1e-10,
                                                .first_time_step = 1e-4,
                                                .inertia = true,
                                                .high_frequencies = 1});
  double lowest = fall, worst = 0;
  for (const State& state : run.states) {
    const double height = fall + state.displacement[0].y();
    const double speed = state.motion ? state.motion->velocity[0] : 0;
    EXPECT_GT(height, 0);
    lowest = std::min(lowest, height);
    const double energy = mass * (g * height + speed * speed / 2) + model->energies(state).elastic;
    worst = std::max(worst, std::abs(energy / (mass * g * fall) - 1));
  }
  EXPECT_LT(lowest, 0.01);                               // it has touched the barrier
  EXPECT_GT(fall + run.end().displacement[0].y(), 0.05); // and is on its way back
  EXPECT_LT(worst, 1e-6);
}

/// A tube of film of fixed length on a core, prestretched along it and around it, its ends free to grow.
struct Tube {
  static constexpr double radius = 5e-3, length = 20e-3, along = 2, around = 0.75, thickness = 1e-6;

  explicit Tube(int order) : mesh(meshing::roll_meridian(length, radius, length, 6, order)) {
    const MembraneSection section = test::vhb(along, around);
    PlaneContact core = surface_of(mesh, mesh.blocks[0], std::nullopt);
    core.normal = Eigen::Vector3d::UnitX();
    core.origin = {radius - thickness, 0, 0};
    core.barrier = {thickness, mu * section.thickness / radius / thickness, 1};
    model = test::unnumbered_model(
        mesh.node_count(), Dimension::axisymmetric,
        make_membrane_block(mesh, mesh.blocks[0], section,
                            std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0),
                            Dimension::axisymmetric, order + 1),
        make_plane_contact_block(mesh, std::move(core)));
    for (const char* end : {"lower_end", "upper_end"}) model->dofs.hold(mesh.node_sets.at(end).front(), 2);
    model->dofs.number();
    model->extent = length;
    model->length_scale = length / 6;
  }
  /// Tension around the core per length along it, N/m, of neo-Hookean film at the hoop stretch around * s.
  static double tension(double s, double voltage) {
    const double l1 = along, l2 = around * s, l3 = 1 / (l1 * l2), film = 1e-3 * l3;
    return film * (mu * (l2 * l2 - l3 * l3) - 4e-11 * std::pow(voltage / film, 2));
  }

  meshing::Mesh mesh;
  std::unique_ptr<Model> model;
};

/// Pressed by the tension around it, the core bears tension over radius everywhere. Charged until that would
/// be compression, the film leaves it for the radius at which nothing is left around it, and nothing pulls.
TEST(PlaneContact, film_presses_on_its_core_and_lifts_where_it_would_pull) {
  constexpr double pi = std::numbers::pi, lifts = 10e3;
  for (const int order : {1, 2}) {
    Tube tube(order);
    Equilibrium equilibrium(*tube.model, 1);
    State state = tube.model->initial_state();
    for (const double voltage : {0.0, 4e3, 6e3, lifts, 4e3}) {
      SCOPED_TRACE(voltage);
      state.voltage = {voltage};
      ASSERT_EQ(equilibrium.solve(state, {.tolerance = 1e-12, .max_iterations = 100}).outcome,
                Outcome::converged);
      const double wider = state.displacement[0].x() / Tube::radius;
      for (const auto& u : state.displacement) EXPECT_NEAR(u.x() / Tube::radius, wider, 1e-9);
      if (voltage < lifts) {
        EXPECT_LT(wider, 0);
        EXPECT_GT(wider, -Tube::thickness / Tube::radius);
        EXPECT_NEAR(contact_force(*tube.model, state),
                    2 * pi * Tube::length * Tube::tension(1 + wider, voltage),
                    1e-8 * 2 * pi * Tube::length * Tube::tension(1, 0));
      } else {
        EXPECT_LT(Tube::tension(1, voltage), 0); // a core that held would pull
        const double c = 4e-11 * std::pow(voltage * Tube::along / 1e-3, 2) / mu;
        EXPECT_NEAR(Tube::around * (1 + wider), std::pow((1 - c) * Tube::along * Tube::along, -0.25), 1e-9);
        EXPECT_EQ(contact_force(*tube.model, state), 0);
      }
    }
  }
}

} // namespace
} // namespace dielast::fem::plane_contact_block_test
