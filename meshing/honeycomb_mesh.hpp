// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/honeycomb.hpp"
#include "meshing/mesh.hpp"

namespace dielast::meshing {

struct MeshDensity {
  int order = 2;         ///< 1: triangle3 and line2; 2: triangle6 and line3
  int wall_elements = 8; ///< lines per wall
  double grading = 1;    ///< largest triangle size over the size at the walls, >= 1; 1 is uniform
};

/// Film (block 0, triangles) and walls (block 1, lines) of a honeycomb; they share the nodes along the walls,
/// where each line is a side of the film's triangles. Congruent cells have congruent meshes.
///
/// Places: `film`, `walls`, `cell[i,j]`, `wall[k]`, `boundary` (lines of the outer periphery); single nodes:
/// `left_apex`, `right_apex` (of the outer columns' middle cell, the lower of two), `centre` (node nearest to
/// the centroid); middles of a wall: `corner_top`, `corner_bottom` (first column), `top`, `bottom` (middle
/// column) - two nodes where the wall has none at its middle. Throws std::invalid_argument when a parameter
/// is out of range.
Mesh honeycomb_mesh(const HoneycombShape& shape, const MeshDensity& density);

} // namespace dielast::meshing
