// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "meshing/mesh.hpp"

#include <memory>

namespace dielast::fem {

/// A node of one wall that may touch a beam of another.
struct ContactPair {
  int node = 0;
  std::array<int, 2> beam{}; ///< its ends: distances are taken to the chord
  double touching = 0;       ///< distance at which the walls' faces meet, m
  double length = 0;         ///< of the wall that the node stands for, m
};

/// The barrier of Li et al. 2020 (ACM Trans. Graph. 39, 49): energy per length of wall
///   stiffness * b(g), b(g) = -(g - thickness)^2 ln(g / thickness) for gaps g below the thickness, 0 above.
/// It is smooth, and infinite where faces meet.
struct Barrier {
  double thickness = 0; ///< m
  double stiffness = 0; ///< Pa
};

/// Keeps the pairs' faces apart, in the plane, without friction. States in which a gap is closed are not
/// feasible.
std::unique_ptr<ElementBlock> make_wall_contact_block(const meshing::Mesh& mesh,
                                                      std::vector<ContactPair> pairs, const Barrier& barrier);

} // namespace dielast::fem
