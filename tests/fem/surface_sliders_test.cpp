// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/surface_sliders.hpp"

#include "fem/contact/face_contact_block.hpp"
#include "fem/contact/surface_contact_block.hpp"
#include "fem/model/assembler.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::surface_sliders_test {
namespace {

/// Two sides, or two faces, one above the other at a quarter of the barrier's thickness.
struct Rubbing {
  Rubbing(Dimension dimension, double friction) {
    const bool in_space = dimension == Dimension::spatial;
    const std::vector<Eigen::Vector3d> drawn =
        in_space ? std::vector<Eigen::Vector3d>{{0, 0, 0},      {1, 0, 0.01},  {0, 0, 1},
                                                {0.5, 0.02, 0}, {0.5, 0, 0.5}, {0, -0.01, 0.5}}
                 : std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0.02, 0}, {0.5, 0.01, 0}};
    std::array<meshing::CellBlock, 2> faces;
    for (std::size_t k = 0; k < 2; ++k) {
      faces[k].type = in_space ? meshing::CellType::triangle6 : meshing::CellType::meridian3;
      for (const Eigen::Vector3d& x : drawn) {
        faces[k].nodes.push_back(mesh.node_count());
        mesh.nodes.emplace_back(k == 0 ? x : Eigen::Vector3d(0.7 * x + Eigen::Vector3d(0.13, 0.05, 0.11)));
      }
    }
    const Barrier barrier{.thickness = 0.2, .stiffness = 7};
    const std::array<std::string, 2> names{"lower", "upper"};
    model = test::unnumbered_model(
        mesh.node_count(), dimension,
        in_space ? make_face_contact_block(mesh, {names, faces, barrier, friction})
                 : make_surface_contact_block(mesh, {names, faces, 1.0, barrier, friction}));
    for (int n = 0; n < mesh.node_count(); ++n)
      for (int c = 0; c < (in_space ? 3 : 2); ++c) model->dofs.add(n, c);
    model->dofs.number();
    model->place_histories();
    components = in_space ? 3 : 2;
    upper = faces[1].nodes;
  }
  /// Pressed as drawn, then moved at random, the upper one along as well.
  State moved(double amplitude, double along) const {
    State state = model->initial_state();
    state.scheme = materials::TimeScheme::relaxed();
    state = model->settled(std::move(state));
    state.scheme = materials::TimeScheme::relaxed();
    std::mt19937 random(4);
    for (auto& u : state.displacement)
      u.head(components) = test::random_vector(random, components, amplitude);
    for (const int node : upper) state.displacement[static_cast<std::size_t>(node)].x() += along;
    return state;
  }

  meshing::Mesh mesh;
  std::unique_ptr<Model> model;
  int components = 0;
  std::vector<int> upper;
};

TEST(SurfaceSliders, residual_and_tangent_are_the_derivatives_of_the_energy_where_they_stick) {
  for (const Dimension dimension : {Dimension::planar, Dimension::spatial}) {
    const Rubbing faces(dimension, 5);
    const State state = faces.moved(0.01, 0.02);
    EXPECT_GT(faces.model->energies(state).elastic,
              Rubbing(dimension, 0).model->energies(state).elastic); // springs are stretched
    test::expect_consistent_derivatives(*faces.model, state, 0.005, 1e-6);
  }
}

/// Between the two: what slides is held with the coefficient times the force that pressed it, and pushes the
/// other one as much; accepted, it keeps that force, and has made heat.
TEST(SurfaceSliders, slide_with_the_coefficient_times_the_force) {
  constexpr double friction = 0.2;
  for (const Dimension dimension : {Dimension::planar, Dimension::spatial}) {
    const Rubbing faces(dimension, friction), smooth(dimension, 0);
    State state = faces.moved(0, 0);
    const double pressed = contact_force(*faces.model, state);
    for (const int node : faces.upper) state.displacement[static_cast<std::size_t>(node)].x() = 0.05;
    const auto along = [&](const Rubbing& of, const State& at) {
      Assembler assembler(*of.model, 1);
      Eigen::VectorXd force;
      assembler.residual(at, force);
      double upper = 0, all = 0;
      for (int node = 0; node < of.mesh.node_count(); ++node) all += force[of.model->dofs.equation(node, 0)];
      for (const int node : of.upper) upper += force[of.model->dofs.equation(node, 0)];
      EXPECT_NEAR(all, 0, 1e-12 * pressed);
      return upper;
    };
    const double held = along(faces, state) - along(smooth, state);
    EXPECT_NEAR(held, friction * pressed, 0.03 * held); // not all of it is flat
    EXPECT_NEAR(friction_heat(*faces.model, state), 0, 1e-15 * held);
    const State accepted = faces.model->settled(state);
    EXPECT_NEAR(along(faces, accepted) - along(smooth, accepted), held, 0.01 * held);
    const double heat = friction_heat(*faces.model, accepted);
    EXPECT_GT(heat, 0);
    EXPECT_LT(heat, 0.05 * held);
    const double stored = faces.model->energies(accepted).elastic - smooth.model->energies(accepted).elastic;
    EXPECT_NEAR(heat + 2 * stored, 0.05 * held, 0.01 * heat); // force times way, the springs' half of theirs
  }
}

} // namespace
} // namespace dielast::fem::surface_sliders_test
