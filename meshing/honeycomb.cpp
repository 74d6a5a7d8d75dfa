// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/honeycomb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

namespace dielast::meshing {

namespace {

/// Integer address of a joint: vertical line `line` (2 i and 2 i + 1 carry the left and the right corners of
/// column i), height in halves of a cell. Neighbouring cells agree on it exactly, so joints are shared
/// without comparing numbers.
struct Address {
  int line, height;
  auto operator<=>(const Address&) const = default;
};

Eigen::Vector2d position(const Address& joint, const HoneycombShape& shape) {
  const double L = shape.wall_length;
  const bool right = joint.line & 1;
  const int column = (joint.line - (right ? 1 : 0)) / 2;
  return {column * L * (1 - std::cos(shape.angle)) + (right ? L / 2 : -L / 2),
          joint.height * L * std::sin(shape.angle)};
}

void validate(const HoneycombShape& shape) {
  const double degrees = shape.angle * 180 / std::numbers::pi;
  // A thousandth of a degree off the limits: nearer, a cell has no area between its walls.
  if (!(degrees > 60.001 && degrees < 179.999))
    throw std::invalid_argument(
        fmt::format("a honeycomb's angle must be larger than 60.001 and smaller than 179.999 degrees "
                    "(at 60 the two apexes of a cell touch), not {:.8g}",
                    degrees));
  if (!(shape.wall_length > 0) || !std::isfinite(shape.wall_length))
    throw std::invalid_argument(
        fmt::format("a honeycomb's wall length must be positive, not {:.6g} m", shape.wall_length));
  if (shape.columns.empty()) throw std::invalid_argument("a honeycomb needs at least one column of cells");
  for (std::size_t i = 0; i < shape.columns.size(); ++i) {
    const int count = shape.columns[i];
    if (count < 1)
      throw std::invalid_argument(
          fmt::format("column {} of the honeycomb has {} cells, at least 1 is needed", i, count));
    if (i > 0 && std::abs(count - shape.columns[i - 1]) != 1)
      throw std::invalid_argument(
          fmt::format("columns {} and {} of the honeycomb have {} and {} cells: neighbours must "
                      "differ by exactly one to interlock",
                      i - 1, i, shape.columns[i - 1], count));
  }
}

} // namespace

std::array<Eigen::Vector2d, 6> cell_corners(const HoneycombShape& shape, double inwards) {
  const double L = shape.wall_length,
               apex = L / 2 - L * std::cos(shape.angle) - inwards / std::sin(shape.angle);
  const double half_top = L / 2 - inwards / std::tan(shape.angle / 2);
  const double height = L * std::sin(shape.angle) - inwards;
  if (!(std::min({apex, half_top, height}) > 1e-6 * L))
    throw std::invalid_argument(
        fmt::format("{:.6g} mm beside each wall leave nothing of a cell", 1e3 * inwards));
  return {Eigen::Vector2d(apex, 0),  {half_top, height},   {-half_top, height},
          Eigen::Vector2d(-apex, 0), {-half_top, -height}, {half_top, -height}};
}

Honeycomb honeycomb(const HoneycombShape& shape) {
  validate(shape);
  Honeycomb lattice;
  std::map<Address, int> joint_numbers;
  std::map<std::pair<int, int>, int> wall_numbers;

  const auto joint_at = [&](Address address) {
    const auto [entry, added] = joint_numbers.try_emplace(address, static_cast<int>(lattice.joints.size()));
    if (added) lattice.joints.push_back(position(address, shape));
    return entry->second;
  };
  const auto wall_between = [&](int from, int to, int cell) {
    const auto [entry, added] =
        wall_numbers.try_emplace(std::minmax(from, to), static_cast<int>(lattice.walls.size()));
    if (added)
      lattice.walls.push_back({.joints = {from, to}, .cells = {cell, -1}});
    else
      lattice.walls[entry->second].cells[1] = cell;
    return entry->second;
  };

  const int tallest = std::ranges::max(shape.columns);
  for (int column = 0; column < static_cast<int>(shape.columns.size()); ++column) {
    lattice.column_start.push_back(static_cast<int>(lattice.cells.size()));
    const int left = 2 * column, right = left + 1;
    for (int row = 0; row < shape.columns[column]; ++row) {
      const int height = 2 * row + tallest - shape.columns[column];
      Honeycomb::Cell cell{.column = column, .row = row};
      cell.joints = {joint_at({right + 1, height}), joint_at({right, height + 1}),
                     joint_at({left, height + 1}),  joint_at({left - 1, height}),
                     joint_at({left, height - 1}),  joint_at({right, height - 1})};
      for (int side = 0; side < 6; ++side)
        cell.walls[side] = wall_between(cell.joints[side], cell.joints[(side + 1) % 6],
                                        static_cast<int>(lattice.cells.size()));
      lattice.cells.push_back(cell);
    }
  }
  return lattice;
}

} // namespace dielast::meshing
