// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/contact/barrier.hpp"
#include "fem/model/contact_block.hpp"
#include "meshing/mesh.hpp"

#include <memory>

namespace dielast::fem {

/// A node of one wall that may touch a beam of another, or its end.
///
/// What lies beside the place where two beams meet is about as near to both. So that the barrier is that of
/// one beam everywhere, the end that they share is a pair with a negative length (the convergent sum of Li et
/// al. 2023, arXiv:2307.15908): where the node is nearest to the end the three make one, elsewhere the end
/// takes off what the farther beam, whose nearest place it is, adds.
struct ContactPair {
  static constexpr int none = -1;

  int node = 0;
  std::array<int, 3> beam{}; ///< its ends and its middle; `none`: it is straight, or has one end only
  double touching = 0;       ///< distance at which the walls' faces meet, m
  double length = 0;         ///< of the wall that the node stands for, m
};

/// Keeps the pairs' faces apart, in the plane, without friction. States in which a gap is closed are not
/// feasible.
std::unique_ptr<ElementBlock> make_wall_contact_block(const meshing::Mesh& mesh,
                                                      std::vector<ContactPair> pairs, const Barrier& barrier);

} // namespace dielast::fem
