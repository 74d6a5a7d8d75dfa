// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "fem/elements/point_mass_block.hpp"
#include "fem/model/dofs.hpp"
#include "meshing/mesh.hpp"

#include <span>
#include <utility>
#include <vector>

namespace dielast::cases {

/// Nodes that a body has besides those of its places: its master, at the pivot or the centre, and point
/// masses that have its moments of inertia.
struct BodyNodes {
  int master = 0;
  std::vector<std::pair<int, double>> masses; ///< node, kg
  double damping_rate = 0;                    ///< of all masses, 1/s
};

/// Adds the nodes of all bodies to the mesh, behind those of the film, and their places.
std::vector<BodyNodes> add_body_nodes(const Case& one, meshing::Mesh& mesh);

/// Their masses; the model feels them where it moves.
std::vector<fem::PointMass> body_masses(const std::vector<BodyNodes>& bodies);

/// Ties the places and the masses of all bodies to their masters and fixes what is fixed. Throws CaseError
/// where a place belongs to two bodies.
void tie_bodies(const Case& one, const std::vector<BodyNodes>& nodes, const meshing::Mesh& mesh,
                fem::DofMap& dofs);

} // namespace dielast::cases
