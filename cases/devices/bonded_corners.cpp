// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/bonded_corners.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

namespace dielast::cases {

namespace {

/// A side as its corners, ascending, and its middle nodes; unused places are -1.
struct Side {
  std::array<int, 3> corners{-1, -1, -1}, middles{-1, -1, -1};
};

Side side(std::span<const int> cell, std::initializer_list<int> corners, std::initializer_list<int> middles) {
  Side one;
  std::ranges::transform(corners, one.corners.begin(), [&](int i) { return cell[i]; });
  std::ranges::transform(middles, one.middles.begin(), [&](int i) { return cell[i]; });
  std::ranges::sort(one.corners);
  return one;
}

std::vector<Side> sides_of(std::span<const int> cell, meshing::CellType type) {
  if (type == meshing::CellType::triangle6)
    return {side(cell, {0, 1}, {3}), side(cell, {1, 2}, {4}), side(cell, {2, 0}, {5})};
  return {side(cell, {0, 1, 2}, {4, 5, 6}), side(cell, {0, 1, 3}, {4, 8, 7}),
          side(cell, {1, 2, 3}, {5, 9, 8}), side(cell, {2, 0, 3}, {6, 7, 9})};
}

std::vector<int> corners_of(const std::vector<Side>& sides) {
  std::vector<int> nodes;
  for (const Side& one : sides)
    std::ranges::copy_if(one.corners, std::back_inserter(nodes), [](int node) { return node >= 0; });
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  return nodes;
}

} // namespace

std::vector<int> bonded_corners(const Device& device) {
  const meshing::CellBlock* film = device.mesh.film();
  if (!device.solid || !film ||
      (film->type != meshing::CellType::triangle6 && film->type != meshing::CellType::tetrahedron10))
    return {};
  std::map<std::array<int, 3>, std::pair<Side, int>> all;
  for (int c = 0; c < film->size(); ++c)
    for (const Side& one : sides_of(film->cell(c), film->type))
      ++all.try_emplace(one.corners, one, 0).first->second.second;

  const fem::DofMap& dofs = device.model.dofs;
  const auto free_ways = [&](int node) { // out of the displacements that it has
    std::array<int, 2> count{};
    for (int c = 0; c < 3; ++c)
      if (const int equation = dofs.equation(node, c); equation != fem::DofMap::absent)
        ++count[1], count[0] += dofs.is_free(equation) ? 1 : 0;
    return count;
  };
  const auto nodes_all = [](const std::array<int, 3>& nodes, auto&& are) {
    return std::ranges::all_of(nodes, [&](int node) { return node < 0 || are(node); });
  };
  const auto is_held = [&](int node) { return free_ways(node)[0] == 0; };
  const auto is_free = [&](int node) { return free_ways(node)[0] == free_ways(node)[1]; };
  std::vector<Side> held, free;
  for (const auto& [corners, found] : all) {
    const auto& [one, cells] = found;
    if (cells > 1) continue;
    if (nodes_all(one.corners, is_held) && nodes_all(one.middles, is_held)) held.push_back(one);
    // A face's middles lie on edges, which may be bonded ones: one that is free, with none half held, will
    // do.
    else if (std::ranges::any_of(one.middles, [&](int node) { return node >= 0 && is_free(node); }) &&
             nodes_all(one.middles, [&](int node) { return is_free(node) || is_held(node); }))
      free.push_back(one);
  }
  const std::vector<int> of_held = corners_of(held), of_free = corners_of(free);
  std::vector<int> both;
  std::ranges::set_intersection(of_held, of_free, std::back_inserter(both));
  return both;
}

} // namespace dielast::cases
