// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/distance_block.hpp"
#include "fem/equilibrium/equilibrium.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace dielast::fem::distance_block_test {
namespace {

const meshing::Mesh mesh = test::distorted_square(2, 1, 0.1);

TEST(DistanceBlock, springs_and_linkages_have_consistent_derivatives) {
  const Distance distance{{{{{0, 3}, {0.4, 0.6}}, {{2, 5, 8}, {0.5, 0.3, 0.2}}}}, 0};
  const Linkage linkage{.force = 0.7, .arm = 0.11, .strut = 0.06, .offset = 0.047};
  for (const DistancePotential& potential :
       {DistancePotential(Spring{180, 0.05}), DistancePotential(linkage)}) {
    const auto model =
        test::free_model(mesh.node_count(), true, make_distance_block(mesh, distance, potential));
    State state = model->initial_state();
    std::mt19937 random(2);
    for (auto& u : state.displacement) u.head<2>() = test::random_vector(random, 2, 0.01);
    test::expect_consistent_derivatives(*model, state, 0.1);
  }
}

TEST(DistanceBlock, a_compressed_spring_pushes_its_ends_apart_whatever_their_order) {
  for (const bool swapped : {false, true}) {
    std::array<DistanceEnd, 2> ends{{{{0}, {1}}, {{2}, {1}}}};
    if (swapped) std::swap(ends[0], ends[1]);
    const auto model =
        test::free_model(mesh.node_count(), true, make_distance_block(mesh, {ends, 0}, Spring{200, 0.15}));
    Equilibrium equilibrium(*model, 1);
    Eigen::VectorXd force;
    equilibrium.internal_force(model->initial_state(), force);
    const double distance = mesh.nodes[2].x() - mesh.nodes[0].x();
    // internal forces are what holds the ends together: towards each other
    EXPECT_NEAR(force[model->dofs.equation(2, 0)], -200 * (0.15 - distance), 1e-12);
    EXPECT_NEAR(force[model->dofs.equation(0, 0)], 200 * (0.15 - distance), 1e-12);
  }
}

TEST(DistanceBlock, a_spring_without_an_end_is_rejected) {
  const DistanceEnd end{{0}, {1}};
  for (const DistanceEnd& other : {DistanceEnd{}, DistanceEnd{{1}, {}}})
    EXPECT_THROW(make_distance_block(mesh, {{end, other}, 0}, Spring{1, 1}), std::invalid_argument);
}

} // namespace
} // namespace dielast::fem::distance_block_test
