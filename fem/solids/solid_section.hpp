// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/material.hpp"

#include <Eigen/Core>

#include <limits>
#include <vector>

namespace dielast::fem {

/// What a part of a solid is made of, and where its field comes from.
struct SolidSection {
  materials::Material material;
  /// Pa; infinite: exactly incompressible. St. Venant-Kirchhoff's law has its own.
  double bulk_modulus = std::numeric_limits<double>::infinity();
  double width = 1; ///< of plane strain, across the plane, m
  /// Of a stack of layers: the undeformed thickness H of one, between the electrodes of a pair, m. With the
  /// potential as unknown a length over which it changes, m.
  double thickness = 0;
  Eigen::Vector3d normal{0, 1, 0}; ///< of the layers, a unit vector in the drawing
};

/// What is known of the potential at a node: it belongs to an electrode (its number), to the ground, or
/// follows.
struct NodePotential {
  static constexpr int ground = -1, follows = -2;
};

} // namespace dielast::fem
