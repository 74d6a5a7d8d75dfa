// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/chamber_block.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/paths/ramp.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

// Bending of a stretched strip whose compressed edge wrinkles (Stein & Hedgepeth 1961, NASA TN D-813): a
// strip of height h and thickness t under the axial tension P and the in-plane moment M. Up to M/(Ph) = 1/6
// it is a beam; beyond, a band of height b at the compressed edge carries nothing, b/h = 3M/(Ph) - 1/2, and
// the strip gives way: E t h^2 kappa/(2P) = 4/(9 (1 - 2M/(Ph))^2).

namespace dielast::fem::wrinkling_test {
namespace {

constexpr double height = 0.1, length = 0.2, thickness = 1e-4;
constexpr double modulus = 1e6; // E; a small-strain law, nu = 0.3

/// n squares of two triangles high, `ratio` times as long.
meshing::Mesh strip(int n, int ratio = 2) {
  meshing::Mesh mesh;
  const int columns = ratio * n, rows = n;
  for (int j = 0; j <= 2 * rows; ++j)
    for (int i = 0; i <= 2 * columns; ++i)
      mesh.nodes.emplace_back(ratio * height * i / (2 * columns), height * j / (2 * rows), 0);
  const auto node = [&](int i, int j) { return j * (2 * columns + 1) + i; };
  meshing::CellBlock film{meshing::CellType::triangle6, {}};
  for (int j = 0; j < 2 * rows; j += 2)
    for (int i = 0; i < 2 * columns; i += 2) {
      const auto add = [&](std::array<std::array<int, 2>, 3> corner) {
        for (const auto& c : corner) film.nodes.push_back(node(i + c[0], j + c[1]));
        for (int s = 0; s < 3; ++s) {
          const auto &a = corner[static_cast<std::size_t>(s)],
                     &b = corner[static_cast<std::size_t>((s + 1) % 3)];
          film.nodes.push_back(node(i + (a[0] + b[0]) / 2, j + (a[1] + b[1]) / 2));
        }
      };
      add({{{0, 0}, {2, 0}, {2, 2}}});
      add({{{0, 0}, {2, 2}, {0, 2}}});
    }
  mesh.blocks.push_back(std::move(film));
  return mesh;
}

/// The membrane of all triangles of a mesh, without an electrode, that carries no compression. `law`: of E,
/// Pa, and nu; thickness in m.
std::unique_ptr<ElementBlock> wrinkling(const meshing::Mesh& mesh, const materials::StVenantKirchhoff& law,
                                        double thickness, Dimension dimension,
                                        std::array<double, 2> prestretch = {1, 1}) {
  const MembraneSection section{.material = {.law = law, .dielectric = {.permittivity = 1e-12}},
                                .thickness = thickness,
                                .prestretch = prestretch,
                                .tension_field = true};
  const std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks[0].size()), passive);
  return make_membrane_block(mesh, mesh.blocks[0], section, electrodes, dimension, 3);
}

struct Bending {
  double tension, moment; ///< P in N, M in N m about mid height
};

