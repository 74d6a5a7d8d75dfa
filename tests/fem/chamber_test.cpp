// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/chamber_block.hpp"

#include "fem/equilibrium/equilibrium.hpp"
#include "fem/films/meridian.hpp"
#include "fem/films/triangle.hpp"
#include "meshing/meridian.hpp"
#include "meshing/rings.hpp"
#include "tests/fem/chamber_models.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

namespace dielast::fem::chamber_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A chamber under a film that has no stiffness, every unknown free.
std::unique_ptr<Model> chamber(const meshing::Mesh& mesh) {
  auto model = test::free_model(mesh.node_count(), test::dimension_of(mesh),
                                make_pressure_block(mesh, mesh.blocks[0], 0));
  model->ports = {{.name = "inside", .chamber = Chamber{}}};
  return model;
}

double volume(const meshing::Mesh& mesh) {
  const auto model = chamber(mesh);
  return model->charges(model->initial_state(), false).charge[0];
}

/// Flat disc of radius 1 bent to the upper half of the unit sphere.
Eigen::Vector3d on_sphere(const Eigen::Vector3d& X) {
  const double r = X.norm(), angle = r * pi / 2;
  return r == 0 ? Eigen::Vector3d(0, 0, 1)
                : Eigen::Vector3d(std::sin(angle) * X.x() / r, std::sin(angle) * X.y() / r, std::cos(angle));
}

double observed_order(const std::function<double(int)>& error, int coarse) {
  return std::log2(std::abs(error(coarse)) / std::abs(error(2 * coarse)));
}

TEST(Chamber, volumes_converge_to_those_of_balls) {
  for (const int order : {1, 2}) {
    const auto balloon = [&](int elements) {
      return volume(meshing::balloon_meridian(1, elements, order)) - 4 * pi / 3;
    };
    const auto dome = [&](int rings) {
      return volume(test::shaped(meshing::disc_mesh(1, 0.5, rings, order, true), on_sphere)) - 2 * pi / 3;
    };
    EXPECT_NEAR(observed_order(balloon, 16), 2 * order, 0.1) << order;
    EXPECT_NEAR(observed_order(dome, 8), 2 * order, 0.2) << order;
    EXPECT_LT(std::abs(balloon(32)), order == 1 ? 2e-2 : 1e-5);
    EXPECT_LT(std::abs(dome(16)), order == 1 ? 2e-2 : 2e-5);
  }
}

TEST(Chamber, volumes_under_cones_and_discs_are_exact) {
  for (const int order : {1, 2}) {
    const meshing::Mesh disc = meshing::disc_meridian(2, 1, 5, order);
    const auto raised = [](const Eigen::Vector3d& X) { return Eigen::Vector3d(X.x(), 0, 0.7); };
    const auto cone = [](const Eigen::Vector3d& X) { return Eigen::Vector3d(X.x(), 0, 3 * (2 - X.x())); };
    EXPECT_NEAR(volume(test::shaped(disc, raised)), 4 * pi * 0.7, 1e-14);
    EXPECT_NEAR(volume(test::shaped(disc, cone)), pi * 4 * 6 / 3, 1e-13);
    const meshing::Mesh square = test::distorted_square(3, order, 2);
    const auto tilted = [](const Eigen::Vector3d& X) {
      return Eigen::Vector3d(X.x(), X.y(), 1 + X.x() / 2 + X.y());
    };
    EXPECT_NEAR(volume(test::shaped(square, tilted)), 4 * 2.5, 1e-13);
  }
}

TEST(Chamber, a_frustum_closed_by_a_lid_has_its_volume) {
  const meshing::Mesh mesh = test::shaped(meshing::annulus_meridian(1, 3, 4, 2, 2), [](const auto& X) {
    return Eigen::Vector3d(X.x(), 0, (3 - X.x()) / 2);
  });
  auto model = chamber(mesh);
  model->blocks.push_back(make_lid_block(mesh, {.node = mesh.node_sets.at("inner").front(), .area = pi}, 0));
  State state = model->initial_state();
  state.voltage = {20};
  const Charges held = model->charges(state, false);
  EXPECT_NEAR(held.charge[0], pi * (1 + 3 + 9) / 3, 1e-13);
  EXPECT_EQ(held.capacitance[0], 0);
}

