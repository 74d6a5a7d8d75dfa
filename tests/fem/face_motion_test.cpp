// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/face_motion.hpp"

#include "fem/contact/face_contact_block.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::fem::face_motion_test {
namespace {

using Eigen::Vector3d;

FaceNodes flat(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  FaceNodes x;
  x << a, b, c, (a + b) / 2, (b + c) / 2, (c + a) / 2;
  return x;
}

FaceNodes shifted(FaceNodes face, const Vector3d& way) { return face.colwise() + way; }

/// A blade below, whose edge lies along x, and one above it, along y, which cross far from points of either.
const FaceNodes blade = flat({-0.53, 0, 0}, {0.47, 0, 0}, {0, 0, -1});
FaceNodes blade_above(double height, double beside = 0) {
  return shifted(flat({0, -0.41, 0}, {0, 0.59, 0}, {0, 0, 1}), {beside, 0, height});
}

TEST(FaceMotion, ends_where_edges_meet) {
  constexpr double clearance = 1e-6;
  for (const double down : {-0.3, -2.7}) { // into it, and through all of it
    const double part =
        way_apart(moving(blade, blade), moving(blade_above(0.3), blade_above(down)), clearance, 1);
    const double meets = 0.3 / (0.3 - down);
    EXPECT_LE(part, meets);
    EXPECT_GT(part, meets - 1e-5);
  }
  EXPECT_EQ(way_apart(moving(blade, blade), moving(blade_above(0.3, 1), blade_above(-2.7, 1)), clearance, 1),
            1);
  EXPECT_EQ(way_apart(moving(blade, blade), moving(blade_above(0.3), blade_above(1e-3)), clearance, 1), 1);
  // Both together, as far as one likes.
  const Vector3d far(5, -7, 3);
  EXPECT_EQ(way_apart(moving(blade, shifted(blade, far)),
                      moving(blade_above(0.01), shifted(blade_above(0.01), far)), clearance, 1),
            1);
}

/// Bent alike, close to one another over all of their area.
TEST(FaceMotion, follows_curved_faces_that_fit) {
  FaceNodes bowl = flat({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (int a = 0; a < 6; ++a) bowl(2, a) = 0.2 * bowl.col(a).head<2>().squaredNorm();
  const auto ball = [&](double height) { return shifted(bowl, {0, 0, height}); };
  EXPECT_EQ(way_apart(moving(bowl, bowl), moving(ball(0.01), ball(0.005)), 1e-4, 1), 1);
  const double part = way_apart(moving(bowl, bowl), moving(ball(0.01), ball(-0.01)), 1e-4, 1);
  EXPECT_LT(part, 0.5);
  EXPECT_GT(part, 0.45);
}

/// Against flat parts of both that cross, at many times.
TEST(FaceMotion, misses_nothing_of_ways_at_random) {
  std::mt19937 random(7);
  int crossed = 0;
  const auto face = [&](double bend) {
    FaceNodes x =
        flat(test::random_vector(random, 3), test::random_vector(random, 3), test::random_vector(random, 3));
    for (int a = 3; a < 6; ++a) x.col(a) += bend * test::random_vector(random, 3);
    return x;
  };
  for (int trial = 0; trial < 100; ++trial) {
    const FaceNodes a = face(0.1), b = shifted(face(0.1), {1.5, 0, 0}),
                    a_to = shifted(a, 0.1 * test::random_vector(random, 3)) + 0.1 * face(0),
                    b_to = shifted(b, {-1.5, 0, 0}) + 0.1 * face(0);
    const double part = way_apart(moving(a, a_to), moving(b, b_to), 1e-3, 1);
    const auto at = [](const FaceNodes& from, const FaceNodes& to, double s) {
      return FaceNodes(from + s * (to - from));
    };
    constexpr int times = 200;
    int first = 0;
    while (first <= times &&
           !cross(at(a, a_to, double{1} * first / times), at(b, b_to, double{1} * first / times)))
      ++first;
    crossed += first <= times;
    EXPECT_LE(part, double{1} * first / times + 0.02) << trial; // of the flat parts' bend
    EXPECT_TRUE(part < 1 || first > times) << trial;
  }
  EXPECT_GT(crossed, 30);
}

/// Edges that cross between the points at which the barrier acts, in a model.
TEST(FaceMotion, keeps_edges_of_surfaces_in_contact_apart) {
  meshing::Mesh mesh;
  std::array<meshing::CellBlock, 2> faces;
  for (int k = 0; k < 2; ++k) {
    faces[static_cast<std::size_t>(k)].type = meshing::CellType::triangle6;
    for (int a = 0; a < 6; ++a) {
      faces[static_cast<std::size_t>(k)].nodes.push_back(mesh.node_count());
      mesh.nodes.emplace_back((k == 0 ? blade : blade_above(0.3)).col(a));
    }
  }
  auto model = test::unnumbered_model(
      mesh.node_count(), Dimension::spatial,
      make_face_contact_block(mesh, {{"lower", "upper"}, faces, {.thickness = 1e-3, .stiffness = 1}}));
  for (int node = 0; node < mesh.node_count(); ++node)
    for (int c = 0; c < 3; ++c) model->dofs.add(node, c);
  model->dofs.number();
  auto& block = dynamic_cast<ContactBlock&>(*model->blocks[0]);
  State state = model->initial_state();
  for (int step = 0; step < 30; ++step) { // as Newton's steps would go on
    State to = state;
    for (const int node : faces[1].nodes) to.displacement[static_cast<std::size_t>(node)].z() = -2;
    const double part = free_way(*model, state, to);
    for (const int node : faces[1].nodes) {
      double& z = state.displacement[static_cast<std::size_t>(node)].z();
      z += part * (-2 - z);
      EXPECT_GT(z, -0.3);
    }
    block.choose_elements(state);
    EXPECT_TRUE(block.evaluate(state, 0, block.element_count(), {}).feasible);
  }
  EXPECT_TRUE(edges_meet(*model, state));
  EXPECT_FALSE(edges_meet(*model, model->initial_state()));
  State held = model->initial_state();
  EXPECT_FALSE(apply_freely(*model, held, [&](State& at) {
    for (const int node : faces[1].nodes) at.displacement[static_cast<std::size_t>(node)].z() = -2;
  }));
}

} // namespace
} // namespace dielast::fem::face_motion_test
