// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/face_contact_block.hpp"

#include "fem/contact/face.hpp"
#include "fem/model/assembler.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::fem::face_contact_block_test {
namespace {

using Eigen::Vector3d;

constexpr double thickness = 0.2, stiffness = 5;

/// A bent surface of `cells` x `cells` squares of size 1, each of two faces, and one face above it.
struct Faces {
  explicit Faces(const Vector3d& place, double bend = 0.1, int cells = 2, double size = 0.8) {
    const int n = 2 * cells + 1;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double x = i / 2.0, y = j / 2.0;
        mesh.nodes.emplace_back(x, y, bend * std::sin(1 + 1.3 * x + 0.7 * y));
      }
    lower.type = upper.type = meshing::CellType::triangle6;
    for (int j = 0; j + 2 < n; j += 2)
      for (int i = 0; i + 2 < n; i += 2) {
        const auto at = [&](int a, int b) { return (j + b) * n + i + a; };
        for (const int node : {at(0, 0), at(2, 0), at(2, 2), at(1, 0), at(2, 1), at(1, 1)})
          lower.nodes.push_back(node);
        for (const int node : {at(0, 0), at(2, 2), at(0, 2), at(1, 1), at(1, 2), at(0, 1)})
          lower.nodes.push_back(node);
      }
    const std::array<Vector3d, 6> own{Vector3d{0, 0, 0},     {0, 1, 0.02},     {1, 0, -0.03},
                                      {0, 0.5, -bend * 0.2}, {0.5, 0.5, 0.01}, {0.5, 0, -bend * 0.1}};
    for (const Vector3d& x : own) {
      upper.nodes.push_back(mesh.node_count());
      mesh.nodes.emplace_back(place + size * (bend == 0 ? Vector3d(x.x(), x.y(), 0) : x));
    }
    model = test::unnumbered_model(
        mesh.node_count(), Dimension::spatial,
        make_face_contact_block(mesh, {{"lower", "upper"}, {lower, upper}, {thickness, stiffness, 0.5}}));
    for (int node = 0; node < mesh.node_count(); ++node)
      for (int c = 0; c < 3; ++c) model->dofs.add(node, c);
    model->dofs.number();
  }
  ContactBlock& block() const { return dynamic_cast<ContactBlock&>(*model->blocks[0]); }
  Evaluation at(const State& state) const {
    block().choose_elements(state);
    return block().evaluate(state, 0, block().element_count(), {});
  }
  /// The upper face moved.
  State moved(const Vector3d& way) const {
    State state = model->initial_state();
    for (const int node : upper.nodes) state.displacement[static_cast<std::size_t>(node)] = way;
    return state;
  }

  meshing::Mesh mesh;
  meshing::CellBlock lower, upper;
  std::unique_ptr<Model> model;
};

/// Above the inside of a face, edges, a corner of six faces, and beside the surface.
TEST(FaceContactBlock, residual_and_tangent_are_the_derivatives_of_the_energy) {
  std::mt19937 random(4);
  for (const Vector3d& place :
       {Vector3d(0.3, 0.1, 0.17), {0.8, 0.7, 0.15}, {-0.5, 0.3, 0.2}, {1.75, 1.9, 0.1}}) {
    const Faces faces(place);
    State state = faces.model->initial_state();
    ASSERT_GT(faces.at(state).energy, 0) << place.transpose();
    for (auto& u : state.displacement) u = test::random_vector(random, 3, 0.01);
    test::expect_consistent_derivatives(*faces.model, state, 0.01, 1e-6);
  }
}

/// A flat face above a flat surface: pressure and energy of the gap, whatever edges and corners are below.
TEST(FaceContactBlock, pushes_with_the_barrier_of_the_gap) {
  const Faces faces({0.55, 0.6, 0.05}, 0); // half a face and more from where the lower one ends
  const Barrier barrier{thickness, stiffness, 0.5};
  const State state = faces.model->initial_state();
  NodalPressure pressure{std::vector<double>(faces.mesh.nodes.size(), 0),
                         std::vector<double>(faces.mesh.nodes.size(), 0)};
  faces.block().add_pressure(state, pressure);
  double area = 0;
  for (const int node : faces.upper.nodes) {
    const auto n = static_cast<std::size_t>(node);
    EXPECT_NEAR(pressure.force[n] / pressure.area[n], -barrier.at(0.05).slope, 1e-12 * stiffness);
    area += pressure.area[n];
  }
  EXPECT_NEAR(area, 0.32, 1e-12);
  // The upper, finer one's integral has the share 1 / (1 + its area over the mean of the lower ones).
  const double half = 0.32 * barrier.at(0.05).value * 0.5;
  EXPECT_GT(faces.at(state).energy, half);
  EXPECT_TRUE(faces.block().is_between("lower") && !faces.block().is_between("other"));
}