// Also on edges that its potential does not know to be pushed, as they rest.
TEST(Chamber, pressure_acts_along_the_normal_everywhere) {
  for (const int order : {1, 2})
    for (const bool turned : {false, true}) { // about the z axis: of revolution
      const meshing::Mesh mesh =
          turned ? test::shaped(
                       meshing::disc_meridian(2, 1, 5, order),
                       [](const Eigen::Vector3d& X) { return Eigen::Vector3d(X.x(), 0, 3 * (2 - X.x())); })
                 : test::shaped(test::distorted_square(3, order, 2), [](const Eigen::Vector3d& X) {
                     return Eigen::Vector3d(X.x(), X.y(), 1 + X.x() / 2 + X.y());
                   });
      const auto model = chamber(mesh);
      State state = model->initial_state();
      state.voltage = {20};
      Eigen::VectorXd force;
      Assembler(*model, 1).residual(state, force);
      model->blocks[0]->add_forces_at_rest(state, model->dofs, force);
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int n = 0; n < mesh.node_count(); ++n)
        for (int c = 0; c < 3; ++c)
          if (const int e = model->dofs.equation(n, c); e != DofMap::absent) sum[c] -= force[e];
      const Eigen::Vector3d area = turned ? Eigen::Vector3d(12 * pi, 0, 4 * pi) : Eigen::Vector3d(-2, -4, 4);
      EXPECT_LT((sum - 20 * area).norm(), 1e-11) << order << turned;
      const auto pressed = pressure_forces(mesh, mesh.blocks[0], state, 20);
      EXPECT_LT(
          (std::accumulate(pressed.begin(), pressed.end(), Eigen::Vector3d(0, 0, 0)) - 20 * area).norm(),
          1e-11);
    }
}

// A tube whose ends rest along z: what is around the axis, and p 2 pi r dz outwards on every node, ends or
// not.
TEST(Chamber, the_ends_of_a_tube_bear_what_the_pressure_on_it_makes) {
  for (const int order : {1, 2}) {
    const meshing::Mesh mesh = test::shaped(meshing::annulus_meridian(1, 2, 3, order, 2), [](const auto& X) {
      return Eigen::Vector3d(1.5 - 0.2 * X.x(), 0, 3 + X.x());
    });
    auto model = chamber(mesh);
    const int low = mesh.node_sets.at("inner").front(), high = mesh.node_sets.at("outer").front();
    model->blocks.push_back(make_level_edge_block(mesh, mesh.blocks[0], {low, high}, 0));
    State state = model->initial_state();
    state.voltage = {-2};
    const double wide = 1.3, narrow = 1.1;
    const double held = model->charges(state, false).charge[0];
    EXPECT_NEAR(std::abs(held), pi * (wide * wide + wide * narrow + narrow * narrow) / 3, 1e-13);
    Eigen::VectorXd force;
    Assembler(*model, 1).residual(state, force);
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(force.size());
    const meshing::CellBlock& cells = mesh.blocks[0];
    for (int cell = 0; cell < cells.size(); ++cell)
      for (const MeridianPoint& at : meridian_rule(3)) {
        const auto add = [&](const auto& N, const auto& dN) {
          double r = 0, z = 0, dr = 0, dz = 0;
          for (Eigen::Index a = 0; a < N.size(); ++a) {
            const Eigen::Vector3d& X =
                mesh.nodes[static_cast<std::size_t>(cells.cell(cell)[static_cast<std::size_t>(a)])];
            r += N[a] * X.x(), z += N[a] * X.z(), dr += dN[a] * X.x(), dz += dN[a] * X.z();
          }
          for (Eigen::Index a = 0; a < N.size(); ++a) {
            const int node = cells.cell(cell)[static_cast<std::size_t>(a)];
            const double w = 2 * 2 * pi * r * at.weight * N[a];
            expected[model->dofs.equation(node, 0)] += w * dz;
            expected[model->dofs.equation(node, 2)] -= w * dr;
          }
        };
        if (order == 1)
          add(meridian_shape<2>(at.xi), meridian_slope<2>(at.xi));
        else
          add(meridian_shape<3>(at.xi), meridian_slope<3>(at.xi));
      }
    EXPECT_LT((force - expected).norm(), 1e-13 * expected.norm());
  }
}

class ChamberShape : public testing::TestWithParam<meshing::CellType> {
 protected:
  static meshing::Mesh flat() {
    const int order = nodes_per_cell(GetParam()) == (is_meridian(GetParam()) ? 3 : 6) ? 2 : 1;
    return meshing::is_meridian(GetParam()) ? meshing::annulus_meridian(0.4, 1.2, 4, order, 2)
                                            : test::distorted_square(2, order);
  }
};

