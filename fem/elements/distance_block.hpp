// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "meshing/mesh.hpp"

#include <array>
#include <memory>
#include <variant>
#include <vector>

namespace dielast::fem {

/// Linear spring: V = k/2 (l - L0)^2, its force on the ends k (L0 - l) pushes them apart.
struct Spring {
  double stiffness = 0;   ///< k, N/m
  double free_length = 0; ///< L0, m
};

/// A weight that hangs on a linkage: the force P acts along the arm b of a triangle with the sides a, b and
/// l + w, of which l + w lies along the axis. It pulls the ends apart by P (b^2 + (l+w)^2 - a^2)/(2 b (l+w)),
/// so that V = -P/(2b) ((b^2 - a^2) ln(l+w) + (l+w)^2/2) (spring-rolled muscle).
struct Linkage {
  double force = 0;  ///< P, N
  double arm = 0;    ///< b, m
  double strut = 0;  ///< a, m
  double offset = 0; ///< w, m
};

using DistancePotential = std::variant<Spring, Linkage>;

/// Nodes whose weighted mean is one end of a distance; the weights sum to 1.
struct DistanceEnd {
  std::vector<int> nodes;
  std::vector<double> weights;
};

/// Where a distance is taken: between two ends, along one axis, positive from the first to the second as
/// drawn.
struct Distance {
  std::array<DistanceEnd, 2> ends;
  int axis = 0; ///< 0, 1, 2 = x, y, z
};

/// The energy V(l) of a distance l, as one element. Throws std::invalid_argument for an end without nodes, or
/// with another number of weights.
std::unique_ptr<ElementBlock> make_distance_block(const meshing::Mesh& mesh, const Distance& distance,
                                                  const DistancePotential& potential);

} // namespace dielast::fem