/// What the surfaces do to one another makes no force and no moment on the whole.
TEST(FaceContactBlock, forces_balance) {
  const Faces faces({0.3, 0.1, 0.17});
  Assembler assembler(*faces.model, 1);
  const State state = faces.model->initial_state();
  Eigen::VectorXd force;
  assembler.residual(state, force);
  Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
  double largest = 0;
  for (int node = 0; node < faces.mesh.node_count(); ++node) {
    const Vector3d f = force.segment<3>(faces.model->dofs.equation(node, 0));
    largest = std::max(largest, f.norm());
    sum += f;
    moment += faces.mesh.nodes[static_cast<std::size_t>(node)].cross(f);
  }
  EXPECT_GT(largest, 0);
  EXPECT_LT(sum.norm(), 1e-13 * largest);
  EXPECT_LT(moment.norm(), 1e-12 * largest);
}

TEST(FaceContactBlock, way_ends_before_surfaces_meet) {
  for (const Vector3d& place : {Vector3d(0.3, 0.1, 1), {-0.7, 0.5, 0.5}, {1.4, 1.7, 2}}) {
    const Faces faces(place);
    const State from = faces.model->initial_state();
    State to = faces.moved({0.2, 0.1, -4});
    to.displacement[static_cast<std::size_t>(faces.upper.nodes[0])].z() -= 1;
    const double part = free_way(*faces.model, from, to);
    EXPECT_GT(part, 0);
    EXPECT_LT(part, 1);
    for (auto& u : to.displacement) u *= part;
    EXPECT_TRUE(faces.at(to).feasible);
    EXPECT_EQ(free_way(*faces.model, from, faces.moved({0.2, 0, 1})), 1);
  }
}

/// A point passes from face to face: the energy changes without a step, nor its slope. Whatever the elements
/// were chosen for, they follow; the tangent's pattern grows with them.
TEST(FaceContactBlock, is_smooth_where_pairs_change) {
  const Faces faces({-0.9, 0.3, 0.15});
  Assembler assembler(*faces.model, 1);
  const int first = assembler.patterns();
  constexpr double h = 1e-3;
  const auto slope = [&](double x) {
    const State state = faces.moved({x, 0.1 * x, 0});
    Eigen::VectorXd force;
    assembler.residual(state, force);
    double sum = 0;
    for (const int node : faces.upper.nodes)
      sum += Vector3d(1, 0.1, 0).dot(force.segment<3>(faces.model->dofs.equation(node, 0)));
    return sum;
  };
  double most = 0, largest = 0, previous = slope(0), before = faces.at(faces.moved({0, 0, 0})).energy,
         work = 0;
  for (int i = 1; i <= 2400; ++i) {
    const double now = slope(i * h);
    most = std::max(most, std::abs(now - previous));
    largest = std::max(largest, std::abs(now));
    work += (now + previous) / 2 * h;
    previous = now;
  }
  EXPECT_GT(largest, 0.05);
  EXPECT_LT(most, 0.05 * largest);
  const State end = faces.moved({2.4, 0.24, 0});
  EXPECT_NEAR(faces.at(end).energy - before, work, 1e-4 * largest);
  assembler.tangent(end);
  EXPECT_GT(assembler.patterns(), first);
  test::expect_consistent_derivatives(*faces.model, end, 0.01, 1e-6);
}

TEST(FaceContactBlock, refuses_surfaces_with_a_common_node) {
  const Faces faces({0.3, 0.1, 0.17});
  EXPECT_THROW(make_face_contact_block(faces.mesh, {{"a", "b"}, {faces.lower, faces.lower}, {0.1, 1}}),
               std::invalid_argument);
}

TEST(FaceContactBlock, faces_that_cross_are_told) {
  const auto face = [](const Faces& faces, const meshing::CellBlock& block, int number) {
    FaceNodes x;
    for (std::size_t a = 0; a < 6; ++a)
      x.col(static_cast<int>(a)) = faces.mesh.nodes[static_cast<std::size_t>(block.cell(number)[a])];
    return x;
  };
  const auto any = [&](double height) {
    const Faces faces({0.3, 0.1, height});
    bool found = false;
    for (int i = 0; i < faces.lower.size(); ++i)
      found = found || cross(face(faces, faces.lower, i), face(faces, faces.upper, 0));
    return found;
  };
  EXPECT_FALSE(any(0.15));
  EXPECT_TRUE(any(0.07));
  EXPECT_FALSE(any(-0.2));
}

// A plane of symmetry along x = 0 and one along y = 0: what is left are the edges at x = 2 and y = 2.
TEST(FaceEnds, AreNotWhereTheSurfaceGoesOnMirrored) {
  const Faces faces({0, 0, 1}, 0);
  const auto at_corner = [&](const auto& is_mirrored) {
    std::vector<int> mirrored;
    for (int node = 0; node < faces.mesh.node_count(); ++node)
      if (is_mirrored(faces.mesh.nodes[static_cast<std::size_t>(node)])) mirrored.push_back(node);
    return FaceEnds(faces.lower, faces.mesh.nodes, mirrored, 0.5).at(0)[0];
  };
  EXPECT_EQ(at_corner([](const Vector3d&) { return false; }), 0);
  EXPECT_EQ(at_corner([](const Vector3d& x) { return x.x() == 0; }), 0);
  EXPECT_EQ(at_corner([](const Vector3d& x) { return x.x() == 0 || x.y() == 0; }), 2 / 0.5);
  EXPECT_EQ(at_corner([](const Vector3d&) { return true; }), 1);
}

} // namespace
} // namespace dielast::fem::face_contact_block_test