TEST_P(ChamberShape, forces_and_their_derivatives_are_those_of_the_volume) {
  const meshing::Mesh mesh = test::shaped(flat(), [](const Eigen::Vector3d& X) {
    return Eigen::Vector3d(X.x(), X.y(), 0.5 + std::sin(2 * X.x()) * std::cos(X.y()));
  });
  auto model = chamber(mesh);
  const int node = 1;
  model->blocks.push_back(make_lid_block(mesh, {.node = node, .area = 0.3}, 0));
  if (meshing::is_meridian(GetParam()))
    model->blocks.push_back(make_level_edge_block(
        mesh, mesh.blocks[0], {mesh.node_sets.at("inner").front(), mesh.node_sets.at("outer").front()}, 0));
  State state = model->initial_state();
  std::mt19937 random(4);
  for (int a = 0; a < mesh.node_count(); ++a)
    for (int c = 0; c < 3; ++c)
      if (model->dofs.equation(a, c) != DofMap::absent)
        state.displacement[static_cast<std::size_t>(a)][c] = test::random_vector(random, 1, 0.05)[0];
  state.voltage = {1.7};
  test::expect_consistent_derivatives(*model, state, 0.3);
  Assembler assembler(*model, 1);
  Eigen::VectorXd force;
  const Evaluation there = assembler.residual(state, force);
  const Charges held = model->charges(state, true);
  EXPECT_LT((force + 1.7 * held.coupling[0]).norm(), 1e-14 * force.norm());
  EXPECT_NEAR(there.energy, -1.7 * held.charge[0], 1e-14);
}

// On a plane, whatever its slope, the load on an inner node is p n times the integral of its shape function.
TEST_P(ChamberShape, the_load_of_inner_nodes_is_pressure_times_normal_and_area) {
  const meshing::Mesh mesh = test::shaped(flat(), [](const Eigen::Vector3d& X) {
    return Eigen::Vector3d(1.3 * X.x() + 0.1, 0.2 * X.x() + X.y(), 0.6 * X.x() - 0.8 * X.y());
  });
  const auto model = chamber(mesh);
  Assembler assembler(*model, 1);
  State state = model->initial_state();
  state.voltage = {2.5};
  Eigen::VectorXd force;
  assembler.residual(state, force);

  std::vector<Eigen::Vector3d> load(mesh.nodes.size(), Eigen::Vector3d::Zero());
  const auto add = [&](int cell, const auto& N, const Eigen::Vector3d& normal, double weight) {
    for (Eigen::Index a = 0; a < N.size(); ++a)
      load[static_cast<std::size_t>(mesh.blocks[0].cell(cell)[static_cast<std::size_t>(a)])] +=
          2.5 * weight * N[a] * normal;
  };
  const auto place = [&](int cell, int a) {
    return mesh.nodes[static_cast<std::size_t>(mesh.blocks[0].cell(cell)[static_cast<std::size_t>(a)])];
  };
  for (int cell = 0; cell < mesh.blocks[0].size(); ++cell) {
    const Eigen::Vector3d side = place(cell, 1) - place(cell, 0);
    switch (GetParam()) {
    case meshing::CellType::meridian2:
    case meshing::CellType::meridian3:
      for (const MeridianPoint& at : meridian_rule(3)) {
        const double r = place(cell, 0).x() + (1 + at.xi) / 2 * side.x();
        const Eigen::Vector3d normal(side.z(), 0, -side.x()); // times the length
        if (GetParam() == meshing::CellType::meridian2)
          add(cell, meridian_shape<2>(at.xi), normal, pi * r * at.weight);
        else
          add(cell, meridian_shape<3>(at.xi), normal, pi * r * at.weight);
      }
      break;
    default:
      for (const TrianglePoint& at : triangle_rule(6)) {
        const Eigen::Vector3d normal = side.cross(place(cell, 2) - place(cell, 0));
        if (GetParam() == meshing::CellType::triangle3)
          add(cell, shape_values<3>(at.xi, at.eta), normal, at.weight);
        else
          add(cell, shape_values<6>(at.xi, at.eta), normal, at.weight);
      }
    }
  }
  int inner = 0;
  for (int a = 0; a < mesh.node_count(); ++a) {
    const auto on = [&](const char* name) {
      const auto set = mesh.node_sets.find(name);
      return set != mesh.node_sets.end() && std::ranges::find(set->second, a) != set->second.end();
    };
    if (on("edge") || on("inner") || on("outer")) continue;
    ++inner;
    for (int c = 0; c < 3; ++c)
      if (const int e = model->dofs.equation(a, c); e != DofMap::absent) {
        EXPECT_NEAR(-force[e], load[static_cast<std::size_t>(a)][c], 1e-13) << a << " " << c;
      }
  }
  EXPECT_GT(inner, 0);
}

INSTANTIATE_TEST_SUITE_P(, ChamberShape,
                         testing::Values(meshing::CellType::meridian2, meshing::CellType::meridian3,
                                         meshing::CellType::triangle3, meshing::CellType::triangle6),
                         [](const auto& one) {
                           return (is_meridian(one.param) ? "meridian" : "triangle") +
                                  std::to_string(nodes_per_cell(one.param));
                         });

