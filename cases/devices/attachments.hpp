// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/devices/bodies.hpp"
#include "cases/devices/fins.hpp"
#include "fem/model/model.hpp"

#include <vector>

namespace dielast::cases {

/// Springs and linkages between the centroids of places.
void add_springs(const Case& one, const meshing::Mesh& mesh, const PlaceShares& shares, fem::Model& model);

/// The plate's mass, and point masses spread over their places.
void add_masses(const Case& one, const meshing::Mesh& mesh, const PlaceShares& shares, fem::Model& model);

/// Forces of gravity: on plate and masses, and on the film where its weight counts; per equation, N.
Eigen::VectorXd weight_of(const Case& one, const std::vector<BodyNodes>& bodies,
                          const std::vector<FinPoints>& fins, const meshing::Mesh& mesh,
                          const PlaceShares& shares, const fem::Model& model);

} // namespace dielast::cases
