// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <array>
#include <set>
#include <span>

namespace dielast::meshing {

/// How good the triangles or tetrahedra of a mesh are; lines, meridians and rods are only counted. Angles (of
/// tetrahedra those between their faces) and aspect ratios are those of the straight cell of the corners.
struct QualityReport {
  int nodes = 0, triangles = 0, tetrahedra = 0, meridians = 0, rods = 0, lines = 0;
  Eigen::Vector3d size = Eigen::Vector3d::Zero(); ///< of the cells' nodes along x, y and z, m
  double smallest_angle = 0;                      ///< degrees
  int worst_cell = -1; ///< triangle or tetrahedron with the smallest angle, -1 without any
  Eigen::Vector3d worst_place = Eigen::Vector3d::Zero(); ///< its centroid, m
  double largest_aspect =
      0; ///< longest side / (2 sqrt(3) inradius), of tetrahedra 2 sqrt(6): 1 is equilateral
  double smallest_area = 0, largest_area = 0,
         area = 0; ///< m^2, of the curved triangles, negative when inverted; of tetrahedra 0
  double smallest_volume = 0, largest_volume = 0, volume = 0; ///< m^3, of curved tetrahedra, likewise
  /// Cells with det dx/dxi <= 0 at a corner (3 nodes) or an integration point (6 and 10 nodes).
  int inverted = 0;
  std::array<int, 6> angles{}; ///< cells whose smallest angle is in [10 k, 10 k + 10) degrees
};

/// Whether the middle nodes of a cell fold it: somewhere det dx/dxi, seen from its corners' side, is not
/// positive in a 6-node triangle (exactly: a quadratic form of barycentric coordinates that is not strictly
/// copositive, Hadeler, Linear Algebra Appl. 49, 79, 1983), or at a corner or middle node of a 10-node
/// tetrahedron. Cells of corners alone do not fold.
bool folds(const Mesh& mesh, CellType type, std::span<const int> nodes);

/// For triangles, in a plane of constant z, the x-z plane or on a surface in space, and for tetrahedra.
QualityReport quality(const Mesh& mesh);

/// Nodes of cells that lie on others of these: where parts of a drawing meet without being joined, it is cut.
int nodes_on_others(const Mesh& mesh, const CellBlock& cells);

/// How many of some nodes lie on nodes of cells without being these: what they hold or carry is not joined to
/// the cells.
int nodes_beside(const Mesh& mesh, const std::set<int>& nodes, const CellBlock& cells);

/// Readable text of several lines, angles in degrees, lengths in mm.
std::string format(const QualityReport& report);

} // namespace dielast::meshing
