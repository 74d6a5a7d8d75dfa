// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/dual.hpp"
#include "tests/fem/beam_oracle.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::beam_element_test {
namespace {

struct Kind {
  int order;
  bool planar, curved;
};

std::string name(const ::testing::TestParamInfo<Kind>& info) {
  return std::string(info.param.order == 1 ? "two_nodes" : "three_nodes") +
         (info.param.planar ? "_planar" : "_spatial") + (info.param.curved ? "_curved" : "_straight");
}

Eigen::Vector3d straight(double s) { return {2 * s, s, 0}; }
Eigen::Vector3d arc(double s) { return {std::sin(2 * s), 1 - std::cos(2 * s), 0}; }
Eigen::Vector3d helix(double s) { return {std::sin(2 * s), 1 - std::cos(2 * s), s}; }

/// Three elements of unequal length.
meshing::Mesh chain(const Kind& kind) {
  return test::line(3, kind.order,
                    !kind.curved  ? straight
                    : kind.planar ? arc
                                  : helix,
                    [](double t) { return t * (0.6 + 0.4 * t); });
}

/// Nodes anywhere, turned together by up to about half a turn and against each other by up to 60 degrees.
State random_state(const Model& model, bool planar, std::mt19937& random) {
  State state = model.initial_state();
  const Eigen::Quaterniond common = test::random_rotation(random, 3);
  const double angle = test::random_vector(random, 1, 3)[0];
  for (std::size_t a = 0; a < state.displacement.size(); ++a) {
    state.displacement[a] = test::random_vector(random, 3, 0.5);
    state.rotation[a] = test::random_rotation(random, 1) * common;
    if (planar) {
      state.displacement[a].z() = 0;
      state.rotation[a] = rotation_of({0, 0, angle + test::random_vector(random, 1)[0]});
    }
  }
  return state;
}

class BeamElement : public ::testing::TestWithParam<Kind> {
 protected:
  const meshing::Mesh mesh = chain(GetParam());
  const std::unique_ptr<Model> model = test::free_model(
      mesh.node_count(), GetParam().planar, make_beam_block(mesh, mesh.blocks[0], test::uneven_section()));
};

TEST_P(BeamElement, as_drawn_is_free_of_stress) {
  Assembler assembler(*model, 1);
  Eigen::VectorXd residual;
  EXPECT_NEAR(assembler.residual(model->initial_state(), residual).energy, 0, 1e-28);
  EXPECT_LT(residual.norm(), 1e-14);
}

TEST_P(BeamElement, residual_and_tangent_are_the_derivatives_of_the_energy) {
  std::mt19937 random(41);
  for (int sample = 0; sample < 5; ++sample)
    test::expect_consistent_derivatives(*model, random_state(*model, GetParam().planar, random), 1);
}

INSTANTIATE_TEST_SUITE_P(All, BeamElement,
                         ::testing::Values(Kind{1, true, false}, Kind{1, true, true}, Kind{1, false, false},
                                           Kind{1, false, true}, Kind{2, true, false}, Kind{2, true, true},
                                           Kind{2, false, false}, Kind{2, false, true}),
                         name);

/// Energy of one element with Nodes nodes in dual numbers of its displacements and spins; exp(spin) by its
/// series, which is exact to the second order that a dual number carries.
template<int Nodes>
materials::Dual<6 * Nodes> element_energy(const meshing::Mesh& mesh, const State& state,
                                          const Eigen::Vector3d& normal) {
  using Unknowns = materials::Dual<6 * Nodes>;
  using Oracle = test::BeamOracle<Unknowns>;
  const auto shape = [](int a, double xi) {
    if constexpr (Nodes == 2) return a == 0 ? (1 - xi) / 2 : (1 + xi) / 2;
    return a == 0 ? xi * (xi - 1) / 2 : a == 1 ? xi * (xi + 1) / 2 : 1 - xi * xi;
  };
  // Exact for quadratics.
  const auto slope = [&](int a, double xi) { return (shape(a, xi + 0.5) - shape(a, xi - 0.5)); };
  const std::array<double, 3> node_place{-1, 1, 0};

  std::array<Eigen::Quaterniond, Nodes> triad;
  for (int a = 0; a < Nodes; ++a) {
    Eigen::Vector3d tangent = Eigen::Vector3d::Zero();
    for (int b = 0; b < Nodes; ++b) tangent += slope(b, node_place[a]) * mesh.nodes[b];
    Eigen::Matrix3d axes;
    axes.col(0) = tangent.normalized();
    axes.col(1) = normal.cross(axes.col(0)).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    triad[a] = Eigen::Quaterniond(axes);
    if (triad[a].dot(triad[0]) < 0) triad[a].coeffs() *= -1;
  }
  const materials::BeamSection section = test::uneven_section();
  const std::array<double, 6> stiffness{section.EA, section.GA2, section.GA3,
                                        section.GJ, section.EI2, section.EI3};

  const auto strain = [&](double xi, double length, bool drawn) {
    typename Oracle::Vector dx;
    typename Oracle::Quaternion q, dq;
    for (int a = 0; a < Nodes; ++a) {
      Eigen::Vector3d x = mesh.nodes[a];
      Eigen::Quaterniond p = triad[a];
      if (!drawn) {
        x += state.displacement[a];
        p = state.rotation[a] * p;
      }
      std::array<Unknowns, 3> half_spin;
      Unknowns square = 0;
      for (int c = 0; c < 3 && !drawn; ++c) {
        half_spin[c] = 0.5 * Unknowns::variable(0, 6 * a + 3 + c);
        square += half_spin[c] * half_spin[c];
      }
      const auto& [s1, s2, s3] = half_spin;
      const Unknowns s0 = 1.0 - 0.5 * square;
      const typename Oracle::Quaternion turned{s0 * p.w() - s1 * p.x() - s2 * p.y() - s3 * p.z(),
                                               s0 * p.x() + s1 * p.w() + s2 * p.z() - s3 * p.y(),
                                               s0 * p.y() - s1 * p.z() + s2 * p.w() + s3 * p.x(),
                                               s0 * p.z() + s1 * p.y() - s2 * p.x() + s3 * p.w()};
      for (int c = 0; c < 3; ++c)
        dx[c] += slope(a, xi) / length * (drawn ? Unknowns(x[c]) : Unknowns::variable(x[c], 6 * a + c));
      for (int c = 0; c < 4; ++c) {
        q[c] += shape(a, xi) * turned[c];
        dq[c] += slope(a, xi) / length * turned[c];
      }
    }
    return Oracle::strain(dx, q, dq);
  };

  Unknowns energy;
  const double place = Nodes == 2 ? 0 : 1 / std::sqrt(3.0);
  for (const double xi : {-place, place}) {
    Eigen::Vector3d dX = Eigen::Vector3d::Zero();
    for (int a = 0; a < Nodes; ++a) dX += slope(a, xi) * mesh.nodes[a];
    const double length = dX.norm();
    const auto now = strain(xi, length, false), rest = strain(xi, length, true);
    for (int i = 0; i < 6; ++i) {
      const Unknowns change = now[i] - rest[i].value;
      energy += 0.5 * stiffness[i] * length * change * change;
    }
  }
  return energy; // of two points of weight 1; with two nodes both are the middle
}

template<int Nodes>
void expect_dual_derivatives() {
  const Eigen::Vector3d normal(0.3, 0.1, 1);
  const meshing::Mesh mesh = [] {
    meshing::Mesh drawn = test::line(1, Nodes - 1, helix);
    if constexpr (Nodes == 3) std::swap(drawn.nodes[1], drawn.nodes[2]); // numbered as in the element
    for (int a = 0; a < Nodes; ++a) drawn.blocks[0].nodes[a] = a;
    return drawn;
  }();
  const auto model =
      test::free_model(Nodes, false, make_beam_block(mesh, mesh.blocks[0], test::uneven_section(), normal));
  Assembler assembler(*model, 1);
  std::mt19937 random(51);
  for (int sample = 0; sample < 20; ++sample) {
    const State state = random_state(*model, false, random);
    test::expect_equal(assembler, state, element_energy<Nodes>(mesh, state, normal));
  }
}

TEST(Beam, energy_residual_and_tangent_equal_dual_numbers) {
  expect_dual_derivatives<2>();
  expect_dual_derivatives<3>();
}

TEST(Beam, ends_turned_against_each_other_almost_all_round_are_infeasible) {
  for (const int order : {1, 2}) {
    const meshing::Mesh mesh = test::line(1, order, straight);
    const auto model = test::free_model(mesh.node_count(), false,
                                        make_beam_block(mesh, mesh.blocks[0], test::uneven_section()));
    Assembler assembler(*model, 1);
    Eigen::VectorXd residual;
    State state = model->initial_state();
    state.rotation.back() = rotation_of({0, 0, 3});
    EXPECT_TRUE(assembler.residual(state, residual).feasible);
    state.rotation.back() = rotation_of({0, 0, 6});
    EXPECT_FALSE(assembler.residual(state, residual).feasible) << order;
  }
}

TEST(Beam, a_line_without_length_or_along_the_normal_is_rejected) {
  const auto make = [](const meshing::Mesh& mesh) {
    make_beam_block(mesh, mesh.blocks[0], test::uneven_section());
  };
  EXPECT_THROW(make(test::line(1, 1, [](double) { return Eigen::Vector3d(1, 2, 3); })),
               std::invalid_argument);
  EXPECT_THROW(make(test::line(2, 1, [](double s) { return Eigen::Vector3d(0, 0, s); })),
               std::invalid_argument);
}

TEST(Beam, samples_tell_section_forces_and_the_strain_of_the_outermost_fibre) {
  const meshing::Mesh mesh = test::line(4, 1, straight);
  materials::BeamSection section = test::uneven_section();
  section.half_width = 0.02;
  section.half_height = 0.05;
  section.yield_strain = 0.3;
  const auto model =
      test::free_model(mesh.node_count(), false, make_beam_block(mesh, mesh.blocks[0], section));
  State state = model->initial_state();
  const Eigen::Vector3d along = straight(1).normalized();
  const double length = straight(1).norm(), twist = 1e-6, stretch = 1e-3, bend = 2e-6;
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) { // stretched, twisted and bent in the plane, by little
    const double s = length * static_cast<double>(a) / 4;
    state.displacement[a] = (stretch * along + bend * s / 2 * Eigen::Vector3d::UnitZ().cross(along)) * s;
    state.rotation[a] = rotation_of(s * (twist * along + bend * Eigen::Vector3d::UnitZ()));
  }
  double total = 0;
  for (const BeamSample& sample : model->sample(state).walls) {
    total += sample.length;
    EXPECT_NEAR(sample.strain[0], stretch, 1e-9);
    EXPECT_NEAR(sample.force[0], section.EA * stretch, 1e-8);
    EXPECT_NEAR(sample.curvature[0], twist, 1e-11);
    EXPECT_NEAR(sample.moment[0], section.GJ * twist, 1e-11);
    EXPECT_NEAR(sample.curvature[2], bend, 1e-11);
    EXPECT_NEAR(sample.moment[2], section.EI3 * bend, 1e-11);
    EXPECT_NEAR(sample.fibre_strain, stretch + 0.02 * bend, 1e-9);
    EXPECT_EQ(sample.yield_strain, 0.3);
  }
  EXPECT_DOUBLE_EQ(total, length);
}

} // namespace
} // namespace dielast::fem::beam_element_test
