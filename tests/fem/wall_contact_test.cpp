// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/wall_contact.hpp"

#include "tests/fem/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace dielast::fem::wall_contact_test {
namespace {

using Eigen::Vector3d;

/// A lattice of straight walls of some beams each, which meet where their ends have the same joint.
class Walls : public ::testing::Test {
 protected:
  int joint(const Vector3d& at) {
    mesh.nodes.push_back(at);
    return mesh.node_count() - 1;
  }
  void wall(int from, int to, int beams = 4) {
    const Vector3d a = mesh.nodes[static_cast<std::size_t>(from)],
                   b = mesh.nodes[static_cast<std::size_t>(to)];
    for (int last = from, i = 1; i <= beams; ++i) {
      const int next = i == beams ? to : joint(a + (b - a) * i / beams);
      lines.nodes.insert(lines.nodes.end(), {last, next});
      last = next;
    }
  }
  void wall(const Vector3d& from, const Vector3d& to, int beams = 4) { wall(joint(from), joint(to), beams); }

  std::vector<WallContact> find(double width, const std::vector<Vector3d>& displacement = {}) {
    State state;
    state.displacement = displacement;
    state.displacement.resize(mesh.nodes.size(), Vector3d::Zero());
    return WallContactSearch(mesh, lines, std::vector(static_cast<std::size_t>(lines.size()), width))
        .find(state);
  }

  meshing::Mesh mesh;
  meshing::CellBlock lines{meshing::CellType::line2, {}};
};

TEST_F(Walls, ParallelOnesTouchAtTheirWidth) {
  wall({0, 0, 0}, {1, 0, 0});
  wall({0, 0.3, 0}, {1, 0.3, 0}, 3);
  EXPECT_TRUE(find(0.2999).empty());
  const auto contacts = find(0.3001);
  ASSERT_EQ(contacts.size(), 1u); // one for two walls, however many beams are near
  EXPECT_NEAR(contacts[0].distance, 0.3, 1e-15);
  EXPECT_LT(contacts[0].lines[0] < 4 ? contacts[0].lines[1] - 4 : contacts[0].lines[0] - 4, 3);
}

TEST_F(Walls, CrossingOnesHaveNoDistance) {
  wall({0, 0, 0}, {1, 1, 0});
  wall({0, 1, 0}, {1, 0, 0}, 3);
  const auto contacts = find(0.01);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].distance, 0, 1e-15);
}

TEST_F(Walls, SkewOnesInSpace) {
  wall({-1, 0, 0}, {1, 0, 0});
  wall({0, -1, 0.25}, {0, 1, 0.25});
  EXPECT_TRUE(find(0.2499).empty());
  ASSERT_EQ(find(0.2501).size(), 1u);
  EXPECT_NEAR(find(0.2501)[0].distance, 0.25, 1e-15);
}

TEST_F(Walls, EndOfOneAgainstTheMiddleOfAnother) {
  wall({0, 0, 0}, {1, 0, 0}, 1);
  wall({0.37, 0.1, 0}, {0.37, 1, 0}, 1);
  const auto contacts = find(0.11);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].distance, 0.1, 1e-15);
}

TEST_F(Walls, BeyondEachOthersEnds) {
  wall({0, 0, 0}, {1, 0, 0}, 2);
  wall({1.3, 0.4, 0}, {2, 1, 0}, 2);
  EXPECT_TRUE(find(0.4999).empty());
  ASSERT_EQ(find(0.5001).size(), 1u);
  EXPECT_NEAR(find(0.5001)[0].distance, 0.5, 1e-15);
}

TEST_F(Walls, ThatMeetInAJointDoNotCount) {
  const int centre = joint({0, 0, 0});
  for (const Vector3d& end : {Vector3d(1, 0, 0), Vector3d(1, 0.1, 0), Vector3d(-1, 0, 0)})
    wall(centre, joint(end), 5);
  EXPECT_TRUE(find(0.5).empty());
}

// Two parts that a tie or a body joins have a node each where they meet.
TEST_F(Walls, OfTwoPartsThatEndAtOnePlaceDoNotCount) {
  wall({0, 0, 0}, {1, 0, 0});
  wall({1, 0, 0}, {2, 0.1, 0});
  EXPECT_TRUE(find(0.2).empty());
  wall({1, 0.01, 0}, {2, 0.2, 0}); // ends beside, not there
  EXPECT_FALSE(find(0.2).empty());
}

TEST_F(Walls, NearestFirst) {
  wall({0, 0, 0}, {1, 0, 0});
  wall({0, 0.3, 0}, {1, 0.3, 0});
  wall({0, 0.5, 0}, {1, 0.5, 0});
  const auto contacts = find(0.6);
  ASSERT_EQ(contacts.size(), 3u);
  EXPECT_NEAR(contacts[0].distance, 0.2, 1e-15);
  EXPECT_NEAR(contacts[1].distance, 0.3, 1e-15);
  EXPECT_NEAR(contacts[2].distance, 0.5, 1e-15);
}

TEST_F(Walls, AreWhereTheStateHasThem) {
  wall({0, 0, 0}, {1, 0, 0}, 2);
  wall({0, 1, 0}, {1, 1, 0}, 2);
  std::vector<Vector3d> displacement(mesh.nodes.size(), Vector3d::Zero());
  EXPECT_TRUE(find(0.1, displacement).empty());
  displacement[5] = {0, -0.95, 0}; // the middle of the upper wall
  const auto contacts = find(0.1, displacement);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].distance, 0.05, 1e-15);
}

// The order of beams and the direction of each are the mesher's affair.
TEST_F(Walls, ABeamsDirectionDoesNotMatter) {
  const int a = joint({0, 0, 0}), b = joint({0.5, 0, 0}), c = joint({1, 0, 0}), d = joint({0.5, 0.05, 0});
  lines.nodes = {c, b, a, b, c, d}; // a and d are the ends of one wall bent back on itself
  EXPECT_TRUE(find(0.5).empty());
  wall({0, 0.2, 0}, {1, 0.2, 0});
  EXPECT_EQ(find(0.16).size(), 1u);
}

} // namespace
} // namespace dielast::fem::wall_contact_test
