// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/device.hpp"
#include "cases/quantities/film_values.hpp"
#include "fem/equilibrium/equilibrium.hpp"

namespace dielast::cases {

/// Force of the supports of a place on the device, N, from the reactions at held equations. Nodes that move
/// as one have one.
Eigen::Vector3d support_force(const Device& device, const std::string& place,
                              const Eigen::VectorXd& reaction);

/// Force with which the films' elements pull on the nodes of a place, N; of a film of revolution that of the
/// full turn. What else acts there, springs, supports and contact, is left out. `counted`: which of each
/// block's elements pull, see films_of().
Eigen::Vector3d film_force(const Device& device, const std::string& place,
                           const std::vector<FilmElements>& counted, fem::Equilibrium& equilibrium,
                           const fem::State& state);

/// Largest pressure of contact among the nodes of a place, Pa; of all surfaces where it is empty.
double largest_contact_pressure(const Device& device, const std::string& place, const fem::State& state);

} // namespace dielast::cases