/// A clamped disc of 20 mm radius, drawn 1.1 times as large, over a chamber.
struct Drum {
  explicit Drum(bool revolved)
      : mesh(revolved ? meshing::disc_meridian(0.02, 0.01, 12, 2)
                      : meshing::disc_mesh(0.02, 0.01, 4, 2, true)) {
    model = test::inflatable(mesh, test::vhb(1.1, 1.1), 0.02);
    for (const int a : mesh.node_sets.at("rim"))
      for (int c = 0; c < 3; ++c) model->dofs.hold(a, c);
    centre = mesh.node_sets.at("centre").front();
    model->dofs.hold(centre, 0);
    model->dofs.number();
  }
  double height(const State& state) const { return state.displacement[static_cast<std::size_t>(centre)].z(); }

  meshing::Mesh mesh;
  std::unique_ptr<Model> model;
  int centre = 0;
};

constexpr NewtonOptions tight{.tolerance = 1e-12};

TEST(Chamber, given_its_volume_takes_the_state_of_the_given_pressure) {
  for (const bool revolved : {true, false}) {
    const Drum drum(revolved);
    Equilibrium equilibrium(*drum.model, 1);
    State pumped = drum.model->initial_state();
    pumped.voltage = {600};
    ASSERT_EQ(equilibrium.solve(pumped, tight).outcome, Outcome::converged);
    EXPECT_GT(drum.height(pumped), 2.5e-3);

    State filled = drum.model->initial_state();
    filled.supply = {Supply::charge};
    const double held =
        drum.model->ports[0].chamber->pumped(drum.model->charges(pumped, false).charge[0], 600);
    for (const double part : {0.25, 0.5, 0.75, 1.0}) {
      filled.charge = {part * held};
      ASSERT_EQ(equilibrium.solve(filled, tight).outcome, Outcome::converged) << part;
    }
    EXPECT_NEAR(filled.voltage[0], 600, 1e-8);
    for (std::size_t a = 0; a < drum.mesh.nodes.size(); ++a)
      EXPECT_LT((filled.displacement[a] - pumped.displacement[a]).norm(), 1e-12);
  }
}

TEST(Chamber, sealed_keeps_its_volume_under_a_load) {
  for (const bool revolved : {true, false}) {
    const Drum drum(revolved);
    Equilibrium equilibrium(*drum.model, 1);
    State state = drum.model->initial_state();
    state.voltage = {300};
    ASSERT_EQ(equilibrium.solve(state, tight).outcome, Outcome::converged);
    const double volume = drum.model->charges(state, false).charge[0], height = drum.height(state);
    const Chamber& chamber = *drum.model->ports[0].chamber;
    const double held = chamber.pumped(volume, 300);
    State open = state;
    state.supply = {Supply::charge};
    state.charge = {held};
    for (State* loaded : {&state, &open}) {
      // spread over the inner half, not to make a spike
      for (const int a : drum.mesh.node_sets.at("electrode"))
        loaded->dead_force[drum.model->dofs.equation(a, 2)] =
            -0.02 / static_cast<double>(drum.mesh.node_sets.at("electrode").size());
      ASSERT_EQ(equilibrium.solve(*loaded, tight).outcome, Outcome::converged);
    }
    EXPECT_NEAR(drum.model->charges(state, false).charge[0], chamber.filled(held, state.voltage[0]),
                1e-11 * held);
    EXPECT_GT(state.voltage[0], 310);
    EXPECT_LT(drum.model->charges(open, false).charge[0], 0.99 * volume);
    EXPECT_LT(drum.height(open), drum.height(state));
    EXPECT_LT(drum.height(state), height);
  }
}

TEST(Chamber, a_lid_carries_pressure_times_its_area) {
  const double a = 5e-3, b = 20e-3;
  const meshing::Mesh mesh = meshing::annulus_meridian(a, b, 10, 2, 3);
  const int plate = mesh.node_sets.at("inner").front();
  const auto model = test::inflatable(mesh, test::vhb(1.5, 1.5), b, {.node = plate, .area = pi * a * a});
  model->dofs.hold(plate, 0);
  for (const int c : {0, 2}) model->dofs.hold(mesh.node_sets.at("outer").front(), c);
  model->dofs.number();
  Equilibrium equilibrium(*model, 1);
  State state = model->initial_state();
  state.voltage = {200};
  ASSERT_EQ(equilibrium.solve(state, tight).outcome, Outcome::converged);
  Eigen::VectorXd force;
  equilibrium.internal_force(state, force);
  // the ring holds what the pressure lifts: p times the whole opening
  EXPECT_NEAR(force[model->dofs.equation(mesh.node_sets.at("outer").front(), 2)], -200 * pi * b * b,
              1e-9 * 200 * pi * b * b);
}

} // namespace
} // namespace dielast::fem::chamber_test
