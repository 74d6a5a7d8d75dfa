// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"

#include <memory>
#include <vector>

namespace dielast::fem {

/// A mass at a node, and a damper and drag between it and the ground, felt along one axis: forces m a, c v
/// and d |v| v.
struct PointMass {
  int node = 0;
  int axis = 2;       ///< 0, 1, 2 = x, y, z
  double mass = 0;    ///< m, kg
  double damping = 0; ///< c, N s/m
  double drag = 0;    ///< d, N s^2/m^2
};

std::unique_ptr<ElementBlock> make_point_mass_block(std::vector<PointMass> points);

/// A mass at a node that resists its motion beside another node, not with it: 1/2 m |v - v_beside|^2, and a
/// damper between them. Of what is spread over elements, beside point masses at the nodes, both are negative.
struct RelativeMass {
  int node = 0, beside = 0;
  double mass = 0;    ///< kg
  double damping = 0; ///< N s/m
};

std::unique_ptr<ElementBlock> make_relative_mass_block(std::vector<RelativeMass> masses);

} // namespace dielast::fem
