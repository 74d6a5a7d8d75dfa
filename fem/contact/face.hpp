// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace dielast::fem {

/// Nodes of a 6-node triangle in space: corners, then middles 01, 12, 20; m.
using FaceNodes = Eigen::Matrix<double, 3, 6>;

/// What of a face is meant: all of it, one of its edges (01, 12, 20) or one of its corners.
struct FacePart {
  enum class Kind : unsigned char { whole, edge, corner };
  Kind kind = Kind::whole;
  int number = 0;
};

/// The place of a part of a face that is nearest to a point.
struct FacePlace {
  double distance = 0;    ///< m, not negative
  Eigen::Vector3d normal; ///< unit vector from there to the point; not a number where that lies on the face
  Eigen::Vector<double, 6> shape;
  /// Along how many directions the place may move: 2 within the face, 1 on an edge, 0 at a corner.
  int free = 0;
  std::array<Eigen::Vector<double, 6>, 2> slope; ///< derivatives of the shape functions along these
  std::array<Eigen::Vector<double, 6>, 3> bend;  ///< twice: along 11, 12, 22
};

/// The place of a face that is nearest, of faces that bend little beside their size.
FacePlace nearest_place(const FaceNodes& face, FacePart part, const Eigen::Vector3d& point);

/// Bezier's, in whose hull the face is: its corners and those of its edges, in the nodes' order.
FaceNodes control_points(const FaceNodes& face);

/// Contains the face: a box about its control points.
Eigen::AlignedBox3d box_of(const FaceNodes& face);

/// As far as any point of the face moves between two states, at most, m: its control points do.
double way_of(const FaceNodes& from, const FaceNodes& to);

/// Whether two faces cross: flat parts of theirs, 16 of each, do.
bool cross(const FaceNodes& one, const FaceNodes& other);

/// A point of a face with what it stands for.
struct FacePoint {
  double xi, eta, weight;                ///< the weights add up to 1/2
  Eigen::Vector<double, 6> shape, share; ///< shape functions; linear ones of the four parts of the face
};

/// 61 points of degree 3, nodes and edges among them: on each of sixteen parts of a face corners 1/20,
/// middles 2/15, the middle of all 9/20.
const std::vector<FacePoint>& face_rule();

/// A part of a face with how often it counts.
struct CountedPart {
  FacePart part;
  double factor;
};

/// What counts besides the faces of a surface, each edge and corner with one face of those that have it: an
/// edge of n faces is there n - 1 times too often, a corner as often as faces and edges leave.
std::vector<std::vector<CountedPart>> parts_beside(const meshing::CellBlock& faces);

/// Where a surface of 6-node triangles ends, as drawn: on edges that one face has alone, and that are not
/// mirrored. What SurfaceEnds is to sides.
class FaceEnds {
 public:
  FaceEnds() = default;
  /// `mirrored`: nodes, ascending, on planes of symmetry. `over`: length along which the ramp rises from an
  /// end, m; as much as there is where that is less.
  FaceEnds(const meshing::CellBlock& faces, const std::vector<Eigen::Vector3d>& drawn,
           const std::vector<int>& mirrored, double over);

  /// Distances of a face's nodes from the end, over that length: end_ramp() of what its shape functions tell
  /// between them is the ramp.
  const Eigen::Vector<double, 6>& at(int face) const { return faces_[static_cast<std::size_t>(face)]; }

 private:
  std::vector<Eigen::Vector<double, 6>> faces_;
};

} // namespace dielast::fem
