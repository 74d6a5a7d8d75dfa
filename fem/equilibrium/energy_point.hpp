// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/reactions.hpp"

#include <array>

namespace dielast::fem {

/// Generalised forces and the coordinates that they do work on: int force . d(coordinate), J.
struct Conjugates {
  Eigen::VectorXd force, coordinate;
};

/// What a state contributes to the energy balance.
struct EnergyPoint {
  double length = 0;     ///< of the path since the point before, in a parameter in which the path is smooth
  double time = 0;       ///< s
  bool moves = false;    ///< with inertia: external forces balance internal ones over the time steps only
  bool flowed = false;   ///< dashpots were let go, the loads are as they were
  Conjugates mechanical; ///< per equation dead forces (reactions at held ones) and displacements; then per
                         ///< port pressure and own volume of a chamber, 0 of an electrode
  Conjugates electrical; ///< per port voltage and charge, 0 of a chamber
  Conjugates resistance; ///< per port drop of voltage from its source (without time, from what the
                         ///< source leads it to; of a charge that is given see given_through) and charge
  Conjugates sheet;      ///< per Ports::sheet_points drop of voltage from the terminal and charge
  /// Powers, W: of dashpots by their flow rules; of dampers and drag; of leaking current in the film, in
  /// sheets on its way there, and in the resistance behind its source.
  enum Power { dashpots, dampers, leak, leak_through_sheet, leak_through_resistance, power_count };
  std::array<double, power_count> power{};
  /// Per port 1 where it has a sheet whose terminal is at its source's voltage, otherwise 0. Of the
  /// point that is added, not kept.
  Eigen::VectorXd at_source;
  /// Per port the resistance R of its circuit where a charge is given through it, otherwise 0, Ohm: of the
  /// heat R (dQ/dt + leak)^2 the powers have what goes with leak^2, `resistance` what goes with dQ leak. Not
  /// kept.
  Eigen::VectorXd given_through;
  double flow = 0;     ///< heat of the dashpots since the point before, see flow_heat(), J
  double impulses = 0; ///< work of supports that struck what they hold since the point before, J
  double friction = 0; ///< heat of sliders since the beginning, J
  EnergyParts energy;
};

/// Collects an energy point at an equilibrium.
EnergyPoint energy_point(Equilibrium& equilibrium, const State& state, double length, const Holding& held);
inline EnergyPoint energy_point(Equilibrium& equilibrium, const State& state, double length) {
  return energy_point(equilibrium, state, length, holding(equilibrium, state));
}

/// Heat of the dashpots between two accepted states, J, from the states alone: the energy that is lost as the
/// internal variables change at fixed shape and voltages, mean of both shapes. Where it would have to grow
/// for that (dashpots that follow the shape sooner than an increment, as one beside the law does), the mean
/// of what is lost per change of the internal variables in either state: one shape with the other's dashpots
/// is far from the path. Energies of both states: see Holding.
double flow_heat(Equilibrium& equilibrium, const State& from, double energy_from, const State& to,
                 double energy_to);

} // namespace dielast::fem
