// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/warnings/held_places.hpp"

#include <algorithm>

namespace dielast::cases {

bool HeldPlaces::rests(int node, int axis) const {
  const int e = dofs_.equation(node, axis);
  if (e == fem::DofMap::absent) return true;
  const auto moves_or_lets_go = [&](const Support& support) {
    const auto driven = [&](const Controller& own) {
      return own.drives == DrivenLoad{Driven::displacement, support.place, axis};
    };
    return support.fixed[static_cast<std::size_t>(axis)] &&
           (support.motion[static_cast<std::size_t>(axis)] || !support.from.empty() ||
            !support.until.empty() || std::ranges::any_of(one_.controllers, driven)) &&
           std::ranges::binary_search(mesh_.node_sets.at(support.place), node);
  };
  return dofs_.is_held(e) && std::ranges::none_of(one_.supports, moves_or_lets_go);
}

bool HeldPlaces::rests(const std::string& place, int axis) const {
  return std::ranges::all_of(mesh_.node_sets.at(place), [&](int node) { return rests(node, axis); });
}

} // namespace dielast::cases
