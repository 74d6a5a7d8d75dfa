// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/honeycomb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace dielast::meshing::honeycomb_test {
namespace {

constexpr double degree = std::numbers::pi / 180;

Honeycomb printed(double angle = 150) { return honeycomb({angle * degree, {7, 6, 7, 6, 7}, 8e-3}); }

std::string message(const HoneycombShape& shape) {
  try {
    honeycomb(shape);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Honeycomb, HasThePrintedSize) {
  const Honeycomb lattice = printed();
  Eigen::Array2d low = Eigen::Array2d::Constant(1), high = -low;
  for (const Eigen::Vector2d& joint : lattice.joints) {
    low = low.min(joint.array());
    high = high.max(joint.array());
  }
  EXPECT_NEAR(high.x() - low.x(), 81.57e-3, 5e-6);
  EXPECT_NEAR(high.y() - low.y(), 56e-3, 1e-12);
  EXPECT_EQ(lattice.cells.size(), 33u);
}

TEST(Honeycomb, IsAPlanarGraphWithTwoOrThreeWallsAtAJoint) {
  const Honeycomb lattice = printed();
  // Euler: joints - walls + cells = 1. Shared walls: 6 in a column, 2 from each of the 6 cells of a short
  // column to each of its two neighbours.
  EXPECT_EQ(lattice.joints.size() - lattice.walls.size() + lattice.cells.size(), 1u);
  const auto shared =
      std::ranges::count_if(lattice.walls, [](const auto& wall) { return wall.cells[1] >= 0; });
  EXPECT_EQ(shared, 3 * 6 + 2 * 5 + 2 * 2 * 12);
  EXPECT_EQ(static_cast<long>(lattice.walls.size()), 33 * 6 - shared);

  std::vector<int> walls_at(lattice.joints.size());
  for (const auto& wall : lattice.walls) {
    for (const int joint : wall.joints) ++walls_at[joint];
    EXPECT_NEAR((lattice.joints[wall.joints[0]] - lattice.joints[wall.joints[1]]).norm(), 8e-3, 1e-15);
  }
  EXPECT_TRUE(std::ranges::all_of(walls_at, [](int n) { return n == 2 || n == 3; }));
}

TEST(Honeycomb, PutsCellsWhereTheSystemSaysAndAddressesThem) {
  for (const double angle : {70.0, 90.0, 150.0}) {
    const Honeycomb lattice = printed(angle);
    const double L = 8e-3, c = std::cos(angle * degree), s = std::sin(angle * degree);
    for (const auto& cell : lattice.cells) {
      EXPECT_EQ(&lattice.cell(cell.column, cell.row), &cell);
      const Eigen::Vector2d centre(cell.column * L * (1 - c),
                                   (cell.row + (cell.column % 2) * 0.5) * 2 * L * s);
      const std::array<Eigen::Vector2d, 6> corners{{{L / 2 - L * c, 0},
                                                    {L / 2, L * s},
                                                    {-L / 2, L * s},
                                                    {-L / 2 + L * c, 0},
                                                    {-L / 2, -L * s},
                                                    {L / 2, -L * s}}};
      for (int k = 0; k < 6; ++k) {
        EXPECT_LT((lattice.joints[cell.joints[k]] - centre - corners[k]).norm(), 1e-15);
        const auto& wall = lattice.walls[cell.walls[k]];
        EXPECT_EQ(std::minmax(wall.joints[0], wall.joints[1]),
                  std::minmax(cell.joints[k], cell.joints[(k + 1) % 6]));
      }
    }
  }
}

TEST(Honeycomb, CentresEveryColumnAtTheSameHeight) {
  const Honeycomb lattice = honeycomb({150 * degree, {1, 2, 3, 4, 3}, 8e-3});
  for (int column = 0; column < 5; ++column) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const auto& cell : lattice.cells)
      if (cell.column == column)
        for (const int joint : cell.joints) {
          lowest = std::min(lowest, lattice.joints[joint].y());
          highest = std::max(highest, lattice.joints[joint].y());
        }
    EXPECT_NEAR((lowest + highest) / 2, 1.5 * 8e-3, 1e-15) << column;
  }
}

TEST(Honeycomb, RejectsImpossibleShapes) {
  EXPECT_NE(message({60 * degree, {2}, 8e-3}).find("larger than 60.001 and smaller than 179.999 degrees"),
            std::string::npos);
  EXPECT_NE(message({180 * degree, {2}, 8e-3}).find("not 180"), std::string::npos);
  EXPECT_NE(message({std::numeric_limits<double>::quiet_NaN(), {2}, 8e-3}), "");
  EXPECT_EQ(message({150 * degree, {7, 7}, 8e-3}), "columns 0 and 1 of the honeycomb have 7 and 7 cells: "
                                                   "neighbours must differ by exactly one to interlock");
  EXPECT_EQ(message({150 * degree, {1, 0}, 8e-3}),
            "column 1 of the honeycomb has 0 cells, at least 1 is needed");
  EXPECT_EQ(message({150 * degree, {}, 8e-3}), "a honeycomb needs at least one column of cells");
  EXPECT_EQ(message({150 * degree, {1}, -1}), "a honeycomb's wall length must be positive, not -1 m");
  EXPECT_EQ(message({60.5 * degree, {1}, 8e-3}), "");
  EXPECT_EQ(message({175 * degree, {1}, 8e-3}), "");
}

} // namespace
} // namespace dielast::meshing::honeycomb_test
