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

/// Two surfaces of solids that may touch one another.
struct SurfaceContact {
  std::array<std::string, 2> places;          ///< their names
  std::array<meshing::CellBlock, 2> surfaces; ///< of 3-node cells, as meshing::sides_at() gives them
  std::optional<double> width;                ///< of plane strain, m; nothing: of revolution about x = 0
  Barrier barrier;                            ///< its stiffness in Pa/m
  double friction = 0;                        ///< Coulomb's coefficient; 0: they slide freely
  std::vector<int> mirrored{}; ///< nodes, ascending, on planes of symmetry beyond which both go on
};

/// Keeps two deformable surfaces apart, in plane strain or of revolution, without adhesion. Friction: see
/// SurfaceSliders.
///
/// Energy: w_A int_A b(distance to B) dA + w_B int_B b(distance to A) dB, over the areas as drawn, b the
/// Barrier, w_A + w_B = 1; the finer surface's integral has the greater share, as the square of the elements'
/// size. Distances are those from the curved sides; each side is integrated with 17 points, its nodes among
/// them. Where two sides meet the barrier is that of one, as of walls (see ContactPair). So it changes
/// smoothly as a point passes from side to side, whatever the two meshes; where a surface ends its integral
/// counts alone (SurfaceEnds); what one surface pushes the other
/// pushes back. It does not tell on which side of one surface the other lies, but no way leads through: see
/// ContactBlock::free_way().
///
/// Any side may meet any of the other surface: the tangent couples all of their unknowns.
/// Throws std::invalid_argument for surfaces that have nodes in common.
std::unique_ptr<ContactBlock> make_surface_contact_block(const meshing::Mesh& mesh, SurfaceContact contact);

} // namespace dielast::fem
