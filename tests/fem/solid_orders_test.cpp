// SPDX-License-Identifier: GPL-3.0-or-later
// How fast solids converge: a thick incompressible neo-Hookean sphere blown up from inside, whose deformation
// r^3 - R^3 = const is known, and its pressure by quadrature of the radial equilibrium.
#include "fem/equilibrium/equilibrium.hpp"
#include "fem/films/triangle.hpp"
#include "fem/solids/solid_block.hpp"
#include "fem/solids/tetrahedron.hpp"
#include "meshing/solids/slab.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace dielast::fem::solid_orders_test {
namespace {

constexpr double A = 1, B = 2, inner = 1.3, mu = 45e3;

double radius(double R) { return std::cbrt(R * R * R + inner * inner * inner - A * A * A); }

/// Of SolidResponse: what the isochoric stress lacks to the radial one.
double pressure(double R) {
  const auto stretches = [](double at) {
    const double hoop = radius(at) / at;
    return std::pair{1 / (hoop * hoop), hoop};
  };
  double radial = 0; // true stress
  constexpr int parts = 2000;
  for (int i = 0; i < parts; ++i) {
    const double at = R + (B - R) * (i + 0.5) / parts;
    const auto [l, hoop] = stretches(at);
    const double dr = l * (B - R) / parts; // dr = l dR
    radial -= 2 * mu * (hoop * hoop - l * l) / radius(at) * dr;
  }
  const auto [l, hoop] = stretches(R);
  return mu * (l * l - (l * l + 2 * hoop * hoop) / 3) - radial;
}

struct Errors {
  double size, displacement, pressure;
};

Errors errors(meshing::Mesh mesh, Dimension dimension) {
  const bool in_space = dimension == Dimension::spatial;
  const meshing::CellBlock block = mesh.blocks[0];
  const auto count = static_cast<std::size_t>(block.size());
  SolidCells cells{block, std::vector<int>(count, passive), std::vector<int>(count, 0)};
  const auto model = test::unnumbered_model(
      mesh.node_count(), dimension,
      make_solid_block(mesh, std::move(cells), {{.material = test::vhb().material, .thickness = 1}}, {},
                       dimension));
  const auto hold = [&](const char* place, std::initializer_list<int> components) {
    for (const int n : mesh.node_sets.at(place))
      for (const int c : components) model->dofs.hold(n, c);
  };
  hold("inner", {0, 1, 2});
  if (in_space) {
    hold("side_x", {0});
    hold("side_y", {1});
    hold("equator", {2});
  } else {
    hold("south", {0});
    hold("north", {0});
  }
  model->dofs.number();
  model->extent = 2 * B;
  State state = model->initial_state();
  const auto moved = [](const Eigen::Vector3d& X) -> Eigen::Vector3d {
    return (radius(X.norm()) / X.norm() - 1) * X;
  };
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) state.displacement[n] = moved(mesh.nodes[n]);
  Equilibrium equilibrium(*model, 1);
  const NewtonResult result = equilibrium.solve(state, {.tolerance = 1e-10});
  EXPECT_EQ(result.outcome, Outcome::converged);
  EXPECT_EQ(result.unstable_modes, 0);
  std::map<int, double> pressures; // at corners, in the order in which elements ask for them
  for (int e = 0; e < block.size(); ++e)
    for (const int n : block.cell(e).first(in_space ? 4 : 3))
      pressures.try_emplace(n, state.scalar[std::min(pressures.size(), state.scalar.size() - 1)]);
  // Root mean squares over a few points of each element; not its integration points, which may be better.
  Errors sum{};
  int samples = 0;
  for (int e = 0; e < block.size(); ++e)
    for (const auto& at : {Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(0.35, 0.25, 0.1),
                           Eigen::Vector3d(0.15, 0.1, 0.6), Eigen::Vector3d(0.2, 0.55, 0.05)}) {
      Eigen::VectorXd shape, linear;
      if (in_space) {
        shape = tetrahedron_shape<10>(at);
        linear = tetrahedron_shape<4>(at);
      } else {
        shape = shape_values<6>(at.x(), at.y());
        linear = shape_values<3>(at.x(), at.y());
      }
      const auto nodes = block.cell(e);
      Eigen::Vector3d X = Eigen::Vector3d::Zero(), u = X;
      double p = 0;
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        X += shape[static_cast<int>(a)] * mesh.nodes[static_cast<std::size_t>(nodes[a])];
        u += shape[static_cast<int>(a)] * state.displacement[static_cast<std::size_t>(nodes[a])];
        if (static_cast<int>(a) < linear.size()) p += linear[static_cast<int>(a)] * pressures.at(nodes[a]);
      }
      sum.displacement += (u - moved(X)).squaredNorm();
      sum.pressure += std::pow(p - pressure(X.norm()), 2);
      ++samples;
    }
  return {std::pow(static_cast<double>(block.size()), in_space ? -1.0 / 3 : -0.5),
          std::sqrt(sum.displacement / samples), std::sqrt(sum.pressure / samples) / mu};
}

void expect_orders(const Errors& coarse, const Errors& fine) {
  const double refined = std::log(coarse.size / fine.size);
  EXPECT_GT(std::log(coarse.displacement / fine.displacement) / refined, 2.7)
      << coarse.displacement << " " << fine.displacement;
  EXPECT_GT(std::log(coarse.pressure / fine.pressure) / refined, 1.7)
      << coarse.pressure << " " << fine.pressure;
  EXPECT_LT(fine.displacement, 1e-3);
  EXPECT_LT(fine.pressure, 0.03);
}

TEST(SolidOrders, triangles_of_revolution) {
  expect_orders(errors(meshing::hollow_sphere_mesh(A, B, 4), Dimension::axisymmetric),
                errors(meshing::hollow_sphere_mesh(A, B, 8), Dimension::axisymmetric));
}

TEST(SolidOrders, tetrahedra) {
  expect_orders(errors(meshing::sphere_eighth_mesh(A, B, 3), Dimension::spatial),
                errors(meshing::sphere_eighth_mesh(A, B, 6), Dimension::spatial));
}

} // namespace
} // namespace dielast::fem::solid_orders_test
