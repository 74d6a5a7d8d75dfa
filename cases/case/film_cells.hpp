// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dielast::cases {

/// The cells of the mesh's film that belong to a part, ascending. `film_parts` says of each cell to which.
inline std::vector<int> cells_of_part(std::span<const int> film_parts, std::size_t part) {
  std::vector<int> cells;
  for (std::size_t cell = 0; cell < film_parts.size(); ++cell)
    if (film_parts[cell] == static_cast<int>(part)) cells.push_back(static_cast<int>(cell));
  return cells;
}

} // namespace dielast::cases
