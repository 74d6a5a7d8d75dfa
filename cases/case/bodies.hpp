// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace dielast::cases {

/// [plate]: a rigid plate that closes a place of the film and moves along z only
struct Plate {
  std::string place;
  double mass = 0;    ///< kg
  double damping = 0; ///< between the plate and the ground, N s/m
};

/// [[point_mass]]: spread evenly over a place as drawn, with a damper to the ground along each axis
struct PointMass {
  std::string place;
  double mass = 0;    ///< kg
  double damping = 0; ///< N s/m
};

/// [[body]]: rigid, carries all nodes of its places. Its own place, called by its name, is the pivot, or
/// without one the centre of mass. In a model of revolution it moves along z alone.
struct Body {
  std::string name;
  std::vector<std::string> places;
  double mass = 0;                             ///< kg
  std::array<double, 3> inertia{};             ///< about axes along x, y, z through the centre, kg m^2
  std::optional<std::array<double, 3>> centre; ///< of mass, as drawn, m; absent: the centroid of its places
  std::optional<std::array<double, 3>> pivot;  ///< a point that stays where it is drawn, m
  std::array<bool, 6> fixed{};                 ///< displacements of its own place, rotations about x, y, z
  double damping_rate = 0; ///< c / m of dampers between all of its mass and the ground, 1/s
};

/// [[fin]]: flat, on a body, in a fluid that resists its motion across itself: per length an added mass
/// C_m rho pi h^2 / 4 (a plate in potential flow; Lamb, Hydrodynamics, art. 71) and a drag C_d rho h |v| v /
/// 2, h its height. Both act along the axis across it as drawn.
struct Fin {
  std::string name;
  std::string body;
  std::array<double, 3> from{}, to{}; ///< its ends as drawn, m: it swims from `to` towards `from`
  double height = 0;                  ///< across both its length and the axis, m
  int along = 1;                      ///< 0, 1, 2 = x, y, z: the axis across it
  double fluid_density = 0;           ///< kg/m^3
  double drag_coefficient = 0;        ///< C_d
  double added_mass_coefficient = 0;  ///< C_m
};

/// [pivot]: a pin under a body's own place, which it pushes along z and lets turn
struct Pivot {
  std::string body;
  double height = 0; ///< from where the body is drawn, m
};

/// [weight]: hangs from a strip; the mass of its body "bar"
struct HungWeight {
  double mass = 0; ///< kg
};

/// [gravity]
struct Gravity {
  double acceleration = 0;                   ///< m/s^2
  std::array<double, 3> direction{0, 0, -1}; ///< any length but 0
  bool film = false;                         ///< whether film and bars have a weight, too

  Eigen::Vector3d down() const { return Eigen::Vector3d(direction.data()).normalized(); }
};

} // namespace dielast::cases
