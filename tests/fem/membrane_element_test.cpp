// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/films/triangle.hpp"
#include "materials/laws/dual.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::membrane_element_test {
namespace {

struct Kind {
  int order;
  bool planar, electrode;
};

std::string name(const ::testing::TestParamInfo<Kind>& info) {
  return std::string(info.param.order == 1 ? "t3" : "t6") + (info.param.planar ? "_planar" : "_spatial") +
         (info.param.electrode ? "_charged" : "_passive");
}

/// Stretched, turned and shaken, with 7.5 kV across the 1 mm film.
State random_state(const Model& model, const meshing::Mesh& mesh, bool planar, std::mt19937& random) {
  std::uniform_real_distribution<double> stretch(0.7, 1.6);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 0) = stretch(random);
  F(1, 1) = stretch(random);
  F(0, 1) = 0.3;
  F = rotation_of({0, 0, 3 * (stretch(random) - 1)}).toRotationMatrix() * F;
  if (!planar) F = test::random_rotation(random, 3) * F;
  State state = test::homogeneous(model, mesh, F);
  for (auto& u : state.displacement) {
    u += test::random_vector(random, 3, 0.04);
    if (planar) u.z() = 0;
  }
  state.voltage = {7.5e3};
  return state;
}

/// Some elements with an electrode, others without, middle nodes off the straight sides.
meshing::Mesh curved_mesh(int n, int order) {
  meshing::Mesh mesh = test::distorted_square(n, order);
  std::mt19937 random(5);
  for (int a = (n + 1) * (n + 1); a < mesh.node_count(); ++a)
    mesh.nodes[static_cast<std::size_t>(a)].head<2>() += test::random_vector(random, 2, 0.06 / n);
  return mesh;
}

class MembraneElement : public ::testing::TestWithParam<Kind> {
 protected:
  std::unique_ptr<Model> model(const meshing::Mesh& mesh) const {
    const auto [order, planar, electrode] = GetParam();
    std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks[0].size()), passive);
    for (std::size_t e = 0; electrode && e < electrodes.size(); e += e % 3 == 0 ? 2 : 1) electrodes[e] = 0;
    const int points = order == 1 ? 1 : planar ? 6 : 3;
    return test::free_model(mesh.node_count(), planar,
                            make_membrane_block(mesh, mesh.blocks[0], test::vhb(2.0, 1.5), electrodes,
                                                test::dimension(planar), points));
  }
};

TEST_P(MembraneElement, residual_and_tangent_are_the_derivatives_of_the_energy) {
  const meshing::Mesh mesh = curved_mesh(2, GetParam().order); // 8 elements
  const auto m = model(mesh);
  std::mt19937 random(21);
  for (int sample = 0; sample < 3; ++sample)
    test::expect_consistent_derivatives(*m, random_state(*m, mesh, GetParam().planar, random), 0.3);
}

INSTANTIATE_TEST_SUITE_P(All, MembraneElement,
                         ::testing::Values(Kind{1, true, false}, Kind{1, true, true}, Kind{1, false, false},
                                           Kind{1, false, true}, Kind{2, true, false}, Kind{2, true, true},
                                           Kind{2, false, false}, Kind{2, false, true}),
                         name);

/// Energy of one triangle in dual numbers, from the 3-D law: lambda_3 = 1/(area stretch), shape functions by
/// differentiating their products of barycentric coordinates.
template<int Nodes, int Dim>
materials::Dual<Nodes * Dim> triangle_energy(const meshing::Mesh& mesh, const MembraneSection& section,
                                             const State& state, double voltage, int points) {
  using Unknowns = materials::Dual<Nodes * Dim>;
  using Plane = materials::Dual<2>;
  std::array<std::array<Unknowns, 3>, Nodes> x;
  for (int a = 0; a < Nodes; ++a)
    for (int c = 0; c < Dim; ++c)
      x[a][c] = Unknowns::variable(mesh.nodes[a][c] + state.displacement[a][c], a * Dim + c);

  Unknowns energy;
  for (const TrianglePoint& at : triangle_rule(points)) {
    const Plane xi = Plane::variable(at.xi, 0), eta = Plane::variable(at.eta, 1), zeta = 1.0 - xi - eta;
    const std::array<Plane, 3> corner{zeta, xi, eta};
    std::array<Plane, Nodes> N;
    if constexpr (Nodes == 3)
      N = corner;
    else
      for (int i = 0; i < 3; ++i) {
        N[i] = corner[i] * (2.0 * corner[i] - 1.0);
        N[3 + i] = 4.0 * corner[i] * corner[(i + 1) % 3];
      }
    Eigen::Matrix2d dX = Eigen::Matrix2d::Zero(); // columns: along xi and eta
    std::array<std::array<Unknowns, 3>, 2> dx;
    for (int a = 0; a < Nodes; ++a) {
      dX += mesh.nodes[a].template head<2>() * N[a].gradient.transpose();
      for (int i = 0; i < 2; ++i)
        for (int c = 0; c < Dim; ++c) dx[i][c] += N[a].gradient[i] * x[a][c];
    }
    const Eigen::Matrix2d inverse = dX.inverse();
    std::array<std::array<Unknowns, 3>, 2> F; // columns
    for (int j = 0; j < 2; ++j)
      for (int c = 0; c < 3; ++c)
        F[j][c] = section.prestretch[j] * (inverse(0, j) * dx[0][c] + inverse(1, j) * dx[1][c]);
    const auto dot = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const std::array<Unknowns, 3> normal{F[0][1] * F[1][2] - F[0][2] * F[1][1],
                                         F[0][2] * F[1][0] - F[0][0] * F[1][2],
                                         F[0][0] * F[1][1] - F[0][1] * F[1][0]};
    const Unknowns area_square = dot(normal, normal), trace = dot(F[0], F[0]) + dot(F[1], F[1]);
    const Unknowns elastic =
        std::visit([&](const auto& law) { return materials::planar_energy(law, trace, area_square); },
                   section.material.law);
    const double field = voltage / section.thickness;
    const double volume =
        at.weight * dX.determinant() * section.thickness / (section.prestretch[0] * section.prestretch[1]);
    energy +=
        volume * (elastic - 0.5 * section.material.dielectric.permittivity * field * field * area_square);
  }
  return energy;
}

