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

/// What is beside the walls, m.
struct WallSurroundings {
  double width = 0; ///< of a wall, where the film under it has triangles of its own; 0: a wall is a line
  double gap = 0;   ///< between the walls (their faces, where they have a width) and the electrode
};

/// Film (block 0, triangles) and walls (block 1, lines) of a honeycomb; they share the nodes along the walls,
/// where each line is a side of the film's triangles. Congruent cells have congruent meshes.
///
/// Places: `film`, `electrode` (film beyond width / 2 + gap of all walls), with a width `under_walls` (film
/// within half of it, whose nodes beside a wall are opposite to nodes of it but near joints), `walls`,
/// `cell[i,j]`, `wall[k]`, `boundary` (lines of the outer periphery); single nodes: `left_apex`, `right_apex`
/// (of the outer columns' middle cell, the lower of two), `centre` (node nearest to the centroid); middles of
/// a wall: `corner_top`, `corner_bottom` (first column), `top`, `bottom` (middle column) - two nodes where
/// the wall has none at its middle. Throws std::invalid_argument when a parameter is out of range.
Mesh honeycomb_mesh(const HoneycombShape& shape, const MeshDensity& density,
                    const WallSurroundings& surroundings = {});

} // namespace dielast::meshing
