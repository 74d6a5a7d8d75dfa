// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::beam_patch_test {
namespace {

/// Cantilever of unit length along x, clamped at the first node, four unequal elements, with a dead load at
/// its tip.
class BeamPatch : public ::testing::TestWithParam<int> {
 protected:
  const meshing::Mesh mesh = test::line(
      4, GetParam(), [](double s) { return Eigen::Vector3d(s, 0, 0); },
      [](double t) { return t * (0.3 + 0.7 * t); });
  std::unique_ptr<Model> model = [this] {
    auto m =
        test::unnumbered_model(mesh.node_count(), false, make_beam_block(mesh, mesh.blocks[0], section()));
    for (int c = 0; c < DofMap::components; ++c) m->dofs.hold(0, c);
    m->dofs.number();
    return m;
  }();
  Equilibrium equilibrium{*model, 1};

  static materials::BeamSection section() {
    materials::BeamSection section = test::uneven_section();
    section.half_width = 0.02;
    section.half_height = 0.05;
    return section;
  }

  State loaded(int component, double load) {
    State state = model->initial_state();
    state.dead_force[model->dofs.equation(mesh.node_count() - 1, component)] = load;
    EXPECT_EQ(equilibrium.solve(state, {.tolerance = 1e-13, .max_iterations = 20}).outcome,
              Outcome::converged);
    return state;
  }
};

TEST_P(BeamPatch, finite_stretch_is_exact) {
  const double force = 4;
  const State state = loaded(0, force);
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    const Eigen::Vector3d expected(force / test::uneven_section().EA * mesh.nodes[a].x(), 0, 0);
    EXPECT_LT((state.displacement[a] - expected).norm(), 1e-13);
  }
  for (const BeamSample& sample : model->sample(state).walls) EXPECT_NEAR(sample.force[0], force, 1e-12);
}

// A moment at the tip: one curvature everywhere, x' = tangent. Small, because interpolated quaternions follow
// a finite constant curvature only as the elements shrink.
TEST_P(BeamPatch, constant_small_twist_and_curvature_are_exact) {
  const materials::BeamSection section = test::uneven_section();
  const std::array<double, 3> stiffness{section.GJ, section.EI2, section.EI3};
  for (int axis = 0; axis < 3; ++axis) {
    const double moment = 1e-5, kappa = moment / stiffness[static_cast<std::size_t>(axis)];
    const State state = loaded(3 + axis, moment);
    for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
      const double s = mesh.nodes[a].x();
      const Eigen::Vector3d spin = kappa * s * Eigen::Vector3d::Unit(axis);
      EXPECT_LT((spin_of(state.rotation[a]) - spin).norm(), 1e-9 * kappa);
      const Eigen::Vector3d deflection = 0.5 * s * spin.cross(Eigen::Vector3d::UnitX());
      EXPECT_LT((state.displacement[a] - deflection).tail<2>().norm(), 1e-9 * kappa);
    }
    for (const BeamSample& sample : model->sample(state).walls) {
      EXPECT_NEAR(sample.moment[axis], moment, 1e-9 * moment);
      EXPECT_LT(sample.strain.norm(), 1e-9 * kappa);
    }
  }
}

// A transverse tip load bends linearly: two-node elements have the exact section forces in their middle,
// three-node ones the exact deflection F s^2 (3 - s) / 6 EI + F s / GA at the corners and the exact strain of
// the outermost fibre at the ends of elements.
TEST_P(BeamPatch, small_transverse_load) {
  const materials::BeamSection section = this->section();
  const double force = 1e-6;
  const State in_plane = loaded(1, force), out_of_plane = loaded(2, force);
  for (const BeamSample& sample : model->sample(in_plane).walls)
    EXPECT_NEAR(sample.force[1], force, 1e-6 * force);
  for (const BeamSample& sample : model->sample(out_of_plane).walls)
    EXPECT_NEAR(sample.force[2], force, 1e-6 * force);
  if (GetParam() == 1) return;
  const auto at_clamp = [this](const State& state) {
    return model->sample(state).walls.front().fibre_strain;
  };
  EXPECT_NEAR(at_clamp(in_plane), force * section.half_width / section.EI3, 1e-9 * force);
  EXPECT_NEAR(at_clamp(out_of_plane), force * section.half_height / section.EI2, 1e-9 * force);
  for (std::size_t a = 0; a < mesh.nodes.size(); a += 2) {
    const double s = mesh.nodes[a].x(), bend = s * s * (3 - s) / 6;
    EXPECT_NEAR(in_plane.displacement[a].y(), force * (bend / section.EI3 + s / section.GA2), 1e-9 * force);
    EXPECT_NEAR(out_of_plane.displacement[a].z(), force * (bend / section.EI2 + s / section.GA3),
                1e-9 * force);
  }
}

INSTANTIATE_TEST_SUITE_P(Order, BeamPatch, ::testing::Values(1, 2), ::testing::PrintToStringParamName());

} // namespace
} // namespace dielast::fem::beam_patch_test
