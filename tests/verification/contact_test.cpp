// SPDX-License-Identifier: GPL-3.0-or-later
// Contact against closed forms: Hertz's pressures, a heavy strip lifted off a table.
#include "fem/contact/plane_contact_block.hpp"
#include "fem/elements/beam_block.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/paths/ramp.hpp"
#include "fem/solids/solid_block.hpp"
#include "meshing/solids/grid.hpp"
#include "meshing/solids/sides.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dielast::fem::contact_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double mu = 45e3, contact_modulus = 4 * mu; ///< E / (1 - nu^2), incompressible

/// Half of a block, 0.4 long and high, whose underside is that of a cylinder or a sphere of radius 1 about
/// the axis x = 0, is pressed on a plane.
struct Indenter {
  explicit Indenter(Dimension dimension) : up(dimension == Dimension::axisymmetric ? 2 : 1) {
    constexpr double size = 0.4, finest = 1e-3, thickness = 2e-6;
    const std::vector<double> lines = meshing::graded_line({0, size}, {0}, finest, size / 6);
    meshing::TriangleGrid grid(lines, lines, [&](double u, double v) -> Eigen::Vector3d {
      return u * Eigen::Vector3d::UnitX() + (v + u * u / 2 * (1 - v / size)) * Eigen::Vector3d::Unit(up);
    });
    grid.name_nodes("axis", [](double u, double) { return u == 0; });
    grid.name_nodes("bottom", [](double, double v) { return v == 0; });
    grid.name_nodes("top", [](double, double v) { return v == size; });
    mesh = grid.take();
    SolidCells cells{mesh.blocks[0], {}, {}};
    cells.electrodes.assign(static_cast<std::size_t>(cells.elements.size()), passive);
    cells.sections.assign(cells.electrodes.size(), 0);
    const SolidSection section{.material = {.law = materials::NeoHookean{mu}}, .thickness = 1};
    contact = surface_of(mesh, meshing::sides_at(mesh, "bottom", meshing::CellType::meridian3),
                         dimension == Dimension::axisymmetric ? std::nullopt : std::optional(1.0));
    contact.normal = Eigen::Vector3d::Unit(up);
    contact.origin = -thickness * contact.normal;
    contact.barrier = {thickness, 0.1 * mu / thickness, 1};
    model.dofs = DofMap(mesh.node_count());
    model.blocks.push_back(make_solid_block(mesh, cells, {section}, {}, dimension));
    model.blocks.push_back(make_plane_contact_block(mesh, contact));
    for (const auto& block : model.blocks) {
      block->place_scalars(model.dofs);
      block->claim_dofs(model.dofs, dimension);
    }
    for (const int node : mesh.node_sets.at("axis")) model.dofs.hold(node, 0);
    for (const int node : mesh.node_sets.at("top"))
      for (const int c : {0, up}) model.dofs.hold(node, c);
    model.dofs.number();
    model.place_histories();
    model.extent = size;
    model.length_scale = finest;
  }
  State press(double depth) {
    Equilibrium equilibrium(model, 1);
    const State start = model.initial_state();
    LoadPath path;
    path.apply = [&](State& state, double s) {
      for (const int node : mesh.node_sets.at("top"))
        state.displacement[static_cast<std::size_t>(node)][up] = -s * depth;
    };
    const RampOptions options{
        .newton = {.tolerance = 1e-8, .max_iterations = 80}, .increments = 10, .smallest_increment = 1e-6};
    RampProgress progress = RampProgress::begin(start, model.dofs, options);
    RampObserver observer;
    observer.on_accept = [&](const RampProgress& at, const Increment&) {
      EXPECT_TRUE(model.blocks[1]
                      ->evaluate(at.points.back().state, 0, model.blocks[1]->element_count(), {})
                      .feasible);
      return true;
    };
    EXPECT_EQ(ramp(equilibrium, path, options, progress, observer).end, RampEnd::complete);
    return progress.points.back().state;
  }
  /// Force, and mean of x^2 weighted with the pressure.
  std::pair<double, double> pressed(const State& state) const {
    double force = 0, second = 0;
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const auto n = static_cast<std::size_t>(contact.nodes[i]);
      const Eigen::Vector3d x = mesh.nodes[n] + state.displacement[n];
      const double here =
          -contact.areas[i] * contact.barrier.at((x - contact.origin).dot(contact.normal)).slope;
      force += here;
      second += here * x.x() * x.x();
    }
    EXPECT_NEAR(force, contact_force(model, state), 1e-12 * force);
    return {force, second / force};
  }

  int up;
  meshing::Mesh mesh;
  PlaneContact contact;
  Model model{.dofs = DofMap(0)};
};

