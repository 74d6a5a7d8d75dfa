// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "fem/elements/point_mass_block.hpp"
#include "fem/model/dofs.hpp"
#include "meshing/mesh.hpp"
#include "meshing/shares.hpp"

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dielast::cases {

/// The shares of the nodes of every place in what is spread over it.
using PlaceShares = std::map<std::string, meshing::Shares>;

/// Nodes that a body has besides those of its places: its master, at the pivot or the centre, and point
/// masses that have its moments of inertia.
struct BodyNodes {
  int master = 0;
  std::vector<std::pair<int, double>> masses; ///< node, kg
  double damping_rate = 0;                    ///< of all masses, 1/s
};

/// Adds the nodes of all bodies to the mesh, behind those of the film, and their places. `shares`: of the
/// places that they carry.
std::vector<BodyNodes> add_body_nodes(const Case& one, const PlaceShares& shares, meshing::Mesh& mesh);

/// Their masses; the model feels them where it moves.
std::vector<fem::PointMass> body_masses(const std::vector<BodyNodes>& bodies);

/// Ties the places and the masses of all bodies to their masters and fixes what is fixed. Throws CaseError
/// where a place belongs to two bodies.
void tie_bodies(const Case& one, const std::vector<BodyNodes>& nodes, const meshing::Mesh& mesh,
                fem::DofMap& dofs);

} // namespace dielast::cases
