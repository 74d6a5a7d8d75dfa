// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/contact/barrier.hpp"
#include "fem/model/contact_block.hpp"
#include "meshing/mesh.hpp"

#include <array>
#include <memory>
#include <string>

namespace dielast::fem {

/// Two surfaces of solids in space that may touch one another.
struct FaceContact {
  std::array<std::string, 2> places;          ///< their names
  std::array<meshing::CellBlock, 2> surfaces; ///< 6-node triangles, as meshing::faces_at() gives them
  Barrier barrier;                            ///< its stiffness in Pa/m
  double friction = 0;                        ///< Coulomb's coefficient; 0: they slide freely
  std::vector<int> mirrored{}; ///< nodes, ascending, on planes of symmetry beyond which both go on
};

/// Keeps two deformable surfaces apart, in space, without adhesion: see
/// make_surface_contact_block(), whose energy this is over the areas of curved faces. Each is integrated with
/// 61 points, its nodes among them (16 times a closed rule of degree 3). Where faces meet the barrier is
/// that of one: edges take off what is there twice, corners give back what edges take too much (Li et al.
/// 2023, arXiv:2307.15908).
///
/// No point of either surface, on an edge or within a face, passes through the other one, whether the barrier
/// keeps it away or not (edges that cross between points do not feel it): see way_apart(). Friction: see
/// SurfaceSliders.
///
/// Towards where one surface ends its own integral counts alone, so that no point of the other catches on its
/// edge: see FaceEnds.
///
/// Elements are the pairs of faces that are nearer than the barrier reaches and a margin, found with trees of
/// boxes, anew when the surfaces have gone that margin towards one another.
/// Throws std::invalid_argument for surfaces that have nodes in common.
std::unique_ptr<ContactBlock> make_face_contact_block(const meshing::Mesh& mesh, FaceContact contact);

} // namespace dielast::fem