/// Johnson, Contact Mechanics, 4.2: p ~ sqrt(1 - x^2/a^2), whose mean x^2 is a^2/4, and
/// F = pi E* a^2 / (4 R) per length.
TEST(Contact, cylinder_on_a_plane_bears_the_force_of_hertz) {
  Indenter cylinder(Dimension::planar);
  const auto [half, second] = cylinder.pressed(cylinder.press(6e-4));
  EXPECT_GT(std::sqrt(4 * second), 0.015);
  RecordProperty("force over Hertz", std::to_string(2 * half / (pi * contact_modulus * second)));
  EXPECT_NEAR(2 * half, pi / 4 * contact_modulus * 4 * second, 0.02 * 2 * half);
}

/// The mean r^2 of a sphere's pressures is 2 a^2 / 5, and F = 4 E* a^3 / (3 R).
TEST(Contact, sphere_on_a_plane_bears_the_force_of_hertz) {
  Indenter sphere(Dimension::axisymmetric);
  const auto [force, second] = sphere.pressed(sphere.press(6e-4));
  const double a = std::sqrt(2.5 * second);
  RecordProperty("force over Hertz", std::to_string(force / (4.0 / 3 * contact_modulus * a * a * a)));
  EXPECT_GT(a, 0.015);
  EXPECT_NEAR(force, 4.0 / 3 * contact_modulus * a * a * a, 0.02 * force);
}

/// A heavy strip on a table, lifted at one end by w: a length l = (24 EI w / q)^(1/4) leaves the table, half
/// of whose weight the hand bears, as the strip has neither slope nor curvature where it still lies.
TEST(Contact, strip_lifted_off_a_table_weighs_what_the_closed_form_says) {
  constexpr int beams = 80;
  constexpr double length = 10, weight = 1e-3, bending = 1, thickness = 1e-5;
  meshing::Mesh mesh;
  meshing::CellBlock lines{meshing::CellType::line3, {}};
  std::vector<double> share(2 * beams + 1, 0);
  for (int n = 0; n <= 2 * beams; ++n) mesh.nodes.emplace_back(length * n / (2 * beams), 0, 0);
  for (int e = 0; e < beams; ++e) {
    lines.nodes.insert(lines.nodes.end(), {2 * e, 2 * e + 2, 2 * e + 1});
    for (const auto& [node, part] : {std::pair{2 * e, 1.0 / 6}, {2 * e + 1, 4.0 / 6}, {2 * e + 2, 1.0 / 6}})
      share[static_cast<std::size_t>(node)] += part * length / beams;
  }
  mesh.blocks = {lines};
  PlaneContact contact{.areas = share, .barrier = {thickness, 10 / thickness, 1}};
  contact.origin.y() = -thickness;
  for (int n = 0; n <= 2 * beams; ++n) contact.nodes.push_back(n);
  Model model{.dofs = DofMap(mesh.node_count())};
  const materials::BeamSection section{
      .EA = 1e5, .GA2 = 1e5, .GA3 = 1e5, .GJ = bending, .EI2 = bending, .EI3 = bending};
  model.blocks.push_back(make_beam_block(mesh, mesh.blocks[0], section));
  model.blocks.push_back(make_plane_contact_block(mesh, contact));
  for (const auto& block : model.blocks) block->claim_dofs(model.dofs, Dimension::planar);
  model.dofs.hold(0, 0);
  model.dofs.hold(2 * beams, 1);
  model.dofs.number();
  model.place_histories();
  model.extent = length;
  model.length_scale = length / beams;
  Equilibrium equilibrium(model, 1);
  const auto put = [&](State& state, double w) {
    for (int n = 0; n <= 2 * beams; ++n)
      state.dead_force[model.dofs.equation(n, 1)] = -weight * share[static_cast<std::size_t>(n)];
    state.displacement[2 * beams].y() = w;
  };
  State start = model.initial_state();
  put(start, 0);
  ASSERT_EQ(equilibrium.solve(start, {.tolerance = 1e-9, .max_iterations = 60}).outcome, Outcome::converged);
  LoadPath path;
  path.apply = [&](State& state, double s) { put(state, 0.026 * s); };
  const RampOptions options{.newton = {.tolerance = 1e-9, .max_iterations = 60}, .increments = 10};
  RampProgress progress = RampProgress::begin(start, model.dofs, options);
  ASSERT_EQ(ramp(equilibrium, path, options, progress, {}).end, RampEnd::complete) << progress.load_factor;
  const State& state = progress.points.back().state;
  Eigen::VectorXd force;
  equilibrium.internal_force(state, force);
  const int hand = model.dofs.equation(2 * beams, 1);
  const double lifted = std::pow(24 * bending * state.displacement[2 * beams].y() / weight, 0.25);
  RecordProperty("force over closed form",
                 std::to_string((force[hand] - state.dead_force[hand]) / (weight * lifted / 2)));
  EXPECT_NEAR(force[hand] - state.dead_force[hand], weight * lifted / 2, 0.01 * weight * lifted / 2);
  EXPECT_NEAR(contact_force(model, state), weight * (length - lifted / 2), 0.01 * weight * length);
}

} // namespace
} // namespace dielast::fem::contact_test
