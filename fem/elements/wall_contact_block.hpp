// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/elements/barrier.hpp"
#include "fem/model/contact_block.hpp"
#include "meshing/mesh.hpp"

#include <memory>

namespace dielast::fem {

/// A node of one wall that may touch a beam of another.
struct ContactPair {
  static constexpr int straight = -1;

  int node = 0;
  std::array<int, 3> beam{}; ///< its ends and its middle; `straight`: it has none
  double touching = 0;       ///< distance at which the walls' faces meet, m
  double length = 0;         ///< of the wall that the node stands for, m
};

/// Keeps the pairs' faces apart, in the plane, without friction. States in which a gap is closed are not
/// feasible.
std::unique_ptr<ElementBlock> make_wall_contact_block(const meshing::Mesh& mesh,
                                                      std::vector<ContactPair> pairs, const Barrier& barrier);

} // namespace dielast::fem
