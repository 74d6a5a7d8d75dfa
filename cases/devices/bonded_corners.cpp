// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/bonded_corners.hpp"

#include "meshing/solids/sides.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace dielast::cases {

namespace {

std::vector<int> corners_of(const std::vector<meshing::OuterSide>& sides) {
  std::vector<int> nodes;
  for (const meshing::OuterSide& side : sides)
    nodes.insert(nodes.end(), side.corners().begin(), side.corners().end());
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

} // namespace

std::vector<int> bonded_corners(const Device& device) {
  const meshing::CellBlock* film = device.mesh.film();
  if (!device.bears_compression || !film ||
      (film->type != meshing::CellType::triangle6 && film->type != meshing::CellType::tetrahedron10))
    return {};
  const fem::DofMap& dofs = device.model.dofs;
  const auto free_ways = [&](int node) { // out of the displacements that it has
    std::array<int, 2> count{};
    for (int c = 0; c < 3; ++c)
      if (const int equation = dofs.equation(node, c); equation != fem::DofMap::absent)
        ++count[1], count[0] += dofs.is_free(equation) ? 1 : 0;
    return count;
  };
  const auto is_held = [&](int node) { return free_ways(node)[0] == 0; };
  const auto is_free = [&](int node) { return free_ways(node)[0] == free_ways(node)[1]; };
  std::vector<meshing::OuterSide> held, free;
  for (const meshing::OuterSide& side : meshing::outer_sides(*film)) {
    if (std::ranges::all_of(side.nodes(), is_held)) held.push_back(side);
    // A face's middles lie on edges, which may be bonded ones: one that is free, with none half held, will
    // do.
    else if (std::ranges::any_of(side.middles(), is_free) &&
             std::ranges::all_of(side.middles(), [&](int node) { return is_free(node) || is_held(node); }))
      free.push_back(side);
  }
  const std::vector<int> of_held = corners_of(held), of_free = corners_of(free);
  std::vector<int> both;
  std::ranges::set_intersection(of_held, of_free, std::back_inserter(both));
  return both;
}

} // namespace dielast::cases