/// Holds the left end and turns the right one by kappa * length, so that the strain is kappa (y - b) at
/// height y.
Bending bend(int n, double curvature, double b) {
  const meshing::Mesh mesh = strip(n);
  Model model{.dofs = DofMap(mesh.node_count()), .blocks = {}};
  model.blocks.push_back(wrinkling(mesh, {modulus, 0.3}, thickness, Dimension::planar));
  model.place_histories();
  model.blocks[0]->claim_dofs(model.dofs, Dimension::planar);
  const auto at_end = [&](int node) {
    const double x = mesh.nodes[static_cast<std::size_t>(node)].x();
    return x < 1e-12 || x > length - 1e-12;
  };
  for (int node = 0; node < mesh.node_count(); ++node)
    if (at_end(node)) model.dofs.hold(node, 0);
  const int top_left = mesh.node_count() - (4 * n + 1);
  model.dofs.hold(top_left, 1);
  model.dofs.number();
  model.extent = length;
  model.length_scale = height / n;

  Equilibrium equilibrium(model, 1);
  const State rest = model.initial_state();
  const RampOptions options{.newton = {.tolerance = 1e-8, .max_iterations = 60}, .increments = 4};
  RampProgress progress = RampProgress::begin(rest, model.dofs, options);
  // tension first, then the bending
  Loads taut = progress.start, bent = progress.start;
  const auto pull = [&](Loads& loads, double strain, double kappa) {
    for (int node = 0; node < mesh.node_count(); ++node) {
      const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(node)];
      if (x.x() > length - 1e-12)
        loads.held[model.dofs.equation(node, 0) - model.dofs.free_count()] =
            length * (strain + kappa * (x.y() - height / 2));
    }
  };
  const double mean = curvature * (height / 2 - b);
  pull(taut, mean, 0);
  pull(bent, mean, curvature);
  EXPECT_EQ(ramp(equilibrium, linear_path(model.dofs, progress.start, taut), options, progress, {}).end,
            RampEnd::complete);
  State state = progress.points.back().state;
  progress = RampProgress::begin(state, model.dofs, options);
  EXPECT_EQ(ramp(equilibrium, linear_path(model.dofs, progress.start, bent), options, progress, {}).end,
            RampEnd::complete);
  state = progress.points.back().state;
  Eigen::VectorXd force;
  equilibrium.internal_force(state, force);
  Bending result{};
  for (int node = 0; node < mesh.node_count(); ++node) {
    const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(node)];
    if (x.x() <= length - 1e-12) continue;
    const double f = force[model.dofs.equation(node, 0)];
    result.tension += f;
    result.moment += f * (x.y() - height / 2);
  }
  return result;
}

TEST(SteinHedgepeth, a_strip_with_a_wrinkled_edge_bends_as_the_tension_field_says) {
  for (const double wrinkled : {0.1, 0.4, 0.7}) {
    const double curvature = 1e-4 / height, b = wrinkled * height;
    const Bending found = bend(8, curvature, b);
    const double tension = modulus * thickness * curvature * std::pow(height - b, 2) / 2;
    const double moment_ratio = (wrinkled + 0.5) / 3; // M/(Ph)
    EXPECT_NEAR(found.tension, tension, 0.005 * tension) << wrinkled;
    EXPECT_NEAR(found.moment / (found.tension * height), moment_ratio, 0.005 * moment_ratio) << wrinkled;
    const double flexibility = modulus * thickness * height * height * curvature / (2 * found.tension);
    const double ratio = found.moment / (found.tension * height);
    EXPECT_NEAR(flexibility, 4 / (9 * std::pow(1 - 2 * ratio, 2)), 0.02 * flexibility) << wrinkled;
  }
}

TEST(SteinHedgepeth, a_taut_strip_bends_as_a_beam) {
  const double curvature = 1e-5 / height;
  const Bending found = bend(6, curvature, -0.2 * height);
  EXPECT_NEAR(found.tension, modulus * thickness * curvature * height * 0.7 * height, 1e-3 * found.tension);
  EXPECT_NEAR(found.moment, modulus * thickness * std::pow(height, 3) / 12 * curvature, 1e-3 * found.moment);
}

/// A quarter of the upper half of a square airbag of the diagonal 1.2 m: symmetric about x = 0 and y = 0, its
/// edges in the plane z = 0.
struct Airbag {
  static constexpr double side = 1.2 / 2.8284271247461903;

  explicit Airbag(int n) {
    meshing::Mesh mesh = strip(n); // length twice the height: to be a square
    for (Eigen::Vector3d& x : mesh.nodes) x = {x.x() * side / length, x.y() * side / height, 0};
    model.dofs = DofMap(mesh.node_count());
    model.ports = {{.name = "inside", .chamber = Chamber{}}};
    model.blocks.push_back(wrinkling(mesh, {588e6, 0.4}, 0.6e-3, Dimension::spatial));
    model.blocks.push_back(make_pressure_block(mesh, mesh.blocks[0], 0));
    model.place_histories();
    for (const auto& block : model.blocks) block->claim_dofs(model.dofs, Dimension::spatial);
    for (int node = 0; node < mesh.node_count(); ++node) {
      const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(node)];
      if (x.x() < 1e-9) model.dofs.hold(node, 0);
      if (x.y() < 1e-9) model.dofs.hold(node, 1);
      if (x.x() > side - 1e-9 || x.y() > side - 1e-9) model.dofs.hold(node, 2);
    }
    model.dofs.number();
    model.drawn = mesh.nodes;
    model.extent = side * std::sqrt(2);
    model.length_scale = side / n;
  }
  Model model{.dofs = DofMap(0), .blocks = {}};
};