template<int Nodes, int Dim>
void expect_dual_derivatives(bool charged, int points) {
  meshing::Mesh mesh{
      .nodes = {{0, 0, 0}, {1.1, 0.1, 0}, {0.2, 0.9, 0}, {0.6, -0.05, 0}, {0.7, 0.55, 0}, {0.05, 0.4, 0}},
      .blocks = {{Nodes == 3 ? meshing::CellType::triangle3 : meshing::CellType::triangle6, {}}},
      .node_sets = {},
      .cell_sets = {}};
  mesh.nodes.resize(Nodes);
  for (int a = 0; a < Nodes; ++a) mesh.blocks[0].nodes.push_back(a);
  constexpr bool planar = Dim == 2;
  const MembraneSection section = test::vhb(1.3, 0.9);
  const auto model =
      test::free_model(Nodes, planar,
                       make_membrane_block(mesh, mesh.blocks[0], section, {charged ? 0 : passive},
                                           test::dimension(planar), points));
  Assembler assembler(*model, 1);
  std::mt19937 random(31);
  for (int sample = 0; sample < 20; ++sample) {
    const State state = random_state(*model, mesh, planar, random);
    test::expect_equal(assembler, state,
                       triangle_energy<Nodes, Dim>(mesh, section, state, charged ? 7.5e3 : 0, points));
  }
}

TEST(MembraneTriangle, energy_residual_and_tangent_equal_dual_numbers) {
  for (const bool charged : {false, true}) {
    expect_dual_derivatives<3, 2>(charged, 1);
    expect_dual_derivatives<3, 3>(charged, 1);
    expect_dual_derivatives<6, 2>(charged, 3);
    expect_dual_derivatives<6, 2>(charged, 6);
    expect_dual_derivatives<6, 3>(charged, 3);
    expect_dual_derivatives<6, 3>(charged, 6);
  }
}

TEST(MembraneTriangle, a_planar_film_turned_over_is_infeasible_a_spatial_one_is_not) {
  const meshing::Mesh mesh = test::distorted_square(2, 1);
  for (const bool planar : {true, false}) {
    const auto model = test::free_model(mesh.node_count(), planar,
                                        make_membrane_block(mesh, mesh.blocks[0], test::vhb(),
                                                            std::vector(8, 0), test::dimension(planar), 1));
    Assembler assembler(*model, 1);
    Eigen::VectorXd residual;
    const State flipped = test::homogeneous(*model, mesh, Eigen::Vector3d(-1, 1, 1).asDiagonal());
    EXPECT_EQ(assembler.residual(flipped, residual).feasible, !planar);
    const State flattened = test::homogeneous(*model, mesh, Eigen::Vector3d(0, 1, 1).asDiagonal());
    EXPECT_FALSE(assembler.residual(flattened, residual).feasible);
  }
}

TEST(MembraneTriangle, an_inverted_drawing_is_rejected_by_name) {
  meshing::Mesh mesh = test::distorted_square(2, 1);
  std::swap(mesh.blocks[0].nodes[3], mesh.blocks[0].nodes[4]);
  try {
    make_membrane_block(mesh, mesh.blocks[0], test::vhb(), std::vector(8, 0), Dimension::planar, 1);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("triangle 1 "), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace dielast::fem::membrane_element_test
