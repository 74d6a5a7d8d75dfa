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

/// What pulls on a place.
struct PullingFilm {
  std::vector<FilmElements> elements; ///< of each block of film, see films_of()
  /// Of what the chamber presses on the cells beside the place, with nodes of it: the pressure on these cells
  /// is no pull of the film, though their elements hand a part of it to the place's nodes.
  meshing::CellBlock pressed;
};
/// Empty where no film meets the place.
PullingFilm film_that_pulls(const std::string& place, const Case& one, const Device& device);

/// Force with which film pulls on the nodes of a place, N; of a film of revolution that of the full turn.
/// What else acts there, pressure, springs, supports and contact, is left out.
Eigen::Vector3d film_force(const Device& device, const std::string& place, const PullingFilm& film,
                           fem::Equilibrium& equilibrium, const fem::State& state);

/// Largest pressure of contact among the nodes of a place, Pa; of all surfaces where it is empty.
double largest_contact_pressure(const Device& device, const std::string& place, const fem::State& state);

} // namespace dielast::cases
