// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/state.hpp"
#include "meshing/mesh.hpp"

#include <array>
#include <vector>

namespace dielast::fem {

/// Corner nodes of an element of film or of a wall.
struct ElementCorners {
  enum class Shape : std::uint8_t { line, meridian, triangle, tetrahedron };
  Shape shape{};
  std::array<int, 4> node{}; ///< the third of a triangle or tetrahedron, the fourth of a tetrahedron
};

/// Of all elements.
std::vector<ElementCorners> element_corners(const meshing::Mesh& mesh);

/// Whether some element is turned inside out, or by more than a right angle, between two states; `drawn`: its
/// nodes as drawn, m. No increment that is short enough does that: film resists being squeezed to nothing.
/// (Slivers at the corners of elements between walls that cross pass through zero area slowly.)
bool is_turned_over(const std::vector<ElementCorners>& elements, const std::vector<Eigen::Vector3d>& drawn,
                    const State& from, const State& to);

} // namespace dielast::fem
