// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/contact/barrier.hpp"
#include "fem/model/contact_block.hpp"
#include "meshing/mesh.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dielast::fem {

/// A surface that may touch a rigid plane, or where it is of revolution a rigid cylinder.
struct PlaneContact {
  std::string place{};                               ///< its name
  std::vector<int> nodes;                            ///< ascending
  std::vector<double> areas;                         ///< undeformed, that each node stands for, m^2
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< a point of the plane, m
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY(); ///< unit vector towards the surface
  Barrier barrier;                                   ///< its stiffness in Pa/m
  double friction = 0;                               ///< Coulomb's coefficient; 0: it slides freely
  /// Nodes of which something else keeps the distance, so that the barrier does not tell how they press, and
  /// those that press as much per area: film pulls at the former as at the latter.
  std::vector<std::array<int, 2>> kept{};
  /// Each corner of 6-node faces with each midside beside it, and an end on the axis of revolution with its
  /// side's middle. Force over area of these alone, which stand for next to nothing, says little: halves of
  /// the middles count with them.
  std::vector<std::array<int, 2>> corners{};
};

/// The surface that sides of solids, or films of revolution, make: each node stands for what Simpson's rule
/// gives it, on 2-node sides the trapezoidal rule. `width`: of plane strain, m; nothing: of revolution about
/// x = 0, where a plane across the radius is a cylinder.
PlaneContact surface_of(const meshing::Mesh& mesh, const meshing::CellBlock& sides,
                        std::optional<double> width);

/// The surface that faces of solids in space make, 6-node triangles: each node stands for the integral of its
/// shape function (corners for next to nothing).
PlaneContact surface_of(const meshing::Mesh& mesh, const meshing::CellBlock& faces);

/// Keeps the nodes of a surface above a rigid plane by a barrier; states with a node on the plane or below
/// are not feasible. No adhesion.
///
/// Friction: a Slider at each node. Anchors, normal forces and the heat of sliding are internal variables.
std::unique_ptr<ElementBlock> make_plane_contact_block(const meshing::Mesh& mesh, PlaneContact contact);

} // namespace dielast::fem