// Flat, slack and without any stiffness across it; the published height is 217 mm at 5 kPa (square airbag of
// 588 MPa, 0.6 mm and the diagonal 1.2 m).
TEST(SlackFilm, an_airbag_rises_from_flat_to_its_published_height) {
  Airbag bag(8);
  Equilibrium equilibrium(bag.model, 1);
  const RampOptions options{.newton = {.wrinkles = true}, .increments = 5};
  RampProgress progress = RampProgress::begin(bag.model.initial_state(), bag.model.dofs, options);
  Loads full = progress.start;
  full.voltage = {5e3};
  ASSERT_EQ(ramp(equilibrium, linear_path(bag.model.dofs, progress.start, full), options, progress, {}).end,
            RampEnd::complete);
  EXPECT_NEAR(progress.points.back().state.displacement[0].z(), 0.217, 0.005);
}

/// A strip between two clamps 0.1 m apart and 0.4 m long, its short sides free, drawn with next to no tension
/// and sheared: it wrinkles all over, and slack film without any stiffness is left at the free sides.
TEST(SlackFilm, a_sheared_sheet_carries_its_tension_at_45_degrees) {
  constexpr int ratio = 4, rows = 8;
  const meshing::Mesh mesh = strip(rows, ratio);
  Model model{.dofs = DofMap(mesh.node_count()), .blocks = {}};
  model.blocks.push_back(wrinkling(mesh, {modulus, 0.31}, thickness, Dimension::planar, {1, 1.00001}));
  model.place_histories();
  model.blocks[0]->claim_dofs(model.dofs, Dimension::planar);
  const auto at_top = [&](int node) {
    return mesh.nodes[static_cast<std::size_t>(node)].y() > height - 1e-9;
  };
  for (int node = 0; node < mesh.node_count(); ++node)
    if (at_top(node) || mesh.nodes[static_cast<std::size_t>(node)].y() < 1e-9)
      for (const int c : {0, 1}) model.dofs.hold(node, c);
  model.dofs.number();
  model.extent = ratio * height;
  model.length_scale = height / rows;
  Equilibrium equilibrium(model, 1);
  const RampOptions options{.newton = {.wrinkles = true}, .increments = 4};
  RampProgress progress = RampProgress::begin(model.initial_state(), model.dofs, options);
  Loads sheared = progress.start;
  const double shear = 1e-3;
  for (int node = 0; node < mesh.node_count(); ++node)
    if (at_top(node)) sheared.held[model.dofs.equation(node, 0) - model.dofs.free_count()] = shear * height;
  ASSERT_EQ(ramp(equilibrium, linear_path(model.dofs, progress.start, sheared), options, progress, {}).end,
            RampEnd::complete);
  // in the middle: S = E gamma/4 (1 1; 1 1), the tension E gamma/2 along the diagonal
  Eigen::Vector3d S = Eigen::Vector3d::Zero();
  double volume = 0;
  for (const MembraneSample& sample : model.sample(progress.points.back().state).film) {
    const auto nodes = mesh.blocks[0].cell(sample.cell);
    const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(nodes[0])];
    if (std::abs(x.x() - ratio * height / 2) > height / 2 || std::abs(x.y() - height / 2) > 0.2 * height)
      continue;
    S += sample.volume * Eigen::Vector3d(sample.S(0, 0), sample.S(1, 1), sample.S(0, 1));
    volume += sample.volume;
  }
  const double expected = modulus * shear / 4;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(S[i] / volume, expected, 0.05 * expected) << i;
}

} // namespace
} // namespace dielast::fem::wrinkling_test
