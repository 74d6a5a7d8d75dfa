// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace dielast::meshing {

/// What a designer chooses of a honeycomb. `angle` is the interior angle theta at the four equal vertices of
/// a cell: 90 degrees is a brick wall, less is re-entrant, 60 degrees is where the two apexes of a cell meet.
struct HoneycombShape {
  double angle = 0;         ///< theta, rad, between 60 and 180 degrees
  std::vector<int> columns; ///< cells in each column, left to right; neighbours differ by one
  double wall_length = 0;   ///< L, m, the same for all six walls
};

/// Lattice of hexagonal cells in the plane z = 0: a planar graph of joints and walls.
///
/// Corners of a cell about its centre: (+-(L/2 - L cos theta), 0), the apexes, and (+-L/2, +-L sin theta).
/// Columns have the pitch L (1 - cos theta) in x, the cells of one column 2 L sin theta in y; columns are
/// centred at the same height, so that neighbours interlock. The lowest cell of the tallest columns has its
/// centre at y = 0, column 0 at x = 0.
struct Honeycomb {
  struct Wall {
    std::array<int, 2> joints{};
    std::array<int, 2> cells{-1, -1}; ///< second one -1: on the outer periphery
  };
  /// Sides of a cell, in the order of Cell::walls.
  enum Side { upper_right, top, upper_left, lower_left, bottom, lower_right };
  /// Corners counter-clockwise from the right apex; wall k leads from joint k to joint k + 1.
  struct Cell {
    int column = 0, row = 0; ///< from 0; row 0 is at the bottom
    std::array<int, 6> joints{};
    std::array<int, 6> walls{};

    int right_apex() const { return joints[0]; }
    int left_apex() const { return joints[3]; }
  };

  std::vector<Eigen::Vector2d> joints; ///< m
  std::vector<Wall> walls;             ///< each side of a cell once, shared sides single
  std::vector<Cell> cells;             ///< column by column, each from the bottom
  std::vector<int> column_start;       ///< number of each column's lowest cell

  const Cell& cell(int column, int row) const { return cells[column_start[column] + row]; }
};

/// Throws std::invalid_argument when the shape is impossible.
Honeycomb honeycomb(const HoneycombShape& shape);

/// Corners of a cell about its centre, counter-clockwise from the right apex, after all of its sides have
/// moved inwards by a distance, m. Throws std::invalid_argument where this leaves nothing of the cell.
std::array<Eigen::Vector2d, 6> cell_corners(const HoneycombShape& shape, double inwards);

} // namespace dielast::meshing
