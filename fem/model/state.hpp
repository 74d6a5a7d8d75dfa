// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/generalised_alpha.hpp"
#include "materials/branches/time_scheme.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace dielast::fem {

/// What the material remembers: the internal variables of all blocks (see ElementBlock::history_size), then
/// of the circuits (see Circuit) and the sheets (see SheetPoint), at the last accepted times, newest first.
/// Never changed once made, so that states share it.
struct History {
  std::vector<double> now, before, older;
  double step = 0, step_before = 0; ///< s, between now and before, before and older; 0: there is no such past
};

/// Without a past, from which backward Euler's method sets out.
inline std::shared_ptr<const History> without_past(const History& history) {
  return std::make_shared<const History>(History{history.now, {}, {}});
}

/// What inertia remembers: how the model moved at the last accepted time. Per equation (see DofMap).
struct Motion {
  Eigen::VectorXd position, velocity, acceleration; ///< m, m/s, m/s^2
  Eigen::VectorXd unbalanced;                       ///< internal minus external forces, N
  Eigen::VectorXd acceleration_now; ///< second order in the time step; `acceleration` is the scheme's, of a
                                    ///< moment before, m/s^2
  double step = 0;                  ///< s, that led here; 0 at rest and after a break
  Eigen::VectorXd held{}; ///< 1 at free equations whose masses stay where they are, whatever pulls at them, 0
                          ///< at others; empty: none does
};

/// What is given at an electrode or a chamber.
enum class Supply : std::uint8_t {
  voltage, ///< its voltage (pressure)
  charge,  ///< its charge (volume): the voltage follows
  circuit, ///< the voltage of the source of its circuit: voltage and charge follow
  leak,    ///< nothing: it is isolated but for the leak of its circuit, through which it loses its charge
};

/// Whether no source is connected.
constexpr bool is_isolated(Supply supply) { return supply == Supply::charge || supply == Supply::leak; }
/// Whether the charge follows from what has flown in time: one of the model's internal variables.
constexpr bool flows(Supply supply) { return supply == Supply::circuit || supply == Supply::leak; }

/// All that changes while a model is loaded. A value: a copy is a cutback, a serialised one is a restart.
struct State {
  std::vector<Eigen::Vector3d> displacement; ///< per node, m, from the mesh as drawn
  std::vector<Eigen::Quaterniond> rotation; ///< per node, from the mesh as drawn; the sign is kept continuous
  std::vector<Eigen::Vector3d> angle; ///< per node, rad: the rotation vector, full turns counted (angle_near)
  std::vector<double> scalar;         ///< pressures (Pa) and potentials (V) of solids: see DofMap::add_scalar
  std::vector<double> voltage;        ///< per port (see Ports), V; of a chamber its pressure, Pa
  Eigen::VectorXd dead_force;         ///< per equation (see DofMap): N, or N m for rotations
  std::vector<Supply> supply;         ///< per port: what is given
  std::vector<double> charge;         ///< of each the given charge, C, or pumped volume, m^3
  std::vector<double> source;         ///< of each the voltage of the source, before its circuit, V
  Eigen::VectorXd sheet_drop; ///< per Ports::sheet_points, the electrode's voltage less the sheet's there, V;
                              ///< empty: none
  double time = 0;            ///< s
  materials::TimeScheme scheme; ///< how the branches get here from `history`; frozen in accepted states
  std::shared_ptr<const History> history; ///< null: nothing has internal variables
  GeneralisedAlpha motion_scheme;         ///< how inertia gets here from `motion`; static in accepted states
  std::shared_ptr<const Motion> motion;   ///< null: without inertia
};

/// Rotation by the vector `spin` (rad).
Eigen::Quaterniond rotation_of(const Eigen::Vector3d& spin);

/// Rotation vector (rad) of a unit quaternion, up to a full turn (0 where one is complete).
Eigen::Vector3d spin_of(const Eigen::Quaterniond& rotation);

/// The rotation vector (rad) of a unit quaternion that goes on from `expected`, full turns counted: of all
/// such vectors, which differ by two full turns each, the nearest one. About full turns, where these turn
/// over with the least wobble of the axis, full turns about the axis that `expected` tells, and what is left.
Eigen::Vector3d angle_near(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& expected);

/// A state that an extrapolation passes through, and its place on the load path.
struct PathPoint {
  double parameter = 0;
  State state;
};

/// Of the values at `points` (of distinct parameters) in the polynomial through them, taken at `parameter`.
std::vector<double> weights_at(std::span<const PathPoint> points, double parameter);

/// Polynomial through all `points` (one or more, of distinct parameters), taken at `parameter`: displacements
/// and scalars directly, rotations through their vectors relative to the last point. Voltages and forces are
/// those of the last point.
State extrapolate(std::span<const PathPoint> points, double parameter);

} // namespace dielast::fem
